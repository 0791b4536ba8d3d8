// All OpenGL versions draw the same image; problems of a driver are reported with their fix.
#include "ui/render/gl.h"

#include <array>

#include <epoxy/gl.h>
#include "render/stage.h"

namespace limber::render::test {
namespace {

constexpr std::array<GlApi, 3> kAll = {GlApi::core, GlApi::es, GlApi::gl31};

TEST(Gl, TriesTheBestVersionFirst) {
  EXPECT_EQ(gl_apis("auto"), std::vector<GlApi>(kAll.begin(), kAll.end()));
  EXPECT_EQ(gl_apis(""), gl_apis("auto"));
  EXPECT_EQ(gl_apis("core"), std::vector<GlApi>{GlApi::core});
  EXPECT_EQ(gl_apis("es"), std::vector<GlApi>{GlApi::es});
  EXPECT_EQ(gl_apis("3.1"), std::vector<GlApi>{GlApi::gl31});
  EXPECT_TRUE(gl_apis("vulkan").empty());
  EXPECT_EQ(gl_names(kAll), "OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1");
  for (const GlApi api : kAll) EXPECT_EQ(gl_api_info(api).api, api);
}

// a scene with objects on, above and in the floor, glass, a slope, and the debug overlay
class AllThings {
 public:
  explicit AllThings(double style) {
    scene_.set("/visuals/look/style", {style});
    scene_.add("box", box({0.4, 0.4, 1.4}), {-1.2, 0, 0.45});  // from 0.25 m below the floor
    scene_.add("ball", round(model::ShapeKind::sphere, 0.3), {-0.5, -0.6, 0.3});
    scene_.add("capsule", round(model::ShapeKind::capsule, 0.15, 0.6), {0.2, 0, 0.45}, quat_axis({1, 0, 0}, 0.5));
    scene_.add("cylinder", round(model::ShapeKind::cylinder, 0.2, 0.5), {0.8, -0.4, 0.25});
    scene_.add("cone", round(model::ShapeKind::cone, 0.25, 0.5), {1.3, 0.2, 0.25});
    scene_.add("buried", round(model::ShapeKind::sphere, 0.25),
               {-0.4, 0.6, -0.5});  // must not appear in the reflection
    scene_.add("glass", box({0.5, 0.1, 0.6}), {0.4, -1, 0.4});
    scene_.add("slope", plane(), {0, 3, 0}, quat_axis({1, 0, 0}, 0.6));
    scene_.paint("box", {0, 0.9, 0.9});
    scene_.paint("capsule", {0.3, 0.8, 0.9});
    scene_.paint("glass", {0.6, 0.7, 1});
    scene_.set("/visuals/shape/glass/transparency", {0.6});
    scene_.look_from({0.5, -4, 1.6}, {0, 0, 0.4});
    now_ = *scene_.snapshot();
    sim::OverlayMark mark;
    mark.kind = sim::OverlayMark::Kind::rotation_axis;
    mark.size = 0.4;
    mark.position = {0.2, 0, 0.5};
    now_.overlay = {mark};
  }
  const engine::Snapshot& now() const { return now_; }

 private:
  TestScene scene_;
  engine::Snapshot now_;
};

struct Differences {
  double mean = 0;   // mean over pixels of the largest difference of a channel, 0..255
  double small = 0;  // fraction of pixels that differ by more than two steps
  double large = 0;  // fraction of pixels that differ by more than 40 steps
};

Differences differences(const Pixels& a, const Pixels& b) {
  Differences all;
  const double share = 1.0 / (a.width * a.height);
  for (std::size_t i = 0; i < a.bytes.size(); i += 4) {
    int max_difference = 0;
    for (std::size_t c = 0; c < 3; c++)
      max_difference = std::max(max_difference, std::abs(a.bytes[i + c] - b.bytes[i + c]));
    all.mean += share * max_difference;
    all.small += max_difference > 2 ? share : 0;
    all.large += max_difference > 40 ? share : 0;
  }
  return all;
}

TEST(Gl, AllVersionsDrawTheSameImage) {
  for (const double style : {0.0, 1.0}) {
    const AllThings things(style);
    for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
      const Pixels expected = draw(things.now(), 256, 144, quality);
      for (const GlApi api : {GlApi::es, GlApi::gl31}) {
        const Differences all = differences(draw(things.now(), 256, 144, quality, api), expected);
        // OpenGL 3.1 differs only in the drawing of the ground map. OpenGL ES rounds once more (one step), reads the
        // ground map unfiltered, and clips the reflection per pixel instead of per sample.
        const double part = api == GlApi::es ? 1 : 0.03;
        const std::string label = fmt::format("{}, {}, {}", gl_api_info(api).name, style, static_cast<int>(quality));
        EXPECT_LT(all.mean, 0.05 * part) << label;
        EXPECT_LT(all.small, 0.004 * part) << label;
        EXPECT_LT(all.large, 0.0005) << label;
      }
    }
  }
}

TEST(Gl, DrawingCausesNoErrors) {
  const AllThings things(0);
  for (const GlApi api : kAll) {
    for (const Quality quality : {Quality::low, Quality::high}) {
      for (const int width : {64, 1, 80}) (void)draw(things.now(), width, 36, quality, api);
      renderer(quality, api).draw_over([] {});
      EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << gl_api_info(api).name;
    }
  }
}

// the panel's colors are already sRGB bytes
TEST(Gl, DrawOverKeepsColorsUnchanged) {
  const AllThings things(1);
  for (const GlApi api : kAll) {
    Renderer& active_renderer = renderer(Quality::low, api);
    const Pixels before = draw(things.now(), 16, 9, Quality::low, api);
    active_renderer.draw_over([] {
      glEnable(GL_SCISSOR_TEST);
      glScissor(8, 0, 8, 9);
      glClearColor(0.2F, 0.4F, 0.8F, 1);
      glClear(GL_COLOR_BUFFER_BIT);
      glDisable(GL_SCISSOR_TEST);
    });
    const Pixels after = active_renderer.read();
    EXPECT_EQ(color(after, 3, 4), color(before, 3, 4)) << gl_api_info(api).name;
    EXPECT_EQ(color(after, 12, 4), Vec3(51, 102, 204)) << gl_api_info(api).name;
  }
}

TEST(Gl, ErrorsNameTheRequirementTheDriverAndTheFix) {
  const std::string old = gl_context_error(kAll, {"OpenGL 2.1", "OpenGL ES 2.0"});
  EXPECT_NE(old.find("OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1 is needed"), std::string::npos) << old;
  EXPECT_NE(old.find("offers OpenGL 2.1 and OpenGL ES 2.0. "), std::string::npos) << old;
  EXPECT_EQ(old.find("--gl"), std::string::npos) << old;
  const std::array<GlApi, 1> core = {GlApi::core};
  EXPECT_NE(gl_context_error(core, {"OpenGL 3.1"}).find("Set --gl (or LIMBER_GL) to auto"), std::string::npos);
  EXPECT_NE(gl_context_error(kAll, {}).find("apt-get install libgl1-mesa-dri"), std::string::npos);
}

}  // namespace
}  // namespace limber::render::test

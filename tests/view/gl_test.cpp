// Each kind of OpenGL draws the same picture; what is wrong with a driver is reported with its fix.
#include "view/gl.h"

#include <array>

#include "view/stage.h"

namespace limber::view_test {
namespace {

constexpr std::array<GlApi, 3> kAll = {GlApi::core, GlApi::es, GlApi::gl31};

TEST(Gl, KindsAreTriedFromTheBestOn) {
  EXPECT_EQ(gl_apis("auto"), std::vector<GlApi>(kAll.begin(), kAll.end()));
  EXPECT_EQ(gl_apis(""), gl_apis("auto"));
  EXPECT_EQ(gl_apis("core"), std::vector<GlApi>{GlApi::core});
  EXPECT_EQ(gl_apis("es"), std::vector<GlApi>{GlApi::es});
  EXPECT_EQ(gl_apis("3.1"), std::vector<GlApi>{GlApi::gl31});
  EXPECT_TRUE(gl_apis("vulkan").empty());
  EXPECT_EQ(gl_names(kAll), "OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1");
  for (const GlApi api : kAll) EXPECT_EQ(gl_api_info(api).api, api);
}

// what stands on the floor, above it, in it; glass, a slope, the debug picture
class AllThings {
 public:
  explicit AllThings(double style) {
    stage_.set("/visuals/look/style", {style});
    stage_.add("box", box({0.4, 0.4, 1.4}), {-1.2, 0, 0.45});  // from 0.25 m below the floor
    stage_.add("ball", round(ShapeKind::sphere, 0.3), {-0.5, -0.6, 0.3});
    stage_.add("capsule", round(ShapeKind::capsule, 0.15, 0.6), {0.2, 0, 0.45}, quat_axis({1, 0, 0}, 0.5));
    stage_.add("cylinder", round(ShapeKind::cylinder, 0.2, 0.5), {0.8, -0.4, 0.25});
    stage_.add("cone", round(ShapeKind::cone, 0.25, 0.5), {1.3, 0.2, 0.25});
    stage_.add("buried", round(ShapeKind::sphere, 0.25), {-0.4, 0.6, -0.5});  // mirrored it would hang in the air
    stage_.add("glass", box({0.5, 0.1, 0.6}), {0.4, -1, 0.4});
    stage_.add("slope", plane(), {0, 3, 0}, quat_axis({1, 0, 0}, 0.6));
    stage_.paint("box", {0, 0.9, 0.9});
    stage_.paint("capsule", {0.3, 0.8, 0.9});
    stage_.paint("glass", {0.6, 0.7, 1});
    stage_.set("/visuals/shape/glass/transparency", {0.6});
    stage_.look_from({0.5, -4, 1.6}, {0, 0, 0.4});
    now_ = *stage_.snapshot();
    OverlayMark mark;
    mark.kind = OverlayMark::Kind::turn;
    mark.reach = 0.4;
    mark.at = {0.2, 0, 0.5};
    now_.overlay = {mark};
  }
  const Snapshot& now() const { return now_; }

 private:
  Stage stage_;
  Snapshot now_;
};

struct Differences {
  double mean = 0;   // steps of 255 of the channel that differs most
  double small = 0;  // share of pixels that differ by more than two steps
  double large = 0;  // by more than 40
};

Differences differences(const Pixels& a, const Pixels& b) {
  Differences all;
  const double share = 1.0 / (a.width * a.height);
  for (std::size_t i = 0; i < a.bytes.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; c++) most = std::max(most, std::abs(a.bytes[i + c] - b.bytes[i + c]));
    all.mean += share * most;
    all.small += most > 2 ? share : 0;
    all.large += most > 40 ? share : 0;
  }
  return all;
}

TEST(Gl, EachKindDrawsTheSamePicture) {
  for (const double style : {0.0, 1.0}) {
    const AllThings things(style);
    for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
      const Pixels expected = draw(things.now(), 256, 144, quality);
      for (const GlApi api : {GlApi::es, GlApi::gl31}) {
        const Differences all = differences(draw(things.now(), 256, 144, quality, api), expected);
        // OpenGL 3.1 differs in how the map of the floor is drawn alone. OpenGL ES rounds once more (a step), reads
        // that map unfiltered, and cuts what the floor mirrors at pixels, not within them.
        const double part = api == GlApi::es ? 1 : 0.03;
        const std::string what = fmt::format("{}, {}, {}", gl_api_info(api).name, style, static_cast<int>(quality));
        EXPECT_LT(all.mean, 0.05 * part) << what;
        EXPECT_LT(all.small, 0.004 * part) << what;
        EXPECT_LT(all.large, 0.0005) << what;
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

// the panel's colors are sRGB bytes already
TEST(Gl, DrawingOverThePictureKeepsColorsAsTheyAre) {
  const AllThings things(1);
  for (const GlApi api : kAll) {
    Renderer& drawn = renderer(Quality::low, api);
    const Pixels before = draw(things.now(), 16, 9, Quality::low, api);
    drawn.draw_over([] {
      glEnable(GL_SCISSOR_TEST);
      glScissor(8, 0, 8, 9);
      glClearColor(0.2F, 0.4F, 0.8F, 1);
      glClear(GL_COLOR_BUFFER_BIT);
      glDisable(GL_SCISSOR_TEST);
    });
    const Pixels after = drawn.read();
    EXPECT_EQ(color(after, 3, 4), color(before, 3, 4)) << gl_api_info(api).name;
    EXPECT_EQ(color(after, 12, 4), Vec3(51, 102, 204)) << gl_api_info(api).name;
  }
}

TEST(Gl, AFaultStatesWhatIsNeededWhatIsThereAndTheFix) {
  const std::string old = gl_fault(kAll, {"OpenGL 2.1", "OpenGL ES 2.0"});
  EXPECT_NE(old.find("OpenGL 3.3, OpenGL ES 3.0 or OpenGL 3.1 is needed"), std::string::npos) << old;
  EXPECT_NE(old.find("offers OpenGL 2.1 and OpenGL ES 2.0. "), std::string::npos) << old;
  EXPECT_EQ(old.find("--gl"), std::string::npos) << old;
  const std::array<GlApi, 1> core = {GlApi::core};
  EXPECT_NE(gl_fault(core, {"OpenGL 3.1"}).find("Set --gl (or LIMBER_GL) to auto"), std::string::npos);
  EXPECT_NE(gl_fault(kAll, {}).find("apt-get install libgl1-mesa-dri"), std::string::npos);
}

}  // namespace
}  // namespace limber::view_test

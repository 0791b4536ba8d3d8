// limber_render: the images of liblimber, where the camera's formula predicts them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "lib/limber.h"
#include "ui/render/offscreen.h"

namespace limber::render::test {
namespace {

// A white ball at (0.5, 0, 1) in front of nothing, and a static camera of the scene.
constexpr const char* kWhiteBall = R"(
  sim.gravity = vec3(0, 0, 0)
  visuals.look.floor, visuals.look.grid, visuals.look.fog = false, 0, 0
  visuals.background = vec3(0, 0, 0)
  local shape = sim:add_sphere_shape("ball", 0.15)
  shape.diffuse_color, shape.ambient_color = vec3(0, 0, 1), vec3(0, 0, 1)
  sim:add_body("ball"):add_part("ball", shape, { position = vec3(0.5, 0, 1) })
  visuals.camera:look_at(vec3(0, -4, 1), vec3(0, 0, 1))
)";
constexpr int kImageWidth = 200;
constexpr int kImageHeight = 100;

class LimberRender : public testing::Test {
 protected:
  LimberRender() {
    limber_options options = LIMBER_OPTIONS;
    options.text = kWhiteBall;
    EXPECT_EQ(limber_create(&options, &sim_), LIMBER_OK) << limber_last_error();
    image_.width = kImageWidth;
    image_.height = kImageHeight;
    image_.quality = LIMBER_QUALITY_LOW;
  }
  ~LimberRender() override { limber_destroy(sim_); }
  LimberRender(const LimberRender&) = delete;
  LimberRender& operator=(const LimberRender&) = delete;

  std::vector<std::uint8_t> draw() const {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(3 * kImageWidth * kImageHeight));
    EXPECT_EQ(limber_render(sim_, &image_, pixels.data(), pixels.size()), LIMBER_OK) << limber_last_error();
    return pixels;
  }
  // Brightness of the pixel that shows a point `right` and `up` of the image's center at a distance of 4 m.
  static int brightness(const std::vector<std::uint8_t>& pixels, double right, double up, double fovy = 40) {
    const double focal = kImageHeight / 2.0 / std::tan(fovy / 2 * M_PI / 180);
    const int x = static_cast<int>(std::lround(kImageWidth / 2.0 + focal * right / 4));
    const int y = static_cast<int>(std::lround(kImageHeight / 2.0 - focal * up / 4));
    const std::size_t at = 3 * static_cast<std::size_t>(y * kImageWidth + x);
    return pixels[at] + pixels[at + 1] + pixels[at + 2];
  }
  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    EXPECT_EQ(limber_hash(sim_, &hash), LIMBER_OK);
    return hash;
  }

  limber_sim* sim_ = nullptr;
  limber_image image_ = LIMBER_IMAGE;
};

TEST_F(LimberRender, ShowsBodiesWhereTheCameraProjectsThem) {
  const std::vector<std::uint8_t> pixels = draw();
  EXPECT_GT(brightness(pixels, 0.5, 0), 200);
  for (const double right : {-0.5, 0.0, 0.75}) EXPECT_LT(brightness(pixels, right, 0), 100) << right;
  EXPECT_LT(brightness(pixels, 0.5, 0.25), 100);
}

TEST_F(LimberRender, CameraIsReplacedByPositionTargetAndField) {
  const double left[] = {0, -4, 1};
  const double behind[] = {0, 4, 1};
  const double target[] = {0, 0, 1};
  image_.position = behind;
  image_.target = target;
  EXPECT_GT(brightness(draw(), -0.5, 0), 200);
  EXPECT_LT(brightness(draw(), 0.5, 0), 100);
  image_.position = left;
  image_.fovy = 60;
  EXPECT_GT(brightness(draw(), 0.5, 0, 60), 200);
  EXPECT_LT(brightness(draw(), 0.5, 0, 40), 100);
  // the ball in the center, from the scene's own position
  const double ball[] = {0.5, 0, 1};
  image_.position = nullptr;
  image_.fovy = 0;
  image_.target = ball;
  EXPECT_GT(brightness(draw(), 0, 0), 200);
  EXPECT_LT(brightness(draw(), 0.5, 0), 100);
}

TEST_F(LimberRender, ShowsWrittenAndRestoredValuesWithoutAStep) {
  limber_property* position = nullptr;
  ASSERT_EQ(limber_find(sim_, "/physics/body/ball/part/ball/position", &position), LIMBER_OK);
  limber_state* state = nullptr;
  ASSERT_EQ(limber_save(sim_, &state), LIMBER_OK);
  const std::vector<std::uint8_t> before = draw();
  const double moved[] = {-0.5, 0, 1};
  ASSERT_EQ(limber_write(position, moved, 3), LIMBER_OK);
  EXPECT_GT(brightness(draw(), -0.5, 0), 200);
  ASSERT_EQ(limber_restore(sim_, state), LIMBER_OK);
  EXPECT_EQ(draw(), before);
  ASSERT_EQ(limber_reset(sim_, nullptr), LIMBER_OK);
  EXPECT_EQ(draw(), before);
}

TEST_F(LimberRender, ChangesNeitherTheStateNorTheCurrentContext) {
  const Result<std::unique_ptr<OffscreenContext>> own = OffscreenContext::make();
  ASSERT_TRUE(own) << own.error();
  ASSERT_NE(gl_driver(), "nothing");
  const std::uint64_t before = hash();
  (void)draw();
  EXPECT_EQ(hash(), before);
  EXPECT_NE(gl_driver(), "nothing");
  limber_destroy(sim_);
  sim_ = nullptr;
  EXPECT_NE(gl_driver(), "nothing");
}

TEST_F(LimberRender, WrongArgumentsAreRejected) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(3 * kImageWidth * kImageHeight));
  const auto reject = [&](const char* text, std::size_t size) {
    EXPECT_EQ(limber_render(sim_, &image_, pixels.data(), size), LIMBER_INVALID_ARGUMENT);
    EXPECT_NE(std::string(limber_last_error()).find(text), std::string::npos) << limber_last_error();
  };
  reject("60000 bytes", pixels.size() - 1);
  const limber_image valid = image_;
  for (const int width : {0, -1, 16385}) {
    image_.width = width;
    reject("1 to 16384", pixels.size());
  }
  image_ = valid;
  const double wrong[] = {0, std::nan(""), 0};
  image_.target = wrong;
  reject("finite", pixels.size());
  image_ = valid;
  image_.fovy = 171;
  reject("fovy", pixels.size());
  image_ = valid;
  image_.size = 1;
  reject("LIMBER_IMAGE", pixels.size());
  image_ = valid;
  const double same[] = {1, 2, 3};
  image_.position = same;
  image_.target = same;
  reject("the same point", pixels.size());
  EXPECT_EQ(limber_render(sim_, nullptr, pixels.data(), pixels.size()), LIMBER_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace limber::render::test

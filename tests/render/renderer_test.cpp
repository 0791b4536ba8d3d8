// Rendered images: positions, colors and lighting; the expected pixels are computed independently.
#include "ui/render/renderer.h"

#include <array>
#include <cmath>

#include "base/color.h"
#include "render/stage.h"

namespace limber::render::test {
namespace {

const Vec3 kRed{0, 1, 1};
const Vec3 kGreen{1.0 / 3, 1, 1};

bool is_red(const Vec3& c) { return c.x > 60 && c.x > 3 * c.y && c.x > 3 * c.z; }

double hue(const Vec3& c) { return hsb_of(c / 255.0).x; }

TEST(Renderer, BoxCoversTheProjectedPixels) {
  TestScene scene;
  scene.set("/visuals/look/floor", {0});
  scene.add("box", box({1, 0.02, 0.5}), {0.5, 0, 1.25});
  scene.paint("box", kRed);
  scene.set("/visuals/shape/box/specular_scale", {0});
  // rim light would change the color of the box
  scene.set("/visuals/look/rim", {0});
  scene.look_from({0, -4, 1}, {0, 0, 1});
  const auto now = scene.snapshot();
  const Pixels image = draw(*now, 320, 180, Quality::low);
  // its face towards the eye: x 0..1, z 1..1.5, y -0.01
  const Spot low = spot_of(*now, {0, -0.01, 1}, 320, 180);
  const Spot high = spot_of(*now, {1, -0.01, 1.5}, 320, 180);
  ASSERT_GT(high.x, low.x + 20);
  ASSERT_LT(high.y, low.y - 10);
  int red = 0;
  for (int y = 0; y < 180; y++) {
    for (int x = 0; x < 320; x++) {
      const bool inside = x > low.x + 1 && x < high.x - 1 && y > high.y + 1 && y < low.y - 1;
      const bool outside = x < low.x - 2 || x > high.x + 2 || y < high.y - 2 || y > low.y + 2;
      const Vec3 c = color(image, x, y);
      red += is_red(c) ? 1 : 0;
      if (inside) {
        EXPECT_TRUE(is_red(c)) << x << " " << y << " " << c.x << " " << c.y << " " << c.z;
      }
      if (outside) {
        EXPECT_FALSE(is_red(c)) << x << " " << y;
      }
    }
  }
  EXPECT_NEAR(red, (high.x - low.x) * (low.y - high.y), 0.12 * (high.x - low.x) * (low.y - high.y));
}

TEST(Renderer, ImageIsNotMirrored) {
  TestScene scene;
  scene.add("right", box(Vec3(0.5)), {1, 0, 1});
  scene.add("left", box(Vec3(0.5)), {-1, 0, 1});
  scene.paint("right", kRed);
  scene.paint("left", kGreen);
  scene.look_from({0, -5, 1}, {0, 0, 1});
  const Pixels image = draw(scene);
  int red = 0;
  int green = 0;
  for (int y = 0; y < 90; y++) {
    for (int x = 80; x < 160; x++) {
      const Vec3 c = color(image, x, y);
      red += is_red(c) ? 1 : 0;
      green += c.y > 60 && c.y > 3 * c.x && c.y > 3 * c.z ? 1 : 0;
    }
  }
  EXPECT_GT(red, 50);
  EXPECT_EQ(green, 0);
}

TEST(Renderer, BackgroundHasTheSetColor) {
  TestScene scene;
  const Vec3 orange{0.08, 0.8, 0.5};
  scene.set("/visuals/background", {orange.x, orange.y, orange.z});
  scene.set("/visuals/look/floor", {0});
  scene.look_from({0, 0, 1}, {5, 0, 1});
  for (const double style : {0.0, 1.0}) {
    scene.set("/visuals/look/style", {style});
    const Pixels image = draw(scene);
    const Vec3 horizon = color(image, 80, 46) / 255.0;
    EXPECT_LT(glm::length(horizon - rgb_of(orange)), 0.03) << horizon.x << " " << horizon.y << " " << horizon.z;
    EXPECT_LT(brightness(image, 80, 0), brightness(image, 80, 46)) << "darker towards the zenith";
  }
}

TEST(Renderer, HorizonHasNoEdge) {
  for (const double style : {0.0, 1.0}) {
    TestScene scene;
    scene.set("/visuals/look/style", {style});
    scene.set("/visuals/look/grid", {0});
    const Vec3 eye{0, -8, 3};
    scene.look_from(eye, {0, 0, 1.2});
    // a background similar to the floor would hide an edge; with a different background, the floor's color changes
    // quickly, but must equal the background where the floor ends, about 14 rows below the horizon
    for (const auto& [far, background] : {std::pair(200.0, 0.0), {30.0, 0.0}, {200.0, 0.9}}) {
      if (background > 0) scene.set("/visuals/background", {0.33, 0.9, background});
      scene.set("/visuals/camera/far", {far});
      const auto now = scene.snapshot();
      const Pixels image = draw(*now, 64, 360, Quality::high);
      const int horizon = spot_of(*now, eye + Vec3(0, 1e6, 0), 64, 360).y;
      ASSERT_GT(horizon, 60);
      const int below = background > 0 ? 16 : 60;
      for (int y = horizon - 60; y < horizon + below; y++)
        EXPECT_LE(std::abs(brightness(image, 8, y) - brightness(image, 8, y + 1)), 2)
            << "style " << style << " far " << far << " row " << y;
    }
  }
}

// the center of a ball's shadow on the floor
Vec3 shadow_of(const engine::Snapshot& now, const Vec3& ball, double radius) {
  const CameraMatrices view_camera = camera_matrices(engine::camera_of(now), 160, 90);
  const Lighting lighting = compute_lighting(engine::appearance_of(now), view_camera, engine::camera_of(now).far,
                                             {glm::vec3(ball), static_cast<float>(radius), 0, 1024});
  const Vec3 light(lighting.frame.light_position);
  const Vec3 direction = lighting.frame.light_position.w > 0.5 ? normalized(light - ball) : normalized(light);
  return ball - direction * (ball.z / direction.z);
}

TEST(Renderer, ShadowFollowsTheLampAndItsStrength) {
  for (const double style : {0.0, 1.0}) {
    for (const Quality quality : {Quality::low, Quality::high}) {
      TestScene scene;
      const Vec3 at{0, 0, 0.6};
      scene.add("ball", round(model::ShapeKind::sphere, 0.3), at);
      scene.set("/visuals/look/style", {style});
      scene.set("/visuals/look/grid", {0});
      scene.set("/visuals/look/mirror", {0});
      scene.look_from({0, -3, 4}, {0, 0, 0});
      const auto now = scene.snapshot();
      const Spot spot = spot_of(*now, shadow_of(*now, at, 0.3), 160, 90);
      const double shadow = brightness(draw(*now, 160, 90, quality), spot.x, spot.y);
      scene.set("/visuals/look/shadow", {0.5});
      const double half = brightness(draw(scene, 160, 90, quality), spot.x, spot.y);
      scene.set("/visuals/look/shadow", {0});
      const double none = brightness(draw(scene, 160, 90, quality), spot.x, spot.y);
      EXPECT_LT(shadow + 15, half) << "style " << style;
      EXPECT_LT(half + 8, none) << "style " << style;
    }
  }
}

TEST(Renderer, ContactShadowsDarkenTheFloor) {
  TestScene scene;
  scene.add("ball", round(model::ShapeKind::sphere, 0.3), {0, 0, 0.3});
  scene.set("/visuals/look/style", {1});
  scene.set("/visuals/look/lamp", {0});  // ambient light only
  scene.look_from({0, -3, 2}, {0, 0, 0});
  const auto now = scene.snapshot();
  const Pixels image = draw(*now, 320, 180, Quality::high);
  const Spot near = spot_of(*now, {0.1, -0.15, 0}, 320, 180);  // 6 cm below the ball
  const Spot away = spot_of(*now, {0.9, -0.2, 0}, 320, 180);
  EXPECT_LT(brightness(image, near.x, near.y) + 6, brightness(image, away.x, away.y));
}

TEST(Renderer, StudioIsBrightAndStageIsDark) {
  TestScene scene;
  scene.add("box", box(Vec3(0.5)), {0, 0, 0.25});
  const double dark = brightness(draw(scene));
  scene.set("/visuals/look/style", {1});
  const double bright = brightness(draw(scene));
  EXPECT_LT(dark, 50);
  EXPECT_GT(bright, 170);
}

TEST(Renderer, OnlyTheStageHasReflections) {
  TestScene scene;
  scene.add("box", box({0.4, 0.4, 0.8}), {0, 0, 0.5});
  scene.paint("box", kRed);
  scene.look_from({0, -4, 1}, {0, 0, 0.4});
  const auto now = scene.snapshot();
  // the mirrored front face begins as far below the floor as the box is above it
  const Spot mirrored = spot_of(*now, {0, -0.2, -0.3}, 160, 90);
  const Vec3 with = color(draw(*now, 160, 90, Quality::medium), mirrored.x, mirrored.y);
  scene.set("/visuals/look/mirror", {0});
  const Vec3 without = color(draw(scene, 160, 90, Quality::medium), mirrored.x, mirrored.y);
  EXPECT_GT(with.x - with.y, without.x - without.y + 12) << with.x << " " << without.x;
  scene.set("/visuals/look/mirror", {1});
  scene.set("/visuals/look/style", {1});
  const Vec3 studio = color(draw(scene, 160, 90, Quality::medium), mirrored.x, mirrored.y);
  EXPECT_LT(std::abs(studio.x - studio.y), 12);
}

TEST(Renderer, GlassShowsObjectsBehindItInAnyOrder) {
  for (const bool glass_first : {true, false}) {
    TestScene scene;
    const auto glass = [&] {
      scene.add("glass", box({1, 0.1, 1}), {0, -1, 1});
      scene.paint("glass", kRed);
      scene.set("/visuals/shape/glass/transparency", {0.5});
    };
    if (glass_first) glass();
    scene.add("solid", box({1, 0.1, 1}), {0, 0, 1});
    scene.paint("solid", kGreen);
    if (!glass_first) glass();
    scene.add("clear", box({1, 0.1, 1}), {0, -2, 1});
    scene.set("/visuals/shape/clear/transparency", {1});
    scene.look_from({0, -6, 1}, {0, 0, 1});
    const Vec3 c = color(draw(scene), 80, 45);
    EXPECT_GT(c.x, 40) << "the glass";
    EXPECT_GT(c.y, 40) << "the object behind it";
    EXPECT_LT(c.z, 40) << "and not the hidden object";
  }
}

TEST(Renderer, NearerGlassContributesMore) {
  TestScene scene;
  scene.look_from({0, -6, 1}, {0, 0, 1});
  scene.add("near", box({1, 0.1, 1}), {0, -1, 1});
  scene.add("far", box({1, 0.1, 1}), {0, 0, 1});
  scene.paint("near", kRed);
  scene.paint("far", kGreen);
  for (const char* name : {"near", "far"}) scene.set(fmt::format("/visuals/shape/{}/transparency", name), {0.3});
  const Vec3 front = color(draw(scene), 80, 45);
  scene.look_from({0, 6, 1}, {0, 0, 1});
  const Vec3 back = color(draw(scene), 80, 45);
  EXPECT_GT(front.x, front.y);
  EXPECT_GT(back.y, back.x);
}

TEST(Renderer, MaterialsAreProperties) {
  TestScene scene;
  scene.add("ball", round(model::ShapeKind::sphere, 0.5), {0, 0, 1});
  scene.look_from({0, -3, 1}, {0, 0, 1});
  for (const double h : {0.0, 0.25, 0.5, 0.75}) {
    scene.paint("ball", {h, 1, 1});
    scene.set("/visuals/look/style", {1});
    scene.set("/visuals/shape/ball/specular_scale", {0});
    scene.set("/visuals/look/rim", {0});
    const double seen = hue(color(draw(scene), 88, 40));
    const double off = std::abs(seen - h);
    EXPECT_LT(std::min(off, 1 - off), 0.06) << h << " is seen as " << seen;
  }
  scene.paint("ball", {0, 0, 1});
  const double lit = brightness(draw(scene), 88, 40);
  scene.set("/visuals/shape/ball/diffuse_scale", {0});
  const double unlit = brightness(draw(scene), 88, 40);
  scene.set("/visuals/shape/ball/ambient_scale", {0});
  EXPECT_GT(lit, unlit + 15);
  EXPECT_LT(brightness(draw(scene), 88, 40), 20) << "no light of any kind, but a little fog";
}

// A new scene with one shape, of which only diffuse_color is set: the centers of its faces have this hue, on lit and on
// unlit sides.
TEST(Renderer, ShapeHasTheColorThatWasSet) {
  for (const double style : {0.0, 1.0}) {
    for (const double h : {0.0, 1.0 / 6, 1.0 / 3, 2.0 / 3}) {
      SCOPED_TRACE(fmt::format("style {}, hue {}", style, h));
      TestScene scene;
      scene.set("/visuals/look/style", {style});
      scene.add("shape", box({1, 1, 1}), {0, 0, 0.5});
      scene.set("/visuals/shape/shape/diffuse_color", {h, 1, 1});
      scene.look_from({3, -4, 3}, {0, 0, 0.5});
      const auto now = scene.snapshot();
      const Pixels pixels = draw(*now, 160, 90);
      // the centers of the three visible faces: top, front, right
      for (const Vec3& face : {Vec3(0, 0, 1), Vec3(0, -0.5, 0.5), Vec3(0.5, 0, 0.5)}) {
        const Spot at = spot_of(*now, face, 160, 90);
        const Vec3 seen = color(pixels, at.x, at.y);
        const double off = std::abs(hue(seen) - h);
        EXPECT_LT(std::min(off, 1 - off), 0.04) << seen.x << " " << seen.y << " " << seen.z;
        EXPECT_GT(hsb_of(seen / 255.0).y, 0.65) << seen.x << " " << seen.y << " " << seen.z;
        EXPECT_GT(hsb_of(seen / 255.0).z, 0.35) << seen.x << " " << seen.y << " " << seen.z;
      }
    }
  }
}

TEST(Renderer, ExposureIncreasesBrightness) {
  TestScene scene;
  scene.add("ball", round(model::ShapeKind::sphere, 0.5), {0, 0, 0.5});
  scene.set("/visuals/look/style", {1});
  double before = -1;
  for (const double exposure : {0.0, 0.3, 1.0, 4.0}) {
    scene.set("/visuals/look/exposure", {exposure});
    const double now = brightness(draw(scene));
    EXPECT_GT(now, before + 1) << exposure;
    before = now;
  }
}

TEST(Renderer, RenderingIsDeterministic) {
  TestScene scene;
  scene.add("ball", round(model::ShapeKind::sphere, 0.5), {0, 0, 0.5});
  const auto now = scene.snapshot();
  const Pixels first = draw(*now, 160, 90, Quality::high);
  (void)draw(*now, 31, 17, Quality::high);
  EXPECT_EQ(draw(*now, 160, 90, Quality::high).bytes, first.bytes);
}

TEST(Renderer, HandlesAnEmptySceneAndOnePixel) {
  TestScene scene;
  for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 50}, {50, 1}, {0, 0}}) {
      const Pixels image = draw(scene, width, height, quality);
      EXPECT_EQ(image.bytes.size(), 4u * static_cast<unsigned>(std::max(width, 1) * std::max(height, 1)));
      EXPECT_EQ(image.at(0, 0)[3], 255);
    }
  }
}

TEST(Renderer, RejectsATooLargeImage) {
  TestScene scene;
  Renderer& small = renderer(Quality::low);
  const Result<void> result = small.draw(*scene.snapshot(), small.max_size() + 1, 10);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().find("too large"), std::string::npos) << result.error();
  EXPECT_EQ(draw(scene, 20, 10).width, 20) << "and the next one is drawn";
}

TEST(Renderer, HandlesExtremeValues) {
  TestScene scene;
  scene.add("ball", round(model::ShapeKind::sphere, 1e4), {3e4, 0, 0});
  scene.add("dust", box(Vec3(1e-4)), {0, 0, 1});
  scene.add("disc", round(model::ShapeKind::cylinder, 5, 1e-4), {0, 0, 2});
  scene.add("cone", round(model::ShapeKind::cone, 1e-4, 10), {0, 1, 2});
  scene.add("plane", plane());
  for (const char* name : {"ball", "dust", "disc", "cone", "plane"}) {
    for (const char* property : {"ambient_scale", "diffuse_scale", "specular_scale"})
      scene.set(fmt::format("/visuals/shape/{}/{}", name, property), {10});
    scene.set(fmt::format("/visuals/shape/{}/specular_pow", name), {1000});
    scene.set(fmt::format("/visuals/shape/{}/transparency", name), {0.999});
  }
  for (const char* property : {"exposure", "ambient", "lamp", "rim", "fog", "grid"})
    scene.set(fmt::format("/visuals/look/{}", property), {10});
  scene.set("/visuals/look/mirror", {3});
  scene.set("/visuals/camera/near", {1e4});
  scene.set("/visuals/camera/far", {0.01});
  EXPECT_EQ(draw(scene, 64, 36, Quality::high).at(0, 0)[3], 255);
  scene.set("/visuals/camera/fovy", {170});
  scene.set("/visuals/camera/near", {1e-4});
  scene.set("/visuals/camera/far", {1e7});
  scene.set("/visuals/camera/aspect", {100});
  EXPECT_GT(brightness(draw(scene, 64, 36, Quality::high)), 1);
}

TEST(Renderer, ObjectsBelowGroundAreVisibleWithoutAFloor) {
  TestScene scene;
  scene.add("ball", round(model::ShapeKind::sphere, 1));
  scene.paint("ball", kGreen);
  scene.look_from({0, -3, 1}, {0, 0, 0});
  for (const double studio : {0.0, 1.0}) {
    scene.set("/visuals/look/style", {studio});
    scene.set("/visuals/look/floor", {1});
    const Vec3 hidden = color(draw(scene, 64, 36), 32, 30);
    EXPECT_FALSE(hidden.y > 1.3 * hidden.x && hidden.y > 1.3 * hidden.z) << "by the floor";
    scene.set("/visuals/look/floor", {0});
    const Vec3 seen = color(draw(scene, 64, 36), 32, 30);
    EXPECT_GT(seen.y, 1.3 * seen.x);
    EXPECT_GT(seen.y, 1.3 * seen.z);
  }
}

// rings of triangles, about as many as in a 3D scan
TEST(Renderer, DrawsALargeMeshInEachQuality) {
  constexpr unsigned kAround = 224;
  auto mesh = std::make_shared<model::MeshModel>();
  for (unsigned i = 0; i <= kAround; i++) {
    for (unsigned k = 0; k < kAround; k++) {
      const double up = kPi * i / kAround;
      const double azimuth = 2 * kPi * k / kAround;
      mesh->vertices.emplace_back(std::sin(up) * std::cos(azimuth), std::sin(up) * std::sin(azimuth), std::cos(up));
    }
  }
  for (unsigned i = 0; i < kAround; i++) {
    for (unsigned k = 0; k < kAround; k++) {
      const unsigned a = i * kAround + k;
      const unsigned b = i * kAround + (k + 1) % kAround;
      for (const unsigned v : {a, a + kAround, b, b, a + kAround, b + kAround}) mesh->triangles.push_back(v);
    }
  }
  ASSERT_GT(mesh->triangles.size(), 300000u);
  mesh->hull = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  model::ShapeModel model;
  model.kind = model::ShapeKind::mesh;
  model.mesh = mesh;
  TestScene scene;
  scene.set("/visuals/look/floor", {0});
  scene.look_from({0, -3, 1.5}, {0, 0, 0});
  const Pixels without = draw(scene, 64, 36);
  scene.add("scan", model);
  scene.paint("scan", kGreen);
  for (const Quality quality : {Quality::low, Quality::high}) {
    const Vec3 c = color(draw(scene, 64, 36, quality), 32, 18);
    EXPECT_GT(c.y, c.x + 20);
    EXPECT_GT(c.y, c.z + 20);
  }
  EXPECT_NE(draw(scene, 64, 36).bytes, without.bytes);
}

TEST(Renderer, DrawsManyPartsOfEveryKind) {
  TestScene scene;
  const model::ShapeModel models[] = {
      box(Vec3(0.1)), round(model::ShapeKind::sphere, 0.05), round(model::ShapeKind::capsule, 0.03, 0.1),
      round(model::ShapeKind::cylinder, 0.05, 0.1), round(model::ShapeKind::cone, 0.05, 0.1)};
  std::vector<sim::Shape*> shapes;
  for (const model::ShapeModel& model : models)
    shapes.push_back(*scene.world.shapes().add(fmt::format("s{}", shapes.size()), model));
  sim::Body& body = **scene.world.add_body("many");
  for (int i = 0; i < 3000; i++) {
    const int property = i / 60;
    const Vec3 at(0.2 * (i % 60) - 6, 0.2 * property - 5, 0.1);
    ASSERT_TRUE(
        body.add_part(fmt::format("p{}", i), *shapes[static_cast<std::size_t>(i) % 5], 0, {at, quat_identity()}).ok());
  }
  scene.set("/visuals/look/style", {1});
  const auto all = scene.snapshot();
  const Pixels image = draw(*all, 64, 36);
  scene.world.remove_body(body);
  EXPECT_NE(draw(scene, 64, 36).bytes, image.bytes) << "they vanish at once";
}

}  // namespace
}  // namespace limber::render::test

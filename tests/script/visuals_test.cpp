// Lua's `visuals`: background, both ways to set the camera, materials by shape name.
#include <gtest/gtest.h>

#include "properties/catalog.h"
#include "stage.h"

namespace limber::script {
namespace {

struct VisualsTest : testing::Test {
  ScriptFixture fixture;
  std::vector<double> read(const std::string& path) {
    const Result<PropertyRef> place = find_property(fixture.store, path);
    EXPECT_TRUE(place.ok()) << path;
    std::vector<double> out(place->property->width);
    fixture.store.get(place->node, *place->property, out.data());
    return out;
  }
};

TEST_F(VisualsTest, CanBeSetFromAScene) {
  const std::string fault = fixture.run(R"(
    local ball = sim:add_sphere_shape("ball", 0.1)
    visuals.background = rgb(0, 0, 0.5)
    visuals:shape("ball").transparency = 0.25
    ball.diffuse_color = rgb(0, 1, 0)
    visuals.camera.projection = { 65.9, 0, 0.5, 150 }
    visuals.camera:look_at(vec3(3, -4, 2), vec3(0, 0, 2))
  )");
  ASSERT_EQ(fault, "");
  EXPECT_EQ(read("/visuals/background"), (std::vector<double>{4.0 / 6, 1, 0.5}));
  EXPECT_EQ(read("/visuals/shape/ball/transparency"), std::vector<double>{0.25});
  EXPECT_EQ(read("/visuals/shape/ball/diffuse_color"), (std::vector<double>{2.0 / 6, 1, 1}));
  EXPECT_EQ(read("/visuals/camera/fovy"), std::vector<double>{65.9});
  EXPECT_EQ(read("/visuals/camera/far"), std::vector<double>{150});
  const std::vector<double> eye = read("/visuals/camera/eye");
  const std::vector<double> target = read("/visuals/camera/target");
  const double wanted_eye[] = {3, -4, 2};
  const double wanted_target[] = {0, 0, 2};
  for (std::size_t i = 0; i < 3; i++) {
    EXPECT_NEAR(eye[i], wanted_eye[i], 1e-9);
    EXPECT_NEAR(target[i], wanted_target[i], 1e-9);
  }
}

TEST_F(VisualsTest, LookAtSwapsEyeAndTarget) {
  ASSERT_EQ(fixture.run(R"(
    local camera = visuals.camera
    camera:look_at(vec3(4, 0, 0), vec3(0, 0, 0))
    camera:look_at(camera.target, camera.eye)
  )"),
            "");
  EXPECT_NEAR(read("/visuals/camera/eye")[0], 0, 1e-9);
  EXPECT_NEAR(read("/visuals/camera/target")[0], 4, 1e-9);
}

TEST_F(VisualsTest, CanBeReadInAScene) {
  EXPECT_EQ(value_of("visuals.camera.projection[1], visuals.camera.aspect"), "40\t0");
  EXPECT_EQ(value_of("visuals.camera == visuals.camera, visuals.alive, tostring(visuals.camera)"),
            "true\ttrue\tvisuals.camera");
}

TEST_F(VisualsTest, TheCameraGlidesAndFollows) {
  ASSERT_EQ(fixture.play(R"(
    local ball = sim:add_body("ball")
    ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 5) })
    local camera = visuals.camera
    sim:on_start(function() camera:look_at(vec3(0, -4, 1), vec3(0, 0, 1), 0.5) end)
    sim:after(1, function() camera:follow(ball:part("ball")) end)
    sim:after(2, function() camera:follow(nil) end)
  )",
                         31),
            "");
  EXPECT_NEAR(read("/visuals/camera/eye")[1], -4, 1e-9);
  fixture.tick(80);
  const double height = fixture.world.find_body("ball")->pose().position.z;
  EXPECT_LT(height, 2);
  EXPECT_NEAR(read("/visuals/camera/target")[2], height, 1e-9);
  EXPECT_NEAR(read("/visuals/camera/eye")[1], -4, 1e-9);
  fixture.tick(40);
  EXPECT_GT(read("/visuals/camera/target")[2], fixture.world.find_body("ball")->pose().position.z + 1)
      << "it follows nothing now";
}

TEST_F(VisualsTest, RejectsInvalidArguments) {
  EXPECT_NE(error_of("visuals.camera:look_at(vec3(1, 0, 0), vec3(), 0)").find("seconds above 0, not 0"),
            std::string::npos);
  EXPECT_NE(error_of("visuals.camera:look_at(vec3(1, 0, 0), vec3(), 1)").find("use sim:on_start"), std::string::npos);
  EXPECT_NE(
      value_of("pcall(function() visuals.camera:look_at(vec3(1, 0, 0), vec3(0, 0, 0), 0 / 0) end)").find("finite"),
      std::string::npos);
  EXPECT_NE(error_of("visuals.camera:follow(sim)").find("use sim:on_start"), std::string::npos);
  ASSERT_EQ(fixture.play("sim:on_start(function() visuals.camera:follow(sim) end)\n"
                         "sim:on_start(function() visuals.camera:look_at(vec3(0 / 0, 0, 1), vec3(), 1) end)"),
            "");
  ASSERT_EQ(fixture.host.faults.size(), 2u);
  EXPECT_NE(fixture.host.faults[1].text.find("look_at takes finite numbers"), std::string::npos);
  EXPECT_NE(fixture.host.faults[0].text.find("a body, a part, or nil, not sim"), std::string::npos);
  EXPECT_NE(error_of("visuals.camera.projection = { 40, 1, 10, 5 }").find("far must be greater than near"),
            std::string::npos);
  EXPECT_NE(error_of("visuals.camera.projection = 40").find("takes { fovy, aspect, near, far }"), std::string::npos);
  EXPECT_NE(error_of("visuals.camera.fov = 40").find("did you mean 'fovy'?"), std::string::npos);
  EXPECT_NE(error_of("visuals:shape('ball')").find("there is no shape 'ball'"), std::string::npos);
  EXPECT_NE(error_of("visuals.camera.look_at(vec3(), vec3())").find("colon"), std::string::npos);
}

}  // namespace
}  // namespace limber::script

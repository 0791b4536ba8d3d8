// The camera's two representations, the shapes' materials, and those of a robot's file.
#include "sim/visuals/visuals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/color.h"
#include "model/urdf/import.h"
#include "sim/world/world.h"
#include "support/world_objects.h"

namespace limber::sim {
namespace {

struct VisualsTest : testing::Test {
  Store store;
  World world{store};
  NodeId camera = world.visuals().camera().id();

  std::vector<double> get(NodeId id, const char* name) const {
    const Property& property = store.table(id).at(name);
    std::vector<double> out(property.width);
    store.get(id, property, out.data());
    return out;
  }
  void set(NodeId id, const char* name, std::vector<double> values) {
    ASSERT_TRUE(store.set(id, name, values).ok()) << name;
  }
  void expect_near(const std::vector<double>& is, const std::vector<double>& wanted) const {
    ASSERT_EQ(is.size(), wanted.size());
    for (std::size_t i = 0; i < is.size(); i++) EXPECT_NEAR(is[i], wanted[i], 1e-9) << i;
  }
};

TEST_F(VisualsTest, EyeMatchesTheViewMatrix) {
  // without rotation the eye looks down: the view is a translation, with the origin 5 m in front
  set(camera, "position", {0, 0, -5});
  set(camera, "rotation", {0, 0, 0});
  set(camera, "distance", {5});
  expect_near(get(camera, "eye"), {0, 0, 5});
  expect_near(get(camera, "target"), {0, 0, 0});
  // rotated by −90° about x, the view's −z is the world's y: from the south, 4 m away and 1 m up
  set(camera, "position", {0, -1, -4});
  set(camera, "rotation", {-90, 0, 0});
  expect_near(get(camera, "eye"), {0, -4, 1});
  expect_near(get(camera, "target"), {0, 1, 1});
  // an example from ofxDabPhysics, computed manually: Rz(−24°), then Rx(−80°), the eye at −Rᵀ·(0, −4, −3.9)
  set(camera, "position", {0, -4, -3.9});
  set(camera, "rotation", {-80, 0, -24});
  const double x = -80 * kPi / 180;
  const double z = -24 * kPi / 180;
  const double y1 = 4 * std::cos(x) + 3.9 * std::sin(x);
  const double z1 = -4 * std::sin(x) + 3.9 * std::cos(x);
  expect_near(get(camera, "eye"), {y1 * std::sin(z), y1 * std::cos(z), z1});
}

TEST_F(VisualsTest, EyeAndTargetAreConsistentWithPositionAndRotation) {
  set(camera, "eye", {3, -4, 2});
  set(camera, "target", {0, 0, 2});
  // level, 5 m away; the heading of (−3, 4) is 90° − atan2(4, −3)
  expect_near(get(camera, "rotation"), {-90, 0, 90 - std::atan2(4, -3) * 180 / kPi});
  expect_near(get(camera, "distance"), {5});
  expect_near(get(camera, "eye"), {3, -4, 2});
  expect_near(get(camera, "target"), {0, 0, 2});
  // setting one of the two leaves the other unchanged
  set(camera, "eye", {0, 0, 9});
  expect_near(get(camera, "target"), {0, 0, 2});
  expect_near(get(camera, "rotation"), {0, 0, 0});
  set(camera, "target", {0, 0, 12});
  expect_near(get(camera, "eye"), {0, 0, 9});
  expect_near(get(camera, "distance"), {3});
  // eye and target at the same point: no rotation
  set(camera, "target", {0, 0, 9});
  expect_near(get(camera, "target"), {0, 0, 12});
}

TEST_F(VisualsTest, ColorsAreHueSaturationBrightness) {
  EXPECT_EQ(hsb_of({0, 0, 0}), Vec3(0, 0, 0));
  EXPECT_EQ(hsb_of({0.5, 0.5, 0.5}), Vec3(0, 0, 0.5));
  EXPECT_EQ(hsb_of({1, 0, 0}), Vec3(0, 1, 1));
  EXPECT_EQ(hsb_of({0, 1, 0}), Vec3(2.0 / 6, 1, 1));
  EXPECT_EQ(hsb_of({0, 0, 0.5}), Vec3(4.0 / 6, 1, 0.5));
  EXPECT_NEAR(hsb_of({1, 0, 0.5}).x, 5.5 / 6, 1e-12);
}

TEST_F(VisualsTest, ShapesOfARobotHaveTheColorsOfItsFile) {
  const char* const urdf = R"(<robot name="rob"><link name="a">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><sphere radius="0.2"/></geometry><material name="m"><color rgba="0 1 0 0.75"/></material></visual>
    <visual><geometry><box size="1 1 1"/></geometry></visual>
  </link></robot>)";
  model::MeshLibrary meshes;
  const auto model = *model::import_urdf_text(urdf, "rob.urdf", {}, meshes);
  ASSERT_NE(model, nullptr);
  ASSERT_TRUE(world.add_body(model, "one", {}).ok());
  ASSERT_TRUE(world.add_body(model, "two", {}).ok());
  ASSERT_EQ(world.shapes().list().size(), 2u) << "both bodies share them";
  const Shape* const green = world.shapes().find("rob.a");
  const Shape* const plain = world.shapes().find("rob.a.2");
  ASSERT_TRUE(green != nullptr && plain != nullptr);
  EXPECT_EQ(green->model().kind, model::ShapeKind::sphere);
  EXPECT_EQ(get(green->id(), "diffuse_color"), (std::vector<double>{2.0 / 6, 1, 1}));
  EXPECT_EQ(get(green->id(), "transparency"), std::vector<double>{0.25});
  EXPECT_EQ(store.explicitly_set(green->id()), 0u) << "a color from a file does not count as set by a script";
  EXPECT_EQ(get(plain->id(), "diffuse_color"), (std::vector<double>{0, 0, 1}));
  // a value that was set isn't changed when another body of the model is added
  set(green->id(), "diffuse_color", {0.5, 1, 1});
  ASSERT_TRUE(world.add_body(model, "three", {}).ok());
  EXPECT_EQ(get(green->id(), "diffuse_color"), (std::vector<double>{0.5, 1, 1}));
}

TEST_F(VisualsTest, ClearingTheWorldRestoresDefaults) {
  const std::vector<double> eye = get(camera, "eye");
  set(camera, "eye", {1, 2, 3});
  set(world.visuals().id(), "background", {0.1, 1, 1});
  world.clear();
  expect_near(get(camera, "eye"), eye);
  const Property& background = Visuals::table().at("background");
  EXPECT_EQ(get(world.visuals().id(), "background")[1], background.initial[1]);
}

TEST_F(VisualsTest, ColorSetsBothColors) {
  model::ShapeModel ball;
  ball.kind = model::ShapeKind::sphere;
  const NodeId shape = (*world.shapes().add("ball", ball))->id();
  set(shape, "color", {0.3, 0.6, 0.9});
  EXPECT_EQ(get(shape, "ambient_color"), (std::vector<double>{0.3, 0.6, 0.9}));
  EXPECT_EQ(get(shape, "diffuse_color"), (std::vector<double>{0.3, 0.6, 0.9}));
  set(shape, "diffuse_color", {0.1, 1, 1});
  EXPECT_EQ(get(shape, "color"), (std::vector<double>{0.1, 1, 1}));
  EXPECT_EQ(get(shape, "ambient_color"), (std::vector<double>{0.3, 0.6, 0.9}));
}

}  // namespace
}  // namespace limber::sim

// Bodies: creating, copying, moving, resetting, removing; names and stale ids.
#include "sim/world/body.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/arm.h"
#include "sim/bullet/island_world.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

// All readable values of a body and its descendants.
std::vector<double> all_values(WorldFixture& s, const Body& body) {
  std::vector<double> out;
  s.store.walk(body.id(), [&](NodeId id) {
    for (const Property& property : s.store.table(id).properties()) {
      // applied forces are those of the last step, which a copy hasn't had yet
      if (property.kind == PropertyKind::action || property.name.find("applied") != std::string::npos ||
          property.name.find("reaction") != std::string::npos) {
        continue;
      }
      const std::vector<double> v = s.get(id, property.name);
      out.insert(out.end(), v.begin(), v.end());
    }
  });
  return out;
}

// Changes every persistent value of a body's nodes from its default.
void change_all_settings(WorldFixture& s, Body& body) {
  int n = 1;
  s.store.walk(body.id(), [&](NodeId id) {
    for (const Property& property : s.store.table(id).properties()) {
      if (property.kind != PropertyKind::setting || !property.stored()) continue;
      std::vector<double> v(property.width);
      for (std::uint32_t i = 0; i < property.width; i++) {
        const double sample = 0.001 + 0.01 * (n++ % 37);
        v[i] = property.type == PropertyType::flags3 || property.type == PropertyType::boolean
                   ? n % 2
                   : std::clamp(sample, property.min, property.max);
      }
      (void)s.store.set(id, property, v);
    }
  });
}

TEST(BodyTest, CopyHasAllValues) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& arm = make_arm(s, "arm");
  change_all_settings(s, arm);
  set_wave_targets(s, arm, 0.3);
  s.ticks(20);
  Body& twin = **s.world.copy_body(arm, "twin");
  s.world.flush();
  EXPECT_EQ(all_values(s, twin), all_values(s, arm));
  EXPECT_EQ(motion_values(twin), motion_values(arm));
  ASSERT_EQ(twin.parts().size(), arm.parts().size());
  for (std::size_t i = 0; i < arm.parts().size(); i++) {
    EXPECT_EQ(twin.parts()[i]->name(), arm.parts()[i]->name());
    EXPECT_EQ(twin.parts()[i]->is_static(), arm.parts()[i]->is_static());
    EXPECT_EQ(twin.parts()[i]->geometry(), arm.parts()[i]->geometry());
    EXPECT_EQ(twin.parts()[i]->start_pose().position, arm.parts()[i]->start_pose().position);
    EXPECT_EQ(twin.parts()[i]->shape(), arm.parts()[i]->shape());
  }
  for (std::size_t i = 0; i < arm.joints().size(); i++) {
    const bullet::JointConstraint& a = arm.joints()[i]->constraint();
    const bullet::JointConstraint& b = twin.joints()[i]->constraint();
    EXPECT_EQ(twin.joints()[i]->type(), arm.joints()[i]->type());
    for (int axis = 0; axis < 6; axis++) {
      EXPECT_EQ(a.axis(axis).drive, b.axis(axis).drive);
      EXPECT_EQ(a.axis(axis).target, b.axis(axis).target);
      EXPECT_EQ(a.axis(axis).stop_cfm, b.axis(axis).stop_cfm);
    }
  }
}

TEST(BodyTest, CopyOfAnImportedBodyKeepsItsModelAndMimicJoints) {
  auto model = std::make_shared<model::BodyModel>();
  model->name = "pair";
  for (const char* name : {"base", "a", "b"}) {
    model::LinkModel link;
    link.name = name;
    link.inertial = {std::string_view(name) == "base" ? 0.0 : 1.0, Vec3(0), Mat3(0.01)};
    model::PlacedShape box;
    box.shape = box_model(Vec3(0.1));
    link.collisions = {box};
    link.start.position = link.home.position = {model->links.empty() ? 0 : model->links.size() == 1 ? 1. : -1., 0, 0};
    model->links.push_back(link);
  }
  for (int i = 0; i < 2; i++) {
    model::JointModel joint;
    joint.name = i == 0 ? "lead" : "follow";
    joint.parent = 0;
    joint.child = i + 1;
    joint.frame_in_parent.position = {i == 0 ? 1. : -1., 0, 0};
    if (i == 1) {
      joint.mimic = 0;
      joint.mimic_multiplier = -2;
      joint.mimic_offset = 0.1;
    }
    model->joints.push_back(joint);
  }
  model->merged.push_back({"tool", 1, {{0, 0, 0.5}, quat_identity()}});
  WorldFixture s;
  Body& body = **s.world.add_body(model, "body", {});
  Body& twin = **s.world.copy_body(body, "twin");
  twin.set_pose({{0, 5, 0}, quat_identity()});
  s.set(twin.find_motor("lead")->id(), "target", {0.4});
  s.ticks(120);
  EXPECT_NEAR(twin.find_joint("lead")->value(), 0.4, 1e-3);
  EXPECT_NEAR(twin.find_joint("follow")->value(), 0.1 - 2 * 0.4, 5e-3);
  EXPECT_NEAR(body.find_joint("follow")->value(), 0.1, 5e-3);
  const Result<Pose> tool = link_pose(twin, "tool");
  ASSERT_TRUE(tool);
  EXPECT_LT(glm::length(tool->position - Vec3(1, 5, 0.5)), 1e-3);
  EXPECT_EQ(link_pose(twin, "tol").error(), "body 'twin' has no link 'tol'; did you mean 'tool'?");
}

TEST(BodyTest, CopyOfADisabledBodyIsDisabled) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& arm = make_arm(s, "arm");
  s.set(arm.id(), "enabled", {0});
  s.ticks(1);
  Body& twin = **s.world.copy_body(arm, "twin");
  s.ticks(10);
  EXPECT_FALSE(twin.enabled());
  EXPECT_EQ(motion_values(twin), motion_values(arm));
}

// Compares a run with the original to one with a copy in its place.
TEST(BodyTest, CopyMovesLikeTheOriginalBitForBit) {
  std::vector<float> last[2];
  for (int run = 0; run < 2; run++) {
    WorldFixture s;
    s.gravity({0, 0, -9.81});
    s.floor();
    Body* arm = &make_arm(s, "arm", {5, {0.3, -0.2, 0.5}, false});
    set_wave_targets(s, *arm, 0.1);
    if (run == 1) {
      Body& twin = **s.world.copy_body(*arm, "twin");
      s.world.remove_body(*arm);
      arm = &twin;
    }
    for (int i = 0; i < 240; i++) {
      set_wave_targets(s, *arm, 0.1 + s.world.time());
      s.ticks(1);
    }
    last[run] = motion_values(*arm);
  }
  EXPECT_EQ(last[0], last[1]);
}

TEST(BodyTest, CopiesAtOtherPlacesMoveAlike) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& arm = make_arm(s, "arm");
  std::vector<Body*> twins;
  const Vec3 places[] = {{1.5, 0, 0}, {0, -3, 0}, {4, 4, 1}};
  for (const Vec3& place : places) {
    twins.push_back(*s.world.copy_body(arm, "twin" + std::to_string(twins.size())));
    twins.back()->set_pose({place, quat_identity()});
  }
  double max_error = 0;
  for (int i = 0; i < 600; i++) {
    set_wave_targets(s, arm, s.world.time());
    for (Body* twin : twins) set_wave_targets(s, *twin, s.world.time());
    s.ticks(1);
    for (std::size_t t = 0; t < twins.size(); t++) {
      const Vec3 a = arm.parts().back()->pose().position;
      const Vec3 b = twins[t]->parts().back()->pose().position;
      max_error = std::max(max_error, glm::length(b - a - places[t]));
    }
  }
  EXPECT_LT(max_error, 1e-5);
}

TEST(BodyTest, MovedCopyNeverCollidesWithItsOriginal) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {5, {0, 0, 0}, false});
  for (const auto& part : arm.parts()) s.set(part->id(), "report_contacts", {1});
  for (int i = 0; i < 20; i++) {
    Body& twin = **s.world.copy_body(arm, "twin" + std::to_string(i));
    twin.set_pose({{2.0 * (i + 1), 0, 0}, quat_identity()});
  }
  for (int i = 0; i < 10; i++) {
    s.ticks(1);
    EXPECT_TRUE(s.world.sensing().contacts().events().empty());
  }
  EXPECT_LT(glm::length(arm.root()->linear_velocity()), 1e-6);
}

TEST(BodyTest, SetPoseMovesItRigidlyAndKeepsJointAngles) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm");
  for (int i = 0; i < 60; i++) {
    set_wave_targets(s, arm, s.world.time());
    s.ticks(1);
  }
  std::vector<double> angles;
  std::vector<Vec3> speeds;
  for (const auto& joint : arm.joints()) angles.push_back(joint->value());
  for (const auto& part : arm.parts()) speeds.push_back(part->linear_velocity());
  const Pose to{{3, -2, 7}, quat_axis(normalized({1, 1, 0.3}), 2)};
  arm.set_pose(to);
  s.world.flush();
  for (std::size_t i = 0; i < angles.size(); i++) {
    EXPECT_NEAR(arm.joints()[i]->value(), angles[i], 2e-6);
    EXPECT_NEAR(s.number(arm.joints()[i]->id(), "value"), angles[i], 2e-6);
  }
  for (std::size_t i = 0; i < speeds.size(); i++) EXPECT_EQ(arm.parts()[i]->linear_velocity(), speeds[i]);
  EXPECT_LT(glm::length(arm.pose().position - to.position), 1e-12);
  // a static base moves too, and its children stay attached
  s.ticks(60);
  EXPECT_LT(glm::length(arm.parts()[1]->pose().position - to.position), 0.3);
}

TEST(BodyTest, ResetRestoresTheStartPoseWithFullTurns) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {2, {0, 0, 0}, true});
  const std::vector<double> start = [&] {
    s.ticks(1);
    return all_values(s, arm);
  }();
  Motor& motor = *arm.motors()[0];
  s.set(motor.id(), "mode", {1});
  s.set(motor.id(), "speed", {8});
  s.ticks(180);
  EXPECT_GT(arm.joints()[0]->value(), 12);
  s.set(motor.id(), "mode", {2});
  s.set(motor.id(), "speed", {0});
  arm.parts()[1]->apply_force({1000, 0, 0});
  arm.recovery().reset();
  s.world.flush();
  for (const auto& joint : arm.joints()) EXPECT_NEAR(joint->value(), 0, 1e-6);
  for (const auto& part : arm.parts()) {
    EXPECT_EQ(glm::length(part->linear_velocity()) + glm::length(part->angular_velocity()), 0);
  }
  s.ticks(10);
  EXPECT_LT(glm::length(arm.parts()[2]->pose().position - Vec3(0, 0, 0.5)), 1e-5);
  EXPECT_EQ(all_values(s, arm).size(), start.size());
}

TEST(BodyTest, StartPoseIsThePoseBeforeTheFirstStep) {
  WorldFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1);
  ball.body().set_pose({{1, 2, 3}, quat_identity()});
  s.set(ball.id(), "linear_velocity", {1, 0, 0});
  s.ticks(30);
  ball.body().recovery().reset();
  s.world.flush();
  EXPECT_LT(glm::length(ball.pose().position - Vec3(1, 2, 3)), 1e-12);
}

TEST(BodyTest, NamesAreUniqueAndPrintable) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm");
  const auto text = [](const auto& result) { return result ? std::string("none") : result.error(); };
  EXPECT_EQ(text(s.world.add_body("arm")), "there is a body 'arm' already; names are unique");
  EXPECT_EQ(text(s.world.copy_body(arm, "arm")), "there is a body 'arm' already; names are unique");
  EXPECT_EQ(text(s.world.add_body("")), "body: a name must not be empty");
  EXPECT_EQ(text(s.world.add_body("a\x1b")), "body: the name 'a\\x1b' contains unprintable characters");
  Shape& ball = s.shape(sphere_model(0.1));
  EXPECT_EQ(text(arm.add_part("link1", ball, 1, {})), "there is a part 'link1' already; names are unique");
  Part& a = *arm.parts()[1];
  Part& b = *arm.parts()[3];
  EXPECT_EQ(text(arm.add_joint("joint1", a, b, model::JointType::revolute, Vec3(0), {0, 0, 1})),
            "there is a joint 'joint1' already; names are unique");
  EXPECT_EQ(text(s.world.shapes().add("arm link", sphere_model(1))),
            "there is a shape 'arm link' already; names are unique");
  // the same names in another body, and names that differ in case, are free
  EXPECT_TRUE(s.world.add_body("Arm"));
  EXPECT_EQ(s.world.bodies().size(), 2u);
  EXPECT_EQ(s.world.body_names(), (std::vector<std::string_view>{"arm", "Arm"}));
}

TEST(BodyTest, RejectsInvalidPartsAndJoints) {
  WorldFixture s;
  Body& arm = make_arm(s, "arm");
  Body& other = s.body("other");
  Part& base = *arm.parts()[0];
  Part& link = *arm.parts()[1];
  Part& stone = s.part(arm, sphere_model(0.1), 0);
  Part& foreign = s.part(other, sphere_model(0.1), 1);
  const auto joint = [&](Part& p, Part& c, const Vec3& axis) {
    const auto r = arm.add_joint("new", p, c, model::JointType::revolute, Vec3(0), axis);
    return r ? std::string("none") : r.error();
  };
  EXPECT_EQ(joint(link, link, {0, 0, 1}), "joint 'arm/new': parent and child must be different parts");
  EXPECT_EQ(joint(link, foreign, {0, 0, 1}), "joint 'arm/new': both parts must be of this body");
  EXPECT_EQ(joint(base, link, Vec3(0)), "joint 'arm/new': the axis must not be zero");
  EXPECT_EQ(joint(base, stone, {0, 0, 1}), "joint 'arm/new': both parts are static; one must have mass");
  EXPECT_EQ(arm.add_motor(*arm.joints()[0]).error(), "joint 'arm/joint1' has a motor already");
  EXPECT_EQ(other.add_motor(*arm.joints()[0]).error(), "joint 'arm/joint1' belongs to another body");
  EXPECT_EQ(other.add_part("floor", s.shape(plane_model()), 1, {}).error(),
            "part 'other/floor' is a plane: its mass must be 0, not 1 kg");
  model::ShapeModel compound;
  compound.kind = model::ShapeKind::compound;
  Shape& empty = *s.world.shapes().add("empty", compound).value();
  EXPECT_EQ(other.add_part("x", empty, 1, {}).error(),
            "compound 'empty' is empty; add its children before a part is made of it");
  const double nan = std::nan("");
  EXPECT_EQ(other.add_part("x", s.shape(sphere_model(1)), -1, {}).error(),
            "part 'other/x' needs a mass of 0.001 .. 1000000 kg, or 0 for a static part, not -1");
  EXPECT_FALSE(other.add_part("x", s.shape(sphere_model(1)), nan, {}));
  EXPECT_EQ(other.add_part("x", s.shape(sphere_model(1)), 1, {{0, nan, 0}, quat_identity()}).error(),
            "part 'other/x' needs a position of three numbers and a rotation that is not zero");
  EXPECT_FALSE(other.add_part("x", s.shape(sphere_model(1)), 1, {{0, 0, 0}, quat_xyzw(0, 0, 0, 0)}));
  EXPECT_EQ(joint(base, link, {0, nan, 1}), "joint 'arm/new': position and axis must be numbers");
  const double one = 1;
  EXPECT_EQ(s.store.set(base.id(), Part::table().at("mass"), {&one, 1}).error(),
            "/physics/body/arm/part/link0/mass: the part was created static (mass 0); create it with a mass instead");
  EXPECT_EQ(other.parts().size(), 1u);
  EXPECT_EQ(arm.joints().size(), 5u);
}

TEST(BodyTest, CanBeRemovedInAnyOrderWhileTouching) {
  for (int order = 0; order < 4; order++) {
    WorldFixture s;
    s.gravity({0, 0, -9.81});
    s.floor();
    std::vector<std::string> names;
    for (int i = 0; i < 12; i++) {
      Body& arm = make_arm(s, "arm" + std::to_string(i), {3, {0.12 * i, 0, 0.2}, false});  // interpenetrating
      for (const auto& part : arm.parts()) s.set(part->id(), "report_contacts", {1});
      names.push_back(arm.name());
    }
    s.ticks(10);
    std::size_t events = 0;
    while (!names.empty()) {
      const std::size_t at = order == 0 ? 0 : order == 1 ? names.size() - 1 : (names.size() * 7 / 3) % names.size();
      const NodeId removed = s.world.find_body(names[at])->id();
      s.world.remove_body(*s.world.find_body(names[at]));
      EXPECT_FALSE(s.store.alive(removed));
      EXPECT_EQ(s.world.find_body(names[at]), nullptr);
      names.erase(names.begin() + static_cast<std::ptrdiff_t>(at));
      s.ticks(order == 3 ? 0 : 2);
      for (const ContactEvent& e : s.world.sensing().contacts().events()) events += s.store.alive(e.part) ? 1 : 0;
    }
    s.ticks(5);
    EXPECT_EQ(s.world.bodies().size(), 1u);
    EXPECT_EQ(s.world.bullet().getNumCollisionObjects(), 1);
    EXPECT_EQ(s.world.bullet().getNumConstraints(), 0);
    EXPECT_EQ(s.world.bullet().getDispatcher()->getNumManifolds(), 0);
    EXPECT_GE(events, 0u);
  }
}

TEST(BodyTest, SupportsHundredsOfBodies) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  Body& arm = make_arm(s, "arm", {2});
  std::vector<std::uint64_t> hashes;
  for (int i = 1; i < 300; i++) {
    Body& twin = **s.world.copy_body(arm, "arm" + std::to_string(i));
    twin.set_pose({{(i % 20) * 1.0, (i / 20) * 1.0, 0}, quat_identity()});
  }
  s.ticks(5);
  EXPECT_EQ(s.world.bodies().size(), 300u);
  EXPECT_EQ(s.world.bullet().getNumConstraints(), 600);
  EXPECT_EQ(s.world.find_body("arm299")->parts().size(), 3u);
  EXPECT_EQ(s.world.bodies()[299]->name(), "arm299");
  for (int i = 1; i < 300; i += 2) s.world.remove_body(*s.world.find_body("arm" + std::to_string(i)));
  s.ticks(5);
  EXPECT_EQ(s.world.bodies().size(), 150u);
  EXPECT_EQ(s.world.bodies()[149]->name(), "arm298");
  EXPECT_EQ(s.world.stability().events(), 0u);
}

}  // namespace
}  // namespace limber::sim

// mocap_body: a kinematic part of a joint's name is in the middle of the bone that ends there, and points along it.
#include "behaviors/mocap_dancer.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(MocapBody, PutsPartsOnBones) {
  Dancer s({{0, 0, 1}, {0, 2, 1}});
  Body& body = s.body("figure");
  Shape& shape = s.shape(sphere_model(0.1));
  Part& root = **body.add_part("joint0", shape, 0, Pose{});
  Part& bone = **body.add_part("joint1", shape, 0, Pose{});
  Part& other = **body.add_part("other", shape, 0, {{7, 0, 0}, quat_identity()});
  for (const Part* part : {&root, &bone, &other}) s.set(part->id(), "motion", {1});  // kinematic
  s.store.flush();
  BehaviorSetup all;
  all.parts = Selection({"*"});
  s.add(body, "mocap_body", all);
  s.step_behaviors();
  expect_near(root.pose().position, {0, 0, 1}, 1e-9);
  expect_near(bone.pose().position, {0, 1, 1}, 1e-9);
  expect_near(bone.pose().rotation * Vec3(0, 0, 1), {0, 1, 0}, 1e-9);
  expect_near(other.pose().position, {7, 0, 0}, 1e-9);
}

TEST(MocapBody, LeavesDynamicPartsAlone) {
  Dancer s({{0, 0, 1}, {0, 2, 1}});
  Body& body = s.body("figure");
  Part& bone = **body.add_part("joint1", s.shape(sphere_model(0.1)), 1, {{3, 0, 0}, quat_identity()});
  s.add(body, "mocap_body");
  s.step_behaviors();
  expect_near(bone.pose().position, {3, 0, 0}, 1e-9);
}

}  // namespace
}  // namespace limber::sim

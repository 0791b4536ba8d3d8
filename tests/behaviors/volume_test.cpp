// volume: f = min_amp + (max_amp − min_amp)(1 − d/max_dist) between the two parts of each pair.
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

BehaviorSetup of_parts(std::vector<std::string> words) {
  BehaviorSetup setup;
  setup.parts = Selection(std::move(words));
  return setup;
}

TEST(Volume, PushesAPairApartWithOppositeForces) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  Part& two = s.ball(body, {0, 0.25, 0});
  Part& odd = s.ball(body, {0, 0.1, 0});
  Behavior& b = s.add(body, "volume");
  s.set(b.id(), "min_amp", {2});
  s.set(b.id(), "max_amp", {10});
  s.step_behaviors();
  expect_near(s.force(one), {0, -8, 0}, 1e-12);
  expect_near(s.force(two), {0, 8, 0}, 1e-12);
  expect_near(s.force(odd), {0, 0, 0}, 0);
}

TEST(Volume, PairsFollowTheOrderOfNames) {
  Rig s;
  Body& body = s.body("b");
  Shape& shape = s.shape(sphere_model(0.01));
  std::vector<Part*> parts;
  for (const char* name : {"l1", "l2", "r1", "r2"}) {
    const double x = name[0] == 'l' ? 0 : 0.5;
    parts.push_back(*body.add_part(name, shape, 1, {{x, name[1] == '1' ? 0.0 : 5.0, 0}, quat_identity()}));
  }
  s.add(body, "volume", of_parts({"l1", "r1", "l2", "r2"}));
  s.step_behaviors();
  expect_near(s.force(*parts[0]), {-5, 0, 0}, 1e-12, "l1");
  expect_near(s.force(*parts[1]), {-5, 0, 0}, 1e-12, "l2");
  expect_near(s.force(*parts[2]), {5, 0, 0}, 1e-12, "r1");
  expect_near(s.force(*parts[3]), {5, 0, 0}, 1e-12, "r2");
}

TEST(Volume, SupportsPartsInSeveralPairs) {
  Rig s;
  Body& body = s.body("b");
  Shape& shape = s.shape(sphere_model(0.01));
  Part& tip = **body.add_part("tip", shape, 1, Pose{});
  ASSERT_TRUE(body.add_part("x", shape, 1, {{0.5, 0, 0}, quat_identity()}).ok());
  ASSERT_TRUE(body.add_part("y", shape, 1, {{0, 0.5, 0}, quat_identity()}).ok());
  s.add(body, "volume", of_parts({"tip", "x", "tip", "y"}));
  s.step_behaviors();
  expect_near(s.force(tip), {-5, -5, 0}, 1e-12);
}

TEST(Volume, DoesNotActBeyondMaxDistOrBetweenCoincidentParts) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  Part& two = s.ball(body, {0, 0, 0});
  s.add(body, "volume");
  s.step_behaviors();
  expect_near(s.force(one), {0, 0, 0}, 0);
  two.set_pose({{1.0001, 0, 0}, quat_identity()});
  s.step_behaviors();
  expect_near(s.force(two), {0, 0, 0}, 0);
}

}  // namespace
}  // namespace limber::sim

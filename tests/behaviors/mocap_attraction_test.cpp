// mocap_attraction: F = confidence · (stiffness · d + damping · Δv), limited, with d towards a joint or a place on a
// coil.
#include "behaviors/mocap_dancer.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(MocapAttraction, IsASpringToTheJoint) {
  Dancer s({1, 2, 3}, {1, 2, 4});
  Part& part = s.single_ball({1, 0, 3});
  Behavior& b = s.add(part.body(), "mocap_attraction");
  s.set(b.id(), "stiffness", {5});
  s.set(b.id(), "damping", {3});
  part.set_velocity({0.5, 0, 0}, {0, 0, 0});
  s.step_behaviors();
  expect_near(s.force(part), {-1.5, 10, 0}, 1e-9);
  s.clear(part);
  s.set(b.id(), "max_force", {2});
  s.step_behaviors();
  EXPECT_NEAR(glm::length(s.force(part)), 2, 1e-9);
  s.clear(part);
  s.set(b.id(), "max_dist", {1.9});
  s.step_behaviors();
  expect_near(s.force(part), {0, 0, 0}, 0);
}

TEST(MocapAttraction, FollowsConfidence) {
  Dancer s({0, 0, 0}, {0, 0, 1});
  Part& part = s.single_ball({1, 0, 0});
  Behavior& b = s.add(part.body(), "mocap_attraction");
  s.set(b.id(), "stiffness", {8});
  s.set(b.id(), "damping", {0});
  s.set(s.source.id(), "timeout", {0.5});
  s.set(s.source.id(), "fade", {1});
  s.advance(59);  // one second after the frame: half of the fade
  s.step_behaviors();
  expect_near(s.force(part), {-4, 0, 0}, 1e-9);
}

TEST(MocapAttraction, SpreadsPartsOnACoilAroundALimb) {
  Dancer s({0, 0, 1}, {0, 0, 3});
  Body& body = s.body("coil");
  std::vector<Part*> parts;
  for (int i = 0; i < 5; i++) parts.push_back(&s.ball(body, {0, 0, 0}));
  Behavior& b = s.add(body, "mocap_attraction");
  s.set(b.id(), "to_joint", {2});
  s.set(b.id(), "radius", {0.5});
  s.set(b.id(), "turns", {1});
  s.set(b.id(), "stiffness", {1});
  s.set(b.id(), "damping", {0});
  s.step_behaviors();
  for (std::size_t i = 0; i < parts.size(); i++) {
    const Vec3 target = s.force(*parts[i]);  // with a stiffness of 1 N/m, from the origin
    EXPECT_NEAR(target.z, 1 + 0.5 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(std::hypot(target.x, target.y), 0.5, 1e-9);
    const Vec3 first = s.force(*parts[0]);
    const double angle = std::atan2(first.x * target.y - first.y * target.x, first.x * target.x + first.y * target.y);
    EXPECT_NEAR(std::abs(std::remainder(angle - kPi / 2 * static_cast<double>(i), 2 * kPi)), 0, 1e-9) << i;
  }
}

TEST(MocapAttraction, DoesNothingWithoutItsJoint) {
  Dancer s({0, 0, 0}, {0, 0, 1});
  Part& part = s.single_ball({1, 0, 0});
  Behavior& b = s.add(part.body(), "mocap_attraction");
  for (const auto& [property, value] : {std::pair("joint", 3.0), std::pair("source", 2.0)}) {
    s.set(b.id(), property, {value});
    s.step_behaviors();
    expect_near(s.force(part), {0, 0, 0}, 0);
  }
}

}  // namespace
}  // namespace limber::sim

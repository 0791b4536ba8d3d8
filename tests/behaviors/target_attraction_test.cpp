// target_attraction: F = r̂ · (min_amp + (max_amp − min_amp) · d/max_dist) for min_dist ≤ d ≤ max_dist.
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(TargetAttraction, GrowsFromMinAmpToMaxAmpWithDistance) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "target_attraction");
  s.set(b.id(), "target_pos", {4, 0, 3});
  s.set(b.id(), "min_amp", {2});
  s.set(b.id(), "max_amp", {12});
  s.step_behaviors();
  // d = 5 of 10: halfway
  expect_near(s.force(part), {7 * 0.8, 0, 7 * 0.6}, 1e-12);
}

TEST(TargetAttraction, DoesNotActOutsideItsDistances) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "target_attraction");
  s.set(b.id(), "min_dist", {1});
  s.set(b.id(), "max_dist", {2});
  for (const auto& [x, acts] : std::vector<std::pair<double, bool>>{
           {0.5, false}, {0.999, false}, {1, true}, {1.5, true}, {2, true}, {2.001, false}, {1e4, false}}) {
    s.set(b.id(), "target_pos", {x, 0, 0});
    s.clear(part);
    s.step_behaviors();
    EXPECT_EQ(s.force(part).x, acts ? 10 * x / 2 : 0) << x;
  }
}

TEST(TargetAttraction, MatchesTheFormulaInRandomCases) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "target_attraction");
  for (int i = 0; i < 50; i++) {
    const Vec3 at = s.draw3(-4, 4), target = s.draw3(-4, 4);
    const double far = s.draw(1, 8), low = s.draw(-5, 5), high = s.draw(-5, 5);
    part.set_pose({at, quat_identity()});
    s.set(b.id(), "target_pos", Rig::list(target));
    s.set(b.id(), "max_dist", {far});
    s.set(b.id(), "min_amp", {low});
    s.set(b.id(), "max_amp", {high});
    s.clear(part);
    s.step_behaviors();
    const Vec3 r = target - at;
    const double d = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z);
    const double amp = d > far ? 0 : low + (high - low) * d / far;
    expect_near(s.force(part), r * (amp / d), 1e-9);
  }
}

TEST(TargetAttraction, ActsOnTheCenterOfMass) {
  Rig s;
  model::ShapeModel two;
  two.kind = model::ShapeKind::compound;
  Shape& compound = s.shape(two);
  Shape& ball = s.shape(sphere_model(0.1));
  ASSERT_TRUE(compound.add_child(ball, {{0, 0, 1}, quat_identity()}).ok());
  Part& part = **s.body("b").add_part("p", compound, 1, Pose{});
  ASSERT_NEAR(part.center().z, 1, 1e-6);
  Behavior& b = s.add(part.body(), "target_attraction");
  s.set(b.id(), "target_pos", {0, 0, 3});
  s.step_behaviors();
  expect_near(s.force(part), {0, 0, 10 * 2.0 / 10}, 1e-6);
}

}  // namespace
}  // namespace limber::sim

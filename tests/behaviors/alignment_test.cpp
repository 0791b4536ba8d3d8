// alignment: s = clamp(1 − (|m| − min)/(max − min), 0, 1); F = amount · linear · s · (mean v_j − v); τ likewise with
// ω; both are limited to the value that reaches the mean within one tick.
#include "behaviors/flock_rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Alignment, AcceleratesTowardsTheNeighborsMotion) {
  Rig s;
  Part& one = s.add_single_part(sphere_model(0.5), 10);
  Part& two = s.add_single_part(sphere_model(0.5), 10, {{2, 0, 0}, quat_identity()});
  one.set_velocity({1, 0, 0}, {0, 0, 1});
  two.set_velocity({0, 3, 0}, {0, 2, 0});
  BehaviorGroup& group = s.add_group("alignment");
  s.set(group.id(), "max_dist", {8});
  s.set(group.id(), "linear_amount", {2});
  s.set(group.id(), "angular_amount", {4});
  s.set(group.id(), "amount", {0.5});
  s.step_behaviors();
  // s = 1 − 2/8
  expect_near(s.force(one), 0.75 * 0.5 * 2 * Vec3(-1, 3, 0), 1e-6);
  expect_near(s.torque(one), 0.75 * 0.5 * 4 * Vec3(0, 2, -1), 1e-6);
  expect_near(s.force(two), 0.75 * 0.5 * 2 * Vec3(1, -3, 0), 1e-6);
}

TEST(Alignment, EqualsBruteForce) {
  FlockRig s;
  s.fill(120, 3, 6);
  BehaviorGroup& group = s.add_group("alignment");
  // small enough that the limit isn't reached: the balls of 0.5 kg and 1 cm have 2e-5 kg·m²
  s.set(group.id(), "linear_amount", {3});
  s.set(group.id(), "angular_amount", {5e-4});
  for (const auto& [min_distance, max_distance] : std::vector<std::pair<double, double>>{
           {0, 0.3}, {0, 1}, {0, 2.5}, {0.5, 1.5}, {1, 1.2}, {0, 7}, {2, 9}, {0, 10.4}, {0, 1000}, {3, 1000}}) {
    s.set(group.id(), "min_dist", {min_distance});
    s.set(group.id(), "max_dist", {max_distance});
    for (Part* part : s.parts) s.clear(*part);
    s.step_behaviors();
    for (const Part* part : s.parts) {
      const BruteForceMeans m = s.brute_force_means(*part, min_distance, max_distance);
      const double scale = clamped(1 - (length_of(m.offset) - min_distance) / (max_distance - min_distance), 0, 1);
      const double active_scale = m.count == 0 ? 0 : scale;
      expect_near(s.force(*part), 3 * active_scale * (m.velocity - part->linear_velocity()), 1e-4,
                  std::to_string(max_distance));
      expect_near(s.torque(*part), 5e-4 * active_scale * (m.spin - part->angular_velocity()), 1e-8,
                  std::to_string(max_distance));
    }
  }
}

// With any amount, the part doesn't exceed its neighbors' motion in one tick.
TEST(Alignment, HugeAmountRemovesTheDifferenceWithoutOvershoot) {
  Rig s;
  Part& light = s.add_single_part(box_model({0.02, 0.3, 0.05}), 0.01, {{0, 0, 0}, quat_axis(unit({1, 2, 3}), 0.7)});
  Part& leader = s.add_single_part(sphere_model(0.1), 1e6, {{1, 0, 0}, quat_identity()});
  light.set_velocity({-3, 1, 0}, {20, -10, 5});
  leader.set_velocity({0, 2, 0}, {0, 0, 4});
  BehaviorGroup& group = s.add_group("alignment");
  s.set(group.id(), "linear_amount", {1e6});
  s.set(group.id(), "angular_amount", {1e6});
  s.set(group.id(), "amount", {1e6});
  const Vec3 velocity = light.linear_velocity();
  const Vec3 spin = light.angular_velocity();
  s.step_behaviors();
  const double dt = s.world.timestep();
  // F·dt = m·(V − v)
  expect_near(s.force(light) * dt / 0.01, Vec3(0, 2, 0) - velocity, 1e-5);
  // I⁻¹·τ·dt = Ω − ω, in the principal axes
  const Quat axes = light.principal_axes();
  const Vec3 turned = glm::conjugate(axes) * (s.torque(light) * dt) / box_inertia(0.01, {0.02, 0.3, 0.05});
  expect_near(axes * turned, Vec3(0, 0, 4) - spin, 1e-4);
}

TEST(Alignment, HugeAmountsKeepLightPartsStable) {
  FlockRig s;
  s.fill(100, 1, 3);
  BehaviorGroup& group = s.add_group("alignment");
  s.set(group.id(), "amount", {1e9});
  for (int i = 0; i < 60; i++) {
    s.ticks(1);
    for (const Part* part : s.parts) {
      EXPECT_LT(length_of(part->linear_velocity()), 3.5);
      EXPECT_LT(length_of(part->angular_velocity()), 5.3);
    }
  }
  EXPECT_EQ(s.world.stability().events(), 0U);
}

}  // namespace
}  // namespace limber::sim

// Ropes: light links stay together under a heavy load and swing as a pendulum.
#include "sim/stage.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::test {
namespace {

constexpr double kGravity = 9.81;
constexpr double kLink = 0.05;   // m
constexpr double kRadius = 0.2;  // of the weight, m
constexpr double kWeight = 100;  // kg

/// 100 links of 10 g with a weight of 100 kg, hanging from the origin.
class Rope : public WorldFixture {
 public:
  Rope() {
    gravity({0, 0, -kGravity});
    Body& rope = body("rope");
    Part* above = &part(rope, box_model({0.1, 0.1, 0.1}), 0);
    const model::ShapeModel link = round_model(model::ShapeKind::capsule, 0.01, kLink - 0.02);
    for (int i = 0; i < kLinks; i++) {
      Part& next = part(rope, link, 0.01, {{0, 0, -kLink * (i + 0.5)}, quat_identity()});
      join(rope, *above, next, -kLink * i);
      above = &next;
    }
    weight_ = &part(rope, sphere_model(kRadius), kWeight, {{0, 0, -length()}, quat_identity()});
    join(rope, *above, *weight_, -kLink * kLinks);
    set(rope.id(), "self_collision", {0});
  }

  static double length() { return kLink * kLinks + kRadius; }
  Part& weight() { return *weight_; }
  double gap() const { return widest_gap(*world.bodies().front()); }

 private:
  static constexpr int kLinks = 100;

  void join(Body& rope, Part& above, Part& next, double z) {
    ASSERT_TRUE(
        rope.add_joint("j" + next.name(), above, next, model::JointType::spherical, Vec3(0, 0, z), Vec3(0, 0, 1)));
  }

  Part* weight_ = nullptr;
};

// Its height at the turning point is v²/2g, its period that of a pendulum with this amplitude, to second order.
TEST(Rope, SwingsAHeavyWeight) {
  Rope rope;
  rope.ticks(60);
  EXPECT_LE(rope.gap(), 1e-4);
  constexpr double kSpeed = 3;
  rope.weight().apply_impulse({kSpeed * kWeight, 0, 0});
  const double height = kSpeed * kSpeed / (2 * kGravity);
  const double amplitude = std::acos(1 - height / Rope::length());
  const double period = 2 * kPi * std::sqrt(Rope::length() / kGravity) * (1 + amplitude * amplitude / 16);
  double gap = 0;
  double highest = 0;
  double crossed = 0;
  double x = 0;
  for (int tick = 1; crossed == 0 && tick < 400; tick++) {
    rope.ticks(1);
    gap = std::max(gap, rope.gap());
    const Vec3 at = rope.weight().pose().position;
    highest = std::max(highest, at.z + Rope::length());
    if (x < 0 && at.x >= 0) crossed = tick / 60.0;
    x = at.x;
  }
  EXPECT_LE(gap, 1e-4);
  EXPECT_NEAR(highest, height, 0.015 * height);
  EXPECT_NEAR(crossed, period, 0.01 * period);
  EXPECT_EQ(rope.world.stability().events(), 0u);
  EXPECT_EQ(rope.number(rope.world.id(), "solver_fallbacks"), 0);
}

}  // namespace
}  // namespace limber::sim::test

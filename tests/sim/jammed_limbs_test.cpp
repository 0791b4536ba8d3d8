// Limbs of one body that strong servos press against each other: on a static base each is a tree of its own.
#include "sim/stage.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::test {
namespace {

/// Legs of two links hang from a base, in a circle; their servos push them across each other.
class Legs : public WorldFixture {
 public:
  Legs(int count, double base_mass) : robot_(body("legs")) {
    gravity({0, 0, -9.81});
    Part& base = part(robot_, box_model({0.5, 0.5, 0.1}), base_mass, {{0, 0, 1}, quat_identity()});
    const model::ShapeModel link = box_model({0.06, 0.06, 0.2});
    for (int i = 0; i < count; i++) {
      const double angle = 2 * kPi * i / count;
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      const Vec3 axis(-out.y, out.x, 0);
      Part* above = &base;
      for (int k = 0; k < 2; k++) {
        const Vec3 hip = out * 0.2 + Vec3(0, 0, 0.94 - 0.21 * k);
        Part& next = part(robot_, link, 0.5, {hip - Vec3(0, 0, 0.1), quat_identity()});
        Joint& joint =
            *robot_.add_joint("j" + next.name(), *above, next, model::JointType::revolute, hip, axis).value();
        Motor& motor = *robot_.add_motor(joint).value();
        set(motor.id(), "max_angular_force", {200, 200, 200});
        set(motor.id(), "target", {k == 0 ? kHip : -0.3});
        above = &next;
      }
    }
  }

  double gap() const { return widest_gap(robot_); }
  /// Largest angle of a hip, whose servo target is kHip, rad.
  double widest_hip() const {
    double max_angle = 0;
    for (std::size_t i = 0; i < robot_.joints().size(); i += 2) {
      max_angle = std::max(max_angle, robot_.joints()[i]->constraint().value(5));
    }
    return max_angle;
  }

 private:
  static constexpr double kHip = 0.9;

  Body& robot_;
};

class JammedLimbs : public ::testing::TestWithParam<int> {};

TEST_P(JammedLimbs, KeepTheirJointsClosed) {
  for (const double base_mass : {0.0, 5.0}) {
    Legs legs(GetParam(), base_mass);
    double gap = 0;
    for (int tick = 0; tick < 120; tick++) {
      legs.ticks(1);
      gap = std::max(gap, legs.gap());
    }
    EXPECT_LE(gap, 1e-3) << "base of " << base_mass << " kg";
    EXPECT_LT(legs.widest_hip(), 0.8) << "the limbs did not block each other";
    EXPECT_EQ(legs.number(legs.world.id(), "islands_iterative"), 0);
    EXPECT_EQ(legs.number(legs.world.id(), "solver_fallbacks"), 0);
    EXPECT_EQ(legs.world.stability().events(), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, JammedLimbs, ::testing::Values(2, 4, 6));

}  // namespace
}  // namespace limber::sim::test

// Contacts never create energy: parts of one body that overlap and are pressed against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stage.h"

namespace limber::sim::test {
namespace {

// Kinetic energy of a part, J.
double kinetic(const Part& part) {
  if (part.is_static()) return 0;
  const Vec3 v = part.linear_velocity();
  const Vec3 w = glm::conjugate(part.principal_axes()) * part.angular_velocity();
  return 0.5 * part.mass() * (glm::dot(v, v) + glm::dot(part.geometry()->unit_inertia * w, w));
}

// A hub with two boxes on hinges beside each other, which overlap by `depth` and are held by servos; without gravity.
struct Siblings : WorldFixture {
  Siblings(double depth, double torque, bool fixed, unsigned seed) : random(seed), robot(body("robot")) {
    set(world.id(), "timestep", {1.0 / 240});
    substeps(1);
    Part& hub = part(robot, box_model({0.2, 0.2, 0.2}), fixed ? 0 : 1);
    const Vec3 size(0.2, 0.05, 0.05);
    for (const double side : {1.0, -1.0}) {
      const double y = side * (size.y - depth) / 2;
      Part& arm = part(robot, box_model(size), 0.1 * std::exp(uniform(-2, 2)), {Vec3(0.25, y, uniform(-0.02, 0.02))});
      const Vec3 axis = uniform(0, 1) < 0.5 ? Vec3(0, 0, side) : normalized(Vec3(uniform(-1, 1), 0, side));
      Joint& joint =
          *robot.add_joint(side > 0 ? "l" : "r", hub, arm, model::JointType::revolute, Vec3(0.15, y, 0), axis).value();
      Motor& motor = *robot.add_motor(joint).value();
      set(motor.id(), "max_angular_force", {torque, torque, torque});
    }
    EXPECT_TRUE(robot.pairs().edit(*robot.parts()[1], *robot.parts()[2], PairEdit::included));
    if (!fixed) {
      const Vec3 spin(uniform(-3, 3), uniform(-3, 3), uniform(-3, 3));
      for (const auto& p : robot.parts()) {
        set(p->id(), "linear_velocity", OneAxisFixture::as_list(glm::cross(spin, p->center())));
        set(p->id(), "angular_velocity", OneAxisFixture::as_list(spin));
      }
    }
  }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
  double energy() const {
    double sum = 0;
    for (const auto& p : robot.parts()) sum += kinetic(*p);
    return sum;
  }
  // Work of the motors in the last step, J.
  double work(const std::vector<double>& rates_before) const {
    double sum = 0;
    for (std::size_t i = 0; i < robot.joints().size(); i++) {
      const bullet::JointConstraint& c = robot.joints()[i]->constraint();
      sum += c.drives().applied_torque().z * h() * (rates_before[i] + c.rate(5)) / 2;
    }
    return sum;
  }

  std::mt19937 random;
  Body& robot;
};

// A part that is rotated without its velocity changes its energy: a fifth is allowed for that.
TEST(OverlapEnergy, OverlappingSiblingsGainNoEnergy) {
  unsigned seed = 1;
  for (const double depth : {1e-4, 5e-4, 2e-3, 1e-2, 0.025}) {
    for (const double torque : {0.01, 1.0, 100.0, 1e4}) {
      for (const bool fixed : {false, true}) {
        Siblings s(depth, torque, fixed, seed++);
        s.ticks(1);
        double allowed = s.energy();
        for (int tick = 0; tick < 120; tick++) {
          std::vector<double> rates;
          for (const auto& joint : s.robot.joints()) rates.push_back(joint->constraint().rate(5));
          s.ticks(1);
          allowed += std::max(s.work(rates), 0.0);
          EXPECT_LE(s.energy(), 1.2 * allowed + 1e-3)
              << "depth " << depth << ", torque " << torque << (fixed ? ", fixed" : ", floating") << ", step " << tick;
          if (s.energy() > 1.2 * allowed + 1e-3) break;
        }
        EXPECT_EQ(s.world.stability().events(), 0u);
      }
    }
  }
}

}  // namespace
}  // namespace limber::sim::test

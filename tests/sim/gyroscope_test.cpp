// Torque-free bodies rotate by Euler's equations, including light ones.
#include "sim/solver/gyroscope.h"

#include <cmath>

#include <gtest/gtest.h>

#include "stage.h"

namespace limber::sim::test {
namespace {

// Euler's equations in small steps of the fourth-order Runge-Kutta method
Vec3 euler_equations(const Vec3& inertia, Vec3 spin, double seconds) {
  constexpr double kStep = 1e-4;
  const auto rate = [&](const Vec3& w) { return -glm::cross(w, inertia * w) / inertia; };
  for (double t = 0; t < seconds - kStep / 2; t += kStep) {
    const Vec3 a = rate(spin);
    const Vec3 b = rate(spin + a * (kStep / 2));
    const Vec3 c = rate(spin + b * (kStep / 2));
    const Vec3 d = rate(spin + c * kStep);
    spin += (a + 2.0 * b + 2.0 * c + d) * (kStep / 6);
  }
  return spin;
}

TEST(Gyroscope, FollowsEulersEquations) {
  const Vec3 size(0.1, 0.2, 0.05);
  for (const double mass : {0.01, 1.0, 300.0}) {
    const Vec3 inertia = box_inertia(mass, size);
    Vec3 spin(2, 6, 1);
    const Vec3 exact = euler_equations(inertia, spin, 1);
    for (int i = 0; i < 1000; i++) spin += solver::gyroscopic_change(inertia, spin, 1e-3);
    EXPECT_LT(glm::length(spin - exact), 1e-4 * glm::length(exact)) << mass;
  }
}

TEST(Gyroscope, ConservesEnergyAndMomentumAtAnyStep) {
  for (const double h : {1.0 / 240, 1.0 / 30, 1.0, 100.0}) {
    for (const Vec3& inertia : {Vec3(1, 2, 2.5), Vec3(1e-6, 2e-6, 2.9e-6), Vec3(1e-3, 1, 1)}) {
      for (const Vec3& start : {Vec3(3, 0.1, 0), Vec3(0.01, 4, 0.01), Vec3(-50, 20, 70)}) {
        Vec3 spin = start;
        for (int i = 0; i < 200; i++) {
          spin += solver::gyroscopic_change(inertia, spin, h);
          ASSERT_LE(glm::dot(inertia * spin, spin), glm::dot(inertia * start, start) * (1 + 1e-12));
        }
        if (h > 0.01 || glm::length(start) > 10) continue;
        EXPECT_NEAR(glm::dot(inertia * spin, spin) / glm::dot(inertia * start, start), 1, 1e-9);
        EXPECT_NEAR(glm::length(inertia * spin) / glm::length(inertia * start), 1, 1e-9);
      }
    }
  }
}

TEST(Gyroscope, RotationAboutAPrincipalAxisIsSteady) {
  EXPECT_EQ(solver::gyroscopic_change({1, 2, 3}, {5, 0, 0}, 0.1), Vec3(0));
  EXPECT_EQ(solver::gyroscopic_change({2, 2, 2}, {5, 1, 3}, 0.1), Vec3(0));
  EXPECT_EQ(solver::gyroscopic_change({1, 2, 3}, Vec3(0), 0.1), Vec3(0));
}

// A light box thrown about its middle axis turns over repeatedly, at the times given by the equations.
TEST(Gyroscope, ThrownBoxTurnsOver) {
  const Vec3 size(0.1, 0.2, 0.05);
  const double mass = 0.2;
  WorldFixture s;
  s.gravity(Vec3(0));
  Part& part = s.add_single_part(box_model(size), mass, {{0, 0, 1}, quat_identity()});
  const Vec3 inertia = box_inertia(mass, size);
  const Vec3 start(8, 0.2, 0.1);  // y has the smallest moment, z the largest
  s.set(part.id(), "linear_damping", {0});
  s.set(part.id(), "angular_damping", {0});
  s.set(part.id(), "angular_velocity", {start.x, start.y, start.z});
  bool turned_over = false;
  for (int tick = 1; tick <= 120; tick++) {
    s.ticks(1);
    const Vec3 spin = glm::inverse(part.pose().rotation) * part.angular_velocity();
    turned_over = turned_over || spin.x < -6;
    if (tick % 20 != 0) continue;
    const Vec3 exact = euler_equations(inertia, start, tick / 60.0);
    EXPECT_LT(glm::length(spin - exact), 0.05 * glm::length(exact)) << tick;
  }
  EXPECT_TRUE(turned_over);
}

}  // namespace
}  // namespace limber::sim::test

// random_force: d = min_dir + U⊙(max_dir − min_dir), a = min_amp + U·(max_amp − min_amp), F = a·d̂, for each part.
#include <cmath>

#include "base/random.h"
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

// The expected draws according to the generator's definition: seeded with seed and path; x, y, z, then the amplitude.
Vec3 draw_force(Random& random, const Vec3& low, const Vec3& high, double least, double most) {
  const double u = random.uniform();
  const double v = random.uniform();
  const double w = random.uniform();
  const Vec3 d = low + Vec3(u, v, w) * (high - low);
  const double a = least + random.uniform() * (most - least);
  return d / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) * a;
}

TEST(RandomForce, DrawsPerPartFromSeedAndPath) {
  Rig s;
  s.set(s.world.id(), "seed", {42});
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  Part& two = s.ball(body, {1, 0, 0});
  Behavior& b = **s.world.behaviors().add(body, "random_force", "wind");
  s.set(b.id(), "min_dir", {-1, 0, 2});
  s.set(b.id(), "max_dir", {3, 1, 2});
  s.set(b.id(), "min_amp", {5});
  s.set(b.id(), "max_amp", {-5});  // the bounds may be in either order
  s.step_behaviors();
  Random random(42, "/physics/body/b/behavior/wind");
  expect_near(s.force(one), draw_force(random, {-1, 0, 2}, {3, 1, 2}, 5, -5), 1e-12);
  expect_near(s.force(two), draw_force(random, {-1, 0, 2}, {3, 1, 2}, 5, -5), 1e-12);
}

TEST(RandomForce, DrawsAtTheFirstActiveTickAndAfterEachInterval) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "random_force");
  s.set(b.id(), "rand_interval", {100});  // six ticks
  s.set(b.id(), "active", {0});
  s.ticks(3);
  EXPECT_EQ(glm::length(part.linear_velocity()), 0);
  s.set(b.id(), "active", {1});
  std::vector<Vec3> forces;
  for (int i = 0; i < 13; i++) {
    const Vec3 before = part.linear_velocity();
    s.ticks(1);
    forces.push_back(part.linear_velocity() - before);
  }
  for (int i = 1; i < 13; i++) {
    const bool redrawn = i % 6 == 0;
    EXPECT_EQ(glm::length(forces[i] - forces[i - 1]) > 1e-4, redrawn) << "tick " << i;
  }
}

TEST(RandomForce, ZeroDirectionAppliesNoForce) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "random_force");
  s.set(b.id(), "min_dir", {0, 0, 0});
  s.set(b.id(), "max_dir", {0, 0, 0});
  s.step_behaviors();
  expect_near(s.force(part), {0, 0, 0}, 0);
}

// The mean of |F| over many draws: amplitudes are uniform in 0 .. 10.
TEST(RandomForce, AmplitudesAreUniform) {
  Rig s;
  Part& part = s.single_ball({0, 0, 0});
  Behavior& b = s.add(part.body(), "random_force");
  s.set(b.id(), "rand_interval", {0});
  double sum = 0;
  double max_amplitude = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; i++) {
    s.clear(part);
    s.step_behaviors();
    const double force = glm::length(s.force(part));
    sum += force;
    max_amplitude = std::max(max_amplitude, force);
  }
  // standard error of the mean: 10/sqrt(12)/sqrt(4000) = 0.046
  EXPECT_NEAR(sum / kDraws, 5, 0.2);
  EXPECT_LE(max_amplitude, 10);
  EXPECT_GT(max_amplitude, 9.9);
}

}  // namespace
}  // namespace limber::sim

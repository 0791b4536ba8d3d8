// random_torque: t = min_torque + U⊙(max_torque − min_torque) for each part, τ = scale·t; scale takes effect at once.
#include "base/random.h"
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(RandomTorque, DrawsPerPartAndScalesAtOnce) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  Part& two = s.ball(body, {1, 0, 0});
  Behavior& b = **s.world.behaviors().add(body, "random_torque", "twist");
  s.set(b.id(), "min_torque", {0, 1, -2});
  s.set(b.id(), "max_torque", {1, 3, -5});
  s.step_behaviors();
  Random random(1, "/physics/body/b/behavior/twist");
  const auto draw_torque = [&] {
    const double u = random.uniform();
    const double v = random.uniform();
    return Vec3(u, 1 + 2 * v, -2 - 3 * random.uniform());
  };
  std::vector<Vec3> expected = {draw_torque()};
  expected.push_back(draw_torque());
  expect_near(s.torque(one), expected[0], 1e-12);
  expect_near(s.torque(two), expected[1], 1e-12);
  s.set(b.id(), "scale", {-3});
  for (Part* part : {&one, &two}) s.clear(*part);
  s.step_behaviors();
  expect_near(s.torque(one), -3.0 * expected[0], 1e-12);
  expect_near(s.force(one), {0, 0, 0}, 0);
  // also for a torque that is drawn while the new scale is in force
  s.set(b.id(), "rand_interval", {0});
  for (Part* part : {&one, &two}) s.clear(*part);
  s.step_behaviors();
  expect_near(s.torque(one), -3.0 * draw_torque(), 1e-12);
}

}  // namespace
}  // namespace limber::sim

// random_torque: t = min_torque + U⊙(max_torque − min_torque) drawn for each part, τ = scale·t, scale acting at once.
#include "base/random.h"
#include "behaviors/rig.h"

namespace limber {
namespace {

using namespace test;

TEST(RandomTorque, DrawsForEachPartAndScalesAtOnce) {
  Rig s;
  Body& body = s.body("b");
  Part& one = s.ball(body, {0, 0, 0});
  Part& two = s.ball(body, {1, 0, 0});
  Behavior& b = **s.world.behaviors().add(body, "random_torque", "twist");
  s.set(b.id(), "min_torque", {0, 1, -2});
  s.set(b.id(), "max_torque", {1, 3, -5});
  s.act();
  Random random(1, "/physics/body/b/behavior/twist");
  const auto drawn = [&] {
    const double u = random.uniform();
    const double v = random.uniform();
    return Vec3(u, 1 + 2 * v, -2 - 3 * random.uniform());
  };
  std::vector<Vec3> wanted = {drawn()};
  wanted.push_back(drawn());
  expect_near(s.torque(one), wanted[0], 1e-12);
  expect_near(s.torque(two), wanted[1], 1e-12);
  s.set(b.id(), "scale", {-3});
  for (Part* part : {&one, &two}) s.clear(*part);
  s.act();
  expect_near(s.torque(one), -3.0 * wanted[0], 1e-12);
  expect_near(s.force(one), {0, 0, 0}, 0);
  // once, too, for what is drawn while it is in force
  s.set(b.id(), "rand_interval", {0});
  for (Part* part : {&one, &two}) s.clear(*part);
  s.act();
  expect_near(s.torque(one), -3.0 * drawn(), 1e-12);
}

}  // namespace
}  // namespace limber

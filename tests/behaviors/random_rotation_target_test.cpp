// random_rotation_target: like rotation_target, towards min_target + U⊙(max_target − min_target), for each motor.
#include <array>

#include "base/random.h"
#include "behaviors/rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(RandomRotationTarget, MovesEachMotorTowardsItsRandomTarget) {
  WorldFixture s;
  Body& body = s.body("b");
  Part* below = &s.part(body, sphere_model(0.1), 0);
  std::vector<Motor*> motors;
  for (int i = 0; i < 2; i++) {
    Part& above = s.part(body, sphere_model(0.1), 1, {{1.0 + i, 0, 0}, quat_identity()});
    Joint& joint = **body.add_joint("joint" + std::to_string(i), *below, above, model::JointType::revolute,
                                    above.pose().position, Vec3(0, 0, 1));
    motors.push_back(*body.add_motor(joint));
    below = &above;
  }
  Behavior& b = **s.world.behaviors().add(body, "random_rotation_target", "sway");
  s.set(b.id(), "min_target", {-1, -1, -1});
  s.set(b.id(), "max_target", {1, 1, 2});
  s.set(b.id(), "speed", {100});
  s.set(b.id(), "rand_interval", {50});
  const auto step_and_read_servos = [&] {
    s.world.behaviors().step(1.0 / 60);
    return std::array{s.vec(motors[0]->id(), "angular_servo_position").z,
                      s.vec(motors[1]->id(), "angular_servo_position").z};
  };
  Random random(1, "/physics/body/b/behavior/sway");
  const auto draw_target = [&] {
    random.uniform();
    random.uniform();
    return -1 + 3 * random.uniform();
  };
  const std::array first = {draw_target(), draw_target()};
  const auto set = step_and_read_servos();
  EXPECT_NEAR(set[0], first[0], 1e-9);
  EXPECT_NEAR(set[1], first[1], 1e-9);
  // 50 ms are three ticks
  s.ticks(2);
  EXPECT_NEAR(step_and_read_servos()[0], first[0], 1e-6);
  s.ticks(2);
  const std::array second = {draw_target(), draw_target()};
  EXPECT_NEAR(step_and_read_servos()[0], second[0], 1e-6);
  EXPECT_NEAR(step_and_read_servos()[1], second[1], 1e-6);
}

}  // namespace
}  // namespace limber::sim

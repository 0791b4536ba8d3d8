// random_rotation_target: as rotation_target, towards min_target + U⊙(max_target − min_target), drawn for each motor.
#include <array>

#include "base/random.h"
#include "behaviors/rig.h"

namespace limber {
namespace {

using namespace test;

TEST(RandomRotationTarget, DrawsForEachMotorAndLeadsItThere) {
  Stage s;
  Body& body = s.body("b");
  Part* below = &s.part(body, sphere_model(0.1), 0);
  std::vector<Motor*> motors;
  for (int i = 0; i < 2; i++) {
    Part& above = s.part(body, sphere_model(0.1), 1, {{1.0 + i, 0, 0}, quat_identity()});
    Joint& joint = **body.add_joint("joint" + std::to_string(i), *below, above, JointType::revolute,
                                    above.pose().position, Vec3(0, 0, 1));
    motors.push_back(*body.add_motor(joint));
    below = &above;
  }
  Behavior& b = **s.world.behaviors().add(body, "random_rotation_target", "sway");
  s.set(b.id(), "min_target", {-1, -1, -1});
  s.set(b.id(), "max_target", {1, 1, 2});
  s.set(b.id(), "speed", {100});
  s.set(b.id(), "rand_interval", {50});
  const auto servos = [&] {
    s.world.behaviors().step(1.0 / 60);
    return std::array{s.vec(motors[0]->id(), "angular_servo_position").z,
                      s.vec(motors[1]->id(), "angular_servo_position").z};
  };
  Random random(1, "/physics/body/b/behavior/sway");
  const auto drawn = [&] {
    random.uniform();
    random.uniform();
    return -1 + 3 * random.uniform();
  };
  const std::array first = {drawn(), drawn()};
  const auto set = servos();
  EXPECT_NEAR(set[0], first[0], 1e-9);
  EXPECT_NEAR(set[1], first[1], 1e-9);
  // 50 ms are three ticks
  s.ticks(2);
  EXPECT_NEAR(servos()[0], first[0], 1e-6);
  s.ticks(2);
  const std::array second = {drawn(), drawn()};
  EXPECT_NEAR(servos()[0], second[0], 1e-6);
  EXPECT_NEAR(servos()[1], second[1], 1e-6);
}

}  // namespace
}  // namespace limber

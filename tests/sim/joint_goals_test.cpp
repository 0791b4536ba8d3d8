// Targets that change from tick to tick: speed of the joint in each substep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/log/log.h"
#include "joint_rig.h"
#include "stage.h"

namespace limber::sim {
namespace {

constexpr double kGoalTick = 1.0 / 60;
constexpr double kGoalMass = 2;
constexpr double kGoalInertia = 0.5;

// One part attached to the ground with one free axis; records the axis's speed after each substep.
struct Follower : Rig {
  Follower(int axis, const bullet::AxisSettings& settings, bool direct = true) : axis(axis), settings(settings) {
    world.set_direct(direct);
    hinge.set_axis(axis, settings);
    world.setInternalTickCallback(&Follower::record_speed, this, false);
  }
  static void record_speed(btDynamicsWorld* world, btScalar) {
    Follower& f = *static_cast<Follower*>(world->getWorldUserInfo());
    f.hinge.refresh();
    f.speeds.push_back(f.hinge.rate(f.axis));
  }
  // One tick towards this target (of a servo) and rest position (of a spring); records the speeds of this tick only.
  void tick(double target, int substeps = 4, double length = kGoalTick) {
    speeds.clear();
    hinge.set_target(axis, target, target, static_cast<double>(settings.velocity));
    world.step(length / substeps, substeps);
  }
  void expect_speed(double speed, double part) const {
    for (const double v : speeds) EXPECT_NEAR(v, speed, part * std::fabs(speed));
  }
  double x() const { return hinge.value(axis); }

  int axis;
  bullet::AxisSettings settings;
  btRigidBody& child = part(kGoalMass, Vec3(kGoalInertia));
  bullet::JointConstraint& hinge = joint(ground(), child);
  std::vector<double> speeds;
};

TEST(JointGoals, RampMovesTheJointAtItsSpeedInEveryStep) {
  const double speed = 0.5;
  for (const bool direct : {true, false}) {
    for (int axis = 0; axis < 6; ++axis) {
      for (const double limit : {0.0, speed, 1.0, 10.0}) {
        for (const double sign : {1.0, -1.0}) {
          SCOPED_TRACE(testing::Message() << direct << ' ' << axis << ' ' << limit << ' ' << sign);
          Follower f(axis, servo_axis(free_axis(), 0, limit, 10000), direct);
          f.tick(0);
          for (int i = 1; i <= 30; ++i) {
            f.tick(sign * speed * i * kGoalTick);
            f.expect_speed(sign * speed, 0.02);
            EXPECT_NEAR(f.x(), sign * speed * i * kGoalTick, 1e-4);
          }
        }
      }
    }
  }
}

TEST(JointGoals, WeakMotorFollowsARamp) {
  for (const double limit : {0.0, 2.0}) {
    Follower f(5, servo_axis(free_axis(), 0, limit, 5));
    f.tick(0);
    for (int i = 1; i <= 120; ++i) {
      f.tick(0.5 * i * kGoalTick);
      if (i > 30) f.expect_speed(0.5, 0.02);
    }
    EXPECT_NEAR(f.x(), 1, 1e-3);
  }
}

TEST(JointGoals, RampIsSteadyWhenTheStepChanges) {
  Follower f(5, servo_axis(free_axis(), 0, 0, 10000));
  double time = 0;
  f.tick(0);
  for (int i = 0; i < 40; ++i) {
    const double tick = i < 20 ? kGoalTick : kGoalTick / 3;
    time += tick;
    f.tick(0.5 * time, i % 20 < 10 ? 4 : 7, tick);
    f.expect_speed(0.5, 0.02);
  }
}

TEST(JointGoals, RampIsSteadyAfterThousandsOfTurns) {
  // single precision would be too coarse for a slow ramp there
  const double start = 2000 * kPi;
  Follower f(5, servo_axis(free_axis(), start, 0, 10000));
  f.hinge.reset(Vec3(0, 0, start));
  f.tick(start);
  for (int i = 1; i <= 30; ++i) {
    f.tick(start + 0.5 * i * kGoalTick);
    f.expect_speed(0.5, 0.02);
  }
}

TEST(JointGoals, JumpIsDelayedByATickAtMost) {
  for (const bool direct : {true, false}) {
    Follower quick(5, servo_axis(free_axis(), 0, 0, 10000), direct);
    quick.tick(0);
    quick.tick(0.2);
    EXPECT_NEAR(quick.x(), 0.2, 1e-2);
    quick.tick(0.2);
    EXPECT_NEAR(quick.x(), 0.2, 2e-3);
    // as fast as possible from the first substep on
    Follower limited(5, servo_axis(free_axis(), 0, 1, 10000), direct);
    limited.tick(0);
    for (int i = 0; i < 30; ++i) {
      limited.tick(0.6);
      limited.expect_speed(1, 0.001);
    }
  }
}

TEST(JointGoals, JumpDoesNotOvershootWithAWeakMotor) {
  for (const double force : {0.5, 5.0, 50.0, 500.0}) {
    for (const double limit : {0.0, 5.0}) {
      Follower f(5, servo_axis(free_axis(), 0, limit, force));
      f.tick(0);
      double farthest = 0;
      for (int i = 0; i < 600; ++i) {
        f.tick(1);
        farthest = std::max(farthest, f.x());
      }
      EXPECT_NEAR(f.x(), 1, 2e-3) << force;
      EXPECT_LT(farthest, 1.002) << force;
    }
  }
}

TEST(JointGoals, EndOfARampStopsTheJoint) {
  Follower f(5, servo_axis(free_axis(), 0, 0, 10000));
  for (int i = 0; i <= 30; ++i) f.tick(i * kGoalTick);
  for (int i = 0; i < 10; ++i) {
    f.tick(30 * kGoalTick);
    EXPECT_NEAR(f.x(), 0.5, 1e-4);
  }
}

TEST(JointGoals, SpringFollowsARamp) {
  for (int axis : {0, 5}) {
    // critically damped, 4 rad/s: at constant speed it lags by a constant distance
    const double inertia = axis < 3 ? kGoalMass : kGoalInertia;
    Follower f(axis, spring_axis(free_axis(), 0, 16 * inertia, 8 * inertia));
    f.tick(0);
    for (int i = 1; i <= 300; ++i) {
      f.tick(0.5 * i * kGoalTick);
      if (i > 240) f.expect_speed(0.5, 0.001);
    }
  }
}

TEST(JointGoals, StiffSpringFollowsARampWithoutRipple) {
  // 25 rad/s: without interpolation the ripple of a ramp at 60 ticks a second is 10 %
  Follower f(5, spring_axis(free_axis(), 0, 625 * kGoalInertia, 50 * kGoalInertia));
  f.tick(0);
  for (int i = 1; i <= 120; ++i) {
    f.tick(0.5 * i * kGoalTick);
    if (i > 60) f.expect_speed(0.5, 0.005);
  }
}

TEST(JointGoals, EnablingAServoAtItsTargetDoesNotMoveTheJoint) {
  Follower f(5, servo_axis(free_axis(), 0, 0, 10000));
  f.tick(0);
  bullet::AxisSettings off = f.settings;
  off.drive = bullet::AxisDrive::off;
  f.hinge.set_axis(5, off);
  set_axis_rate(f.child, 5, 2);
  for (int i = 0; i < 60; ++i) f.tick(0);
  f.child.setAngularVelocity(btVector3(0, 0, 0));
  const double position = f.x();
  ASSERT_GT(position, 1);
  f.hinge.set_axis(5, servo_axis(free_axis(), position, 0, 10000));
  f.tick(position);
  for (const double v : f.speeds) EXPECT_NEAR(v, 0, 1e-4);
  // the same after the part was teleported
  f.child.setWorldTransform(btTransform::getIdentity());
  f.hinge.reset();
  f.tick(0);
  for (const double v : f.speeds) EXPECT_NEAR(v, 0, 1e-4);
}

TEST(JointGoals, ContinuousServoCountsTurns) {
  Follower f(5, servo_axis(free_axis(), 0, 10, 10000));
  const int ticks = static_cast<int>(60 * (2 * kPi + 0.2));
  for (int i = 0; i < ticks; ++i) f.tick(20 * kPi);
  EXPECT_NEAR(f.x(), 20 * kPi, 1e-3);
  for (int i = 0; i < 2 * ticks; ++i) f.tick(-20 * kPi);
  EXPECT_NEAR(f.x(), -20 * kPi, 1e-3);
}

// Numbers between -1 and 1 that are the same on every machine.
struct Jitter {
  std::uint32_t state;
  double next() {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / 8388608.0 - 1;
  }
};

// Each tick uses the newest target of a ramp that is sent `frequency` times a second and arrives up to 5 ms early or
// late.
std::vector<double> streamed_targets(double frequency, double speed, int ticks, std::uint32_t seed) {
  Jitter jitter{seed};
  std::vector<double> targets;
  double newest = 0;
  int sent = 0;
  double arrives = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    while (arrives <= tick * kGoalTick) {
      newest = speed * sent / frequency;
      arrives = ++sent / frequency + 0.005 * jitter.next();
    }
    targets.push_back(newest);
  }
  return targets;
}

TEST(JointGoals, SmoothingLimitsTheRippleOfAStream) {
  for (const double frequency : {25.0, 30.0, 50.0, 100.0}) {
    for (const double limit : {0.0, 10.0}) {
      for (const std::uint32_t seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(testing::Message() << frequency << ' ' << limit << ' ' << seed);
        Follower f(5, servo_axis(free_axis(), 0, limit, 10000));
        f.hinge.target_interpolator().set_smoothing(2 / frequency);
        const std::vector<double> targets = streamed_targets(frequency, 0.5, 360, seed);
        double farthest = 0;
        for (std::size_t i = 0; i < targets.size(); ++i) {
          f.tick(targets[i]);
          if (i < 120) continue;
          for (const double v : f.speeds) farthest = std::max(farthest, std::fabs(v / 0.5 - 1));
        }
        EXPECT_LT(farthest, 0.1);
      }
    }
  }
}

TEST(JointGoals, SmoothingDelaysARampAsDocumented) {
  for (const double time : {0.02, 0.1, 1.0}) {
    Follower f(5, servo_axis(free_axis(), 0, 0, 10000));
    f.hinge.target_interpolator().set_smoothing(time);
    double target = 0;
    for (int i = 0; i < 1200; ++i) f.tick(target = 0.5 * i * kGoalTick);
    f.expect_speed(0.5, 0.001);
    EXPECT_NEAR((target - f.x()) / 0.5, 1.5 * time + 3 * kGoalTick, 0.2 * kGoalTick);
  }
}

TEST(JointGoals, SmoothingDoesNotOvershoot) {
  Follower f(5, servo_axis(free_axis(), 0, 0, 10000));
  f.hinge.target_interpolator().set_smoothing(0.1);
  f.tick(0);
  double farthest = 0;
  for (int i = 0; i < 120; ++i) {
    f.tick(1);
    farthest = std::max(farthest, f.x());
  }
  EXPECT_NEAR(f.x(), 1, 1e-4);
  EXPECT_LT(farthest, 1 + 1e-4);
}

TEST(JointGoals, MotorPressesAgainstItsLimitWithItsForce) {
  for (const bool direct : {true, false}) {
    for (int axis = 0; axis < 6; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        for (const double force : {10.0, 10000.0}) {
          SCOPED_TRACE(testing::Message() << direct << ' ' << axis << ' ' << sign << ' ' << force);
          const bullet::AxisSettings limits = limited_axis(-0.3, 0.3);
          for (const bullet::AxisSettings& s :
               {spin_axis(limits, sign * 5, force), servo_axis(limits, sign * 2, 0, force)}) {
            Follower f(axis, s, direct);
            double farthest = 0;
            for (int i = 0; i < 120; ++i) {
              f.tick(s.target);
              farthest = std::max(farthest, sign * f.x());
            }
            const Vec3 applied = axis < 3 ? f.hinge.drives().applied_force() : f.hinge.drives().applied_torque();
            EXPECT_NEAR(applied[axis % 3], sign * force, 1e-4 * force);
            EXPECT_NEAR(sign * f.x(), 0.3, 1e-4);
            EXPECT_LT(farthest, 0.3 + 1e-4);
            EXPECT_NEAR(f.speeds.back(), 0, 1e-3);
          }
        }
      }
    }
  }
}

TEST(JointGoals, ServoWithTargetAtItsLimitAppliesItsLoadOnly) {
  Follower f(5, servo_axis(limited_axis(-0.3, 0.3), 0.3, 2, 1000));
  for (int i = 0; i < 120; ++i) f.tick(static_cast<double>(f.settings.upper));
  EXPECT_NEAR(f.hinge.drives().applied_torque().z, 0, 0.05);
  EXPECT_FALSE(f.hinge.drives().target_outside());
}

TEST(JointGoals, MotorDeflectsACompliantLimit) {
  for (const bool direct : {true, false}) {
    bullet::AxisSettings limits = limited_axis(-0.3, 0.3);
    limits.stop_cfm = 0.01f;
    for (const bullet::AxisSettings& s : {spin_axis(limits, 5, 10), servo_axis(limits, 2, 0, 10)}) {
      Follower f(5, s, direct);
      for (int i = 0; i < 240; ++i) f.tick(s.target);
      EXPECT_NEAR(f.x(), 0.4, 2e-3);
      EXPECT_NEAR(f.hinge.drives().applied_torque().z, 10, 0.05);
    }
  }
}

// A platform on a prismatic joint, with the target x = v·t in each tick, carries a box.
TEST(JointGoals, BoxTravelsWithItsPlatform) {
  for (const double limit : {0.0, 0.5, 1.0, 10.0}) {
    test::WorldFixture s;
    s.gravity({0, 0, -9.81});
    Body& rig = s.body("rig");
    Part& rail = s.part(rig, test::box_model({0.1, 0.1, 0.1}), 0, {{0, 0, 0.3}, quat_identity()});
    Part& platform = s.part(rig, test::box_model({4, 1, 0.2}), 20, {{0, 0, 1}, quat_identity()});
    Part& box = s.add_single_part(test::box_model({0.2, 0.2, 0.2}), 1, {{0, 0, 1.2}, quat_identity()});
    for (const Part* p : {&platform, &box}) s.set(p->id(), "friction", {0.8});
    Joint& joint =
        *rig.add_joint("j", rail, platform, model::JointType::prismatic, Vec3(0, 0, 1), Vec3(1, 0, 0)).value();
    Motor& motor = *rig.add_motor(joint).value();
    s.set(motor.id(), "speed", {limit});
    s.ticks(30);
    for (int i = 1; i <= 180; ++i) {
      motor.set_target(0.5 * std::min(i * kGoalTick, 2.0));
      s.ticks(1);
    }
    EXPECT_NEAR(joint.value(), 1, 1e-3) << limit;
    EXPECT_NEAR(box.pose().position.x, 1, 0.01) << limit;
  }
}

// A body without contacts whose smoothed target takes 10 s sleeps only when it has arrived.
TEST(JointGoals, JointSleepsOnceItsSmoothedTargetIsReached) {
  test::WorldFixture s;
  Body& robot = s.body("robot");
  Part& base = s.part(robot, test::sphere_model(0.05), 0);
  Part& child = s.part(robot, test::box_model({0.2, 0.3, 0.4}), 1);
  Joint& joint = *robot.add_joint("elbow", base, child, model::JointType::revolute, Vec3(0), Vec3(0, 0, 1)).value();
  Motor& motor = *robot.add_motor(joint).value();
  s.set(motor.id(), "target_smoothing", {2});
  motor.set_target(0.02);
  s.ticks(30 * 60);
  EXPECT_NEAR(joint.value(), 0.02, 1e-5);
}

int goal_warnings(const std::string& text, std::uint64_t since) {
  const std::vector<LogLine> lines = log_since(since);
  return static_cast<int>(std::count_if(lines.begin(), lines.end(),
                                        [&](const LogLine& l) { return l.text.find(text) != std::string::npos; }));
}

TEST(JointGoals, ReportsATargetOutsideTheLimitsOnce) {
  test::WorldFixture s;
  Body& robot = s.body("robot");
  Part& base = s.part(robot, test::sphere_model(0.05), 0);
  Part& child = s.part(robot, test::box_model({0.2, 0.3, 0.4}), 1);
  Joint& joint = *robot.add_joint("elbow", base, child, model::JointType::revolute, Vec3(0), Vec3(0, 0, 1)).value();
  s.set_one(joint.id(), "angular_lower_limit", 2, -1.57);
  s.set_one(joint.id(), "angular_upper_limit", 2, 1.57);
  Motor& motor = *robot.add_motor(joint).value();
  const std::uint64_t before = log_newest();
  motor.set_target(1.57);
  s.ticks(30);
  EXPECT_EQ(goal_warnings("outside the limits", before), 0);
  for (const double target : {90.0, -90.0}) {
    motor.set_target(target);
    s.ticks(30);
  }
  const char* const text = "motor 'robot/elbow': target 90 rad is outside the limits -1.57..1.57; angles are radians";
  EXPECT_EQ(goal_warnings(text, before), 1);
  EXPECT_EQ(goal_warnings("outside the limits", before), 1);
}

}  // namespace
}  // namespace limber::sim

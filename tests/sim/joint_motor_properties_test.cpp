// Effects of motors, servos and springs on a joint's axis, each compared with a formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "joint_rig.h"

namespace limber::sim {
namespace {

constexpr double kMass = 2;
constexpr double kInertia = 0.5;

double inertia_of(int axis) { return axis < 3 ? kMass : kInertia; }

// One part attached to the ground with one free axis.
struct Drive : Rig {
  Drive(int axis, const bullet::AxisSettings& settings) : axis(axis) { hinge.set_axis(axis, settings); }
  double x() const { return hinge.value(axis); }
  double v() const { return hinge.rate(axis); }
  double applied() const {
    const Vec3 all = axis < 3 ? hinge.drives().applied_force() : hinge.drives().applied_torque();
    return all[axis % 3];
  }
  void push(double load) {
    if (axis < 3) {
      child.applyCentralForce(bullet::to_bt(unit(axis) * load));
    } else {
      child.applyTorque(bullet::to_bt(unit(axis) * load));
    }
  }
  int axis;
  btRigidBody& child = part(kMass, Vec3(kInertia));
  bullet::JointConstraint& hinge = joint(ground(), child);
};

TEST(JointMotorRows, SpinAcceleratesByForceOverInertia) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Drive d(axis, spin_axis(free_axis(), sign * 2, 1.5));
      d.steps(60);
      EXPECT_NEAR(d.v(), sign * std::min(2.0, 1.5 / inertia_of(axis) * 0.25), 1e-4) << axis;
      EXPECT_NEAR(d.applied(), sign * 1.5, 1e-4) << axis;
      d.steps(1200);
      EXPECT_NEAR(d.v(), sign * 2, 1e-5) << axis;
      d.steps(4);
      EXPECT_NEAR(d.applied(), 0, 1e-3) << axis;
    }
  }
}

TEST(JointMotorRows, SpinOfSpeedZeroBrakes) {
  for (int axis = 0; axis < 6; ++axis) {
    Drive d(axis, spin_axis(free_axis(), 0, 0.8));
    set_axis_rate(d.child, axis, 2);
    d.steps(30);
    EXPECT_NEAR(d.v(), 2 - 0.8 / inertia_of(axis) * 30 * kRigStep, 1e-4) << axis;
    d.steps(2400);
    EXPECT_NEAR(d.v(), 0, 1e-5) << axis;
  }
}

TEST(JointMotorRows, SpinStopsAtTheLimit) {
  for (const double force : {0.5, 10.0, 10000.0}) {
    Drive d(5, spin_axis(limited_axis(-1, 4), 3, force));
    double farthest = 0;
    for (int i = 0; i < 1200; ++i) {
      d.steps(1);
      farthest = std::max(farthest, d.x());
    }
    EXPECT_NEAR(d.x(), 4, 1e-4) << force;
    EXPECT_LT(farthest, 4.0005) << force;
    d.steps(60);
    EXPECT_NEAR(d.applied(), force, 1e-4 * force);
  }
}

TEST(JointMotorRows, LockedAxisIgnoresItsMotor) {
  Drive d(5, spin_axis(limited_axis(0, 0), 3, 1000));
  d.steps(100);
  EXPECT_NEAR(d.x(), 0, 1e-6);
}

TEST(JointMotorRows, ServoMovesAtItsSpeedAndStays) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const double target : {0.9, -0.7}) {
      for (const double speed : {1.0, -1.0}) {  // the sign of the speed is ignored
        Drive d(axis, servo_axis(limited_axis(-1.5, 1.5), target, speed, 10000));
        int arrived = 0;
        for (int i = 1; i <= 480; ++i) {
          d.steps(1);
          EXPECT_LT(std::fabs(d.v()), 1 + 1e-4);
          EXPECT_LT(d.x() * (target > 0 ? 1 : -1), std::fabs(target) + 1e-5);
          if (!arrived && std::fabs(d.x() - target) < 1e-3) arrived = i;
        }
        EXPECT_NEAR(arrived, std::fabs(target) * 240, 3) << axis;
        EXPECT_NEAR(d.x(), target, 1e-5) << axis;
      }
    }
  }
}

TEST(JointMotorRows, ServoHoldsALoadUpToItsForce) {
  for (int axis = 0; axis < 6; ++axis) {
    Drive d(axis, servo_axis(free_axis(), 0, 1, 5));
    for (int i = 0; i < 240; ++i) {
      d.push(4.9);
      d.steps(1);
    }
    EXPECT_NEAR(d.x(), 0, 1e-4) << axis;
    EXPECT_NEAR(d.applied(), -4.9, 1e-3) << axis;
    for (int i = 0; i < 24; ++i) {
      d.push(6);
      d.steps(1);
    }
    EXPECT_NEAR(d.v(), 1 / inertia_of(axis) * 0.1, 2e-3) << axis;
    EXPECT_NEAR(d.applied(), -5, 1e-3) << axis;
  }
}

TEST(JointMotorRows, ServoWithoutSpeedLimitDoesNotOvershoot) {
  for (int axis : {0, 5}) {
    for (const double force : {0.05, 0.5, 5.0, 50.0, 10000.0}) {
      Drive d(axis, servo_axis(limited_axis(-2, 2), 1, 0, force));
      double farthest = 0;
      // the time-optimal motion at full force takes 2·sqrt(J·1/F) s
      const double fastest = 2 * std::sqrt(inertia_of(axis) / force);
      const int steps = static_cast<int>((2 * fastest + 0.5) * 240);
      for (int i = 0; i < steps; ++i) {
        d.steps(1);
        farthest = std::max(farthest, d.x());
      }
      EXPECT_NEAR(d.x(), 1, 2e-3) << axis << ' ' << force;
      EXPECT_LT(farthest, 1.002) << axis << ' ' << force;
    }
  }
}

TEST(JointMotorRows, ServoEstimatesItsInertia) {
  // a light first part carries a heavy one on a locked joint: the servo must estimate the inertia that it moves
  for (const double force : {1.0, 10.0, 100.0}) {
    Rig rig;
    btRigidBody& first = rig.part(0.5, Vec3(0.005));
    btRigidBody& load = rig.part(1, Vec3(0.05), {{1, 0, 0}, quat_identity()});
    bullet::JointConstraint& servo = rig.joint(rig.ground(), first);
    rig.joint(first, load, {{0.5, 0, 0}, quat_identity()}, {{-0.5, 0, 0}, quat_identity()});
    servo.set_axis(5, servo_axis(limited_axis(-3, 3), 1, 0, force));
    double farthest = 0;
    for (int i = 0; i < 4800; ++i) {
      rig.steps(1);
      farthest = std::max(farthest, servo.value(5));
    }
    EXPECT_NEAR(servo.value(5), 1, 2e-3) << force;
    EXPECT_LT(farthest, 1.04) << force;
  }
}

TEST(JointMotorRows, LimitedServoTakesTheAllowedDirection) {
  Drive d(5, servo_axis(limited_axis(-3, 3), -2.9, 4, 1000));
  d.steps(480);
  ASSERT_NEAR(d.x(), -2.9, 1e-4);
  d.hinge.set_axis(5, servo_axis(limited_axis(-3, 3), 2.9, 4, 1000));
  d.steps(120);  // half a second on the long way: 2 rad
  EXPECT_NEAR(d.x(), -0.9, 0.03);
  d.steps(480);
  EXPECT_NEAR(d.x(), 2.9, 1e-4);
}

TEST(JointMotorRows, FreeServoCountsFullTurns) {
  Drive d(5, servo_axis(free_axis(), 2.9, 4, 1000));
  d.steps(480);
  d.hinge.set_axis(5, servo_axis(free_axis(), -2.9, 4, 1000));
  d.steps(480);
  d.steps(60);
  EXPECT_NEAR(d.x(), -2.9, 1e-4);
}

TEST(JointMotorRows, ServoReachesTargetsBeyondAHalfTurn) {
  for (int axis = 3; axis < 6; ++axis) {
    Drive d(axis, servo_axis(limited_axis(-8, 8), 7, 5, 1000));
    d.steps(480);
    EXPECT_NEAR(d.x(), 7, 1e-4) << axis;
    d.hinge.set_axis(axis, servo_axis(limited_axis(-8, 8), -100, 5, 1000));
    d.steps(960);
    EXPECT_NEAR(d.x(), -8, 1e-4) << axis;
    d.steps(4);
    EXPECT_NEAR(d.applied(), -1000, 0.1) << axis;  // it presses against the limit
  }
}

TEST(JointMotorRows, SpringOscillatesWithItsPeriod) {
  // T = 2 pi sqrt(J/k) = 0.5 s, measured over ten periods
  for (int axis = 0; axis < 6; ++axis) {
    const double j = inertia_of(axis);
    const double k = j * std::pow(2 * kPi / 0.5, 2);
    Drive d(axis, spring_axis(free_axis(), 0.1, k));
    int crossings = 0;
    double first = 0;
    double last = 0;
    double before = d.x();
    for (int i = 1; crossings < 21 && i < 5000; ++i) {
      d.steps(1);
      if ((before - 0.1) * (d.x() - 0.1) <= 0) {
        const double time = (i - 1 + (0.1 - before) / (d.x() - before)) * kRigStep;
        (crossings == 0 ? first : last) = time;
        ++crossings;
      }
      before = d.x();
    }
    EXPECT_NEAR((last - first) / 10 / 0.5, 1, 0.005) << axis;
    EXPECT_NEAR(d.hinge.drives().stiffness_applied(axis) / k, 1, 1e-6) << axis;
  }
}

TEST(JointMotorRows, HingeSpringOscillatesWithItsPeriod) {
  // a rod's end on a hinge: J = 0.5 + 2·0.3²; the pivot is not the center of mass
  Rig rig;
  btRigidBody& child = rig.part(kMass, Vec3(kInertia), {{0.3, 0, 0}, quat_identity()});
  bullet::JointConstraint& hinge = rig.joint(rig.ground(), child, {}, {{-0.3, 0, 0}, quat_identity()});
  const double j = kInertia + kMass * 0.09;
  const double k = j * std::pow(2 * kPi, 2);  // 1 s
  hinge.set_axis(5, spring_axis(free_axis(), 0.3, k));
  rig.steps(120);
  EXPECT_NEAR(hinge.value(5), 0.6, 0.002);
  rig.steps(120);
  EXPECT_NEAR(hinge.value(5), 0, 0.002);
}

TEST(JointMotorRows, SpringDeflectsByLoadOverStiffness) {
  for (int axis = 0; axis < 6; ++axis) {
    Drive d(axis, spring_axis(free_axis(), 0.2, 50, 8));
    for (int i = 0; i < 1200; ++i) {
      d.push(3);
      d.steps(1);
    }
    EXPECT_NEAR(d.x() - 0.2, 3.0 / 50, 0.01 * 3 / 50) << axis;
    EXPECT_NEAR(d.applied(), -3, 1e-2) << axis;
    EXPECT_EQ(d.hinge.axis(axis).damping_applied(), 8) << axis;
  }
}

TEST(JointMotorRows, SpringDampingIsImplicit) {
  for (const double damping : {0.5, 40.0, 1e6}) {
    Drive d(5, spring_axis(free_axis(), 0, 0, damping));
    set_axis_rate(d.child, 5, 2);
    d.steps(10);
    EXPECT_NEAR(d.v(), 2 * std::pow(1 + damping * kRigStep / kInertia, -10), 2e-5);
  }
}

TEST(JointMotorRows, LimitsAndReportsTooStiffASpring) {
  for (int axis = 0; axis < 6; ++axis) {
    Drive d(axis, spring_axis(free_axis(), 0.1, 1e9));
    d.steps(1);
    const double cap = inertia_of(axis) / (16 * kRigStep * kRigStep);
    EXPECT_NEAR(d.hinge.drives().stiffness_applied(axis) / cap, 1, 1e-4) << axis;
    double farthest = 0;
    for (int i = 0; i < 2400; ++i) {
      d.steps(1);
      farthest = std::max(farthest, std::fabs(d.x()));
    }
    EXPECT_NEAR(farthest, 0.2, 0.01) << axis;  // it oscillates about 0.1 and conserves its energy
  }
}

TEST(JointMotorRows, SpringCountsFullTurns) {
  Drive d(5, spring_axis(free_axis(), 9, 20, 6));
  d.steps(1200);
  EXPECT_NEAR(d.x(), 9, 1e-3);
}

TEST(JointMotorRows, PendulumSwingsWithItsPeriod) {
  // T = 2 pi sqrt(J/(m g r)) (1 + a²/16), a = 0.4
  Rig rig;
  rig.world.setGravity(btVector3(0, 0, -9.81f));
  const double r = 0.5;
  const double a = 0.4;
  const Pose frame{{0, 0, 0}, quat_axis({1, 0, 0}, -kPi / 2)};  // hinge axis along y
  const Pose start{{-r * std::sin(a), 0, -r * std::cos(a)}, quat_axis({0, 1, 0}, a)};
  btRigidBody& bob = rig.part(1, Vec3(0.02), start);
  bullet::JointConstraint& hinge = rig.joint(rig.ground(), bob, frame, Pose{{0, 0, r}, quat_identity()} * frame);
  hinge.set_axis(5, free_axis());
  const double period = 2 * kPi * std::sqrt((0.02 + r * r) / (9.81 * r)) * (1 + a * a / 16);
  EXPECT_NEAR(hinge.value(5), a, 1e-5);
  int crossings = 0;
  double first = 0;
  double last = 0;
  double before = a;
  for (int i = 1; crossings < 11 && i < 5000; ++i) {
    rig.steps(1);
    const double now = hinge.value(5);
    if (before * now <= 0) {
      (crossings == 0 ? first : last) = (i - 1 + before / (before - now)) * kRigStep;
      ++crossings;
    }
    before = now;
  }
  EXPECT_NEAR((last - first) / 5 / period, 1, 1e-3);
}

TEST(JointMotorRows, OneJointConvergesInOneIteration) {
  // the motor and the five locks are one block: more iterations change nothing, saturated or not
  for (const double force : {0.5, 1000.0}) {
    Vec3 place[2];
    for (int many = 0; many < 2; ++many) {
      Rig rig;
      rig.world.setGravity(btVector3(1, 2, -9.81f));
      rig.world.getSolverInfo().m_numIterations = many ? 300 : 1;
      btRigidBody& base = rig.part(3, {0.3, 0.2, 0.1});
      btRigidBody& child = rig.part(1, {0.02, 0.05, 0.03}, {{0.4, 0.3, 0.2}, quat_identity()});
      bullet::JointConstraint& hinge = rig.joint(base, child, {{0.2, 0.1, 0}, quat_euler(0.3, 0.2, 0.1)},
                                                 {{-0.2, -0.2, -0.2}, quat_euler(0.3, 0.2, 0.1)});
      hinge.set_axis(5, spin_axis(free_axis(), 3, force));
      base.setAngularVelocity(btVector3(1, -2, 0.5f));
      rig.steps(30);
      place[many] = bullet::from_bt(child.getCenterOfMassPosition());
    }
    EXPECT_LT(glm::length(place[0] - place[1]), 5e-6) << force;
  }
}

TEST(JointMotorRows, MirroredRobotMovesMirrored) {
  // mirrored in the plane x z: y and rotations about x and z change sign
  Rig rig;
  rig.world.setGravity(btVector3(0, 0, -9.81f));
  bullet::JointConstraint* hinges[2][4];
  btRigidBody* tips[2];
  for (int side = 0; side < 2; ++side) {
    const double m = side ? -1 : 1;
    btRigidBody* parent = &rig.part(0, Vec3(0), {{0, m * 2, 0}, quat_identity()});
    for (int i = 0; i < 4; ++i) {
      btRigidBody& child = rig.part(1, {0.02, 0.03, 0.01}, {{0, m * (2 + 0.3 * (i + 1)), 0}, quat_identity()});
      // axes x, z, y, x: a mirrored axis along y reverses its rotation, one along x or z doesn't
      const Quat axis = i == 1   ? quat_identity()
                        : i == 2 ? quat_axis({1, 0, 0}, -kPi / 2)
                                 : quat_axis({0, 1, 0}, kPi / 2);
      bullet::JointConstraint& hinge =
          rig.joint(*parent, child, {{0, m * (i ? 0.15 : 0.15), 0}, axis}, {{0, -m * 0.15, 0}, axis});
      const double sense = i == 2 ? 1 : m;
      hinge.set_axis(5, servo_axis(limited_axis(-1, 1), sense * (0.2 + 0.2 * i), 1, 20));
      hinges[side][i] = &hinge;
      parent = &child;
    }
    tips[side] = parent;
  }
  for (int i = 0; i < 100; ++i) {
    rig.steps(4);
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(hinges[0][k]->value(5), hinges[1][k]->value(5) * (k == 2 ? 1 : -1), 2e-5) << i << ' ' << k;
    }
    const Vec3 a = bullet::from_bt(tips[0]->getCenterOfMassPosition());
    const Vec3 b = bullet::from_bt(tips[1]->getCenterOfMassPosition());
    EXPECT_LT(glm::length(a - Vec3(b.x, -b.y, b.z)), 2e-5) << i;
  }
}

TEST(JointMotorRows, NoFiniteInputMakesNaN) {
  const float numbers[] = {0, 1e-30f, 1, -1, 3.5f, 1e6f, -1e6f, 1e30f, -1e30f, 3e38f, -3e38f};
  std::uint32_t state = 12345;
  const auto draw = [&] {
    state = state * 1664525u + 1013904223u;
    return numbers[(state >> 16) % std::size(numbers)];
  };
  for (int round = 0; round < 300; ++round) {
    Rig rig;
    btRigidBody& a = rig.part(1, Vec3(0.1));
    btRigidBody& b = rig.part(0.5, Vec3(0.05), {{0.3, 0, 0}, quat_identity()});
    bullet::JointConstraint& joint = rig.joint(a, b, {{0.15, 0, 0}, quat_identity()}, {{-0.15, 0, 0}, quat_identity()});
    for (int axis = 0; axis < 6; ++axis) {
      bullet::AxisSettings s;
      s.lower = draw();
      s.upper = draw();
      s.stop_erp = std::clamp(draw(), 0.0f, 1.0f);
      s.stop_cfm = std::fabs(draw());
      s.drive = static_cast<bullet::AxisDrive>((state >> 20) % 4);
      s.velocity = draw();
      s.max_force = std::fabs(draw());
      s.target = draw();
      s.rest = draw();
      s.stiffness = std::fabs(draw());
      s.spring_damping = std::fabs(draw());
      s.friction = std::fabs(draw());
      joint.set_axis(axis, s);
    }
    joint.set_bounce(static_cast<double>(std::clamp(draw(), 0.0f, 1.0f)));
    joint.set_damping(static_cast<double>(std::fabs(draw())));
    for (int i = 0; i < 6; ++i) rig.steps(1);
    for (int axis = 0; axis < 6; ++axis) {
      EXPECT_FALSE(std::isnan(joint.value(axis))) << round << ' ' << axis;
      EXPECT_FALSE(std::isnan(joint.rate(axis))) << round << ' ' << axis;
    }
  }
}

}  // namespace
}  // namespace limber::sim

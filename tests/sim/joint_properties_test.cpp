// Effects of a joint's properties, each compared with a formula: limits, locks, damping, friction.
#include <gtest/gtest.h>

#include <cmath>

#include "joint_rig.h"

#include "support/skip.h"

namespace limber::sim {
namespace {

// A part of 2 kg and 0.5 kg·m² about every axis, attached to the ground with one free axis.
struct Slider : Rig {
  explicit Slider(int axis, bullet::AxisSettings settings = free_axis()) : axis(axis) {
    hinge.set_axis(axis, settings);
  }
  double inertia() const { return axis < 3 ? 2.0 : 0.5; }
  double x() const { return hinge.value(axis); }
  double v() const { return hinge.rate(axis); }
  // Applies a force or torque along the axis during the next tick.
  void push(double load) {
    if (axis < 3) {
      child.applyCentralForce(bullet::to_bt(unit(axis) * load));
    } else {
      child.applyTorque(bullet::to_bt(unit(axis) * load));
    }
  }
  int axis;
  btRigidBody& child = part(2, Vec3(0.5));
  bullet::JointConstraint& hinge = joint(ground(), child);
};

TEST(JointRows, FreeAxisKeepsItsSpeed) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const double rate : {1.5, -1.5}) {
      Slider s(axis);
      set_axis_rate(s.child, axis, rate);
      s.steps(240);
      for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(s.hinge.value(i), i == axis ? rate : 0, 2e-5) << axis << i;
        EXPECT_NEAR(s.hinge.rate(i), i == axis ? rate : 0, 2e-5) << axis << i;
      }
    }
  }
}

TEST(JointRows, LimitStopsEachAxisOnEachSide) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Slider s(axis, limited_axis(-0.3, 0.4));
      set_axis_rate(s.child, axis, sign * 2);
      s.steps(240);
      EXPECT_NEAR(s.x(), sign > 0 ? 0.4 : -0.3, 1e-4) << axis;
      EXPECT_NEAR(s.v(), 0, 1e-4) << axis;
    }
  }
}

TEST(JointRows, LimitsHoldBeyondFullTurns) {
  struct Case {
    double lower, upper;
  };
  for (const Case c : {Case{-4, 4}, Case{-1, 5}, Case{-7.5, 6.5}, Case{-20, 30}, Case{-kPi, kPi}}) {
    for (int axis = 3; axis < 6; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        Slider s(axis, limited_axis(c.lower, c.upper));
        for (int i = 0; i < 960; ++i) {
          s.push(sign * 2);
          s.steps(1);
        }
        EXPECT_NEAR(s.x(), sign > 0 ? c.upper : c.lower, 2e-4) << axis;
      }
    }
  }
}

TEST(JointRows, LimitFarFromZeroHolds) {
  Slider s(5, limited_axis(2.5, 4.5));
  s.child.setWorldTransform(bullet::to_bt(Pose{Vec3(0), quat_axis({0, 0, 1}, 3.5)}));
  s.hinge.reset({0, 0, 3.5});
  set_axis_rate(s.child, 5, 3);
  s.steps(240);
  EXPECT_NEAR(s.x(), 4.5, 1e-4);
  set_axis_rate(s.child, 5, -3);
  s.steps(240);
  EXPECT_NEAR(s.x(), 2.5, 1e-4);
}

TEST(JointRows, LimitBouncesByItsFactor) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      for (const double bounce : {0.0, 0.25, 0.5, 1.0}) {
        Slider s(axis, limited_axis(-0.5, 0.5));
        s.hinge.set_bounce(bounce);
        set_axis_rate(s.child, axis, 2 * sign);
        s.steps(90);  // 0.5 / 2 s = 60 steps to the limit
        EXPECT_NEAR(s.v(), -sign * bounce * 2, 1e-4) << axis;
      }
    }
  }
}

TEST(JointRows, PressedLimitDoesNotBounce) {
  Slider s(5, limited_axis(-0.1, 0.1));
  s.hinge.set_bounce(0.9);
  double fastest = 0;
  for (int i = 0; i < 1200; ++i) {
    s.push(3);
    s.steps(1);
    if (i > 900) fastest = std::max(fastest, std::fabs(s.v()));
  }
  EXPECT_LT(fastest, 0.05);
  EXPECT_NEAR(s.x(), 0.1, 1e-3);
}

TEST(JointRows, StopErpRepairsItsPartOfTheErrorPerStep) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const float erp : {0.1f, 0.2f, 0.8f}) {
      // a limit, started 0.01 beyond it; and a lock, started 0.01 off
      for (bullet::AxisSettings settings : {limited_axis(0.01, 1), limited_axis(0.01, 0.01)}) {
        settings.stop_erp = erp;
        Slider s(axis, settings);
        double expected = 0.01;
        for (int i = 0; i < 3; ++i) {
          s.steps(1);
          expected *= 1 - static_cast<double>(erp);
          EXPECT_NEAR(0.01 - s.x(), expected, 1e-6) << axis << erp;
        }
      }
    }
  }
}

TEST(JointRows, RepairSpeedIsLimited) {
  // 0.2·1 m / (1/240 s) would be 48 m/s
  Slider limited(0, limited_axis(1, 2));
  limited.steps(1);
  EXPECT_NEAR(limited.v(), 2, 1e-3);
  Slider locked(0, limited_axis(1, 1));
  locked.steps(1);
  EXPECT_NEAR(locked.v(), 20, 1e-3);
}

TEST(JointRows, StopCfmIsTheComplianceOfLimitsAndLocks) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  for (int axis = 0; axis < 6; ++axis) {
    for (const double cfm : {1e-4, 0.02, 1.0}) {
      for (const float erp : {0.2f, 0.9f}) {
        for (bullet::AxisSettings settings : {limited_axis(-1, 0), limited_axis(0, 0)}) {
          settings.stop_erp = erp;
          settings.stop_cfm = static_cast<float>(cfm);
          Slider s(axis, settings);
          s.child.setDamping(0.8f, 0.8f);  // makes the softest come to rest
          const double load = 0.3 / std::max(cfm, 0.1);
          for (int i = 0; i < 1200; ++i) {
            s.push(load);
            s.steps(4);
          }
          EXPECT_NEAR(s.x() / (cfm * load), 1, 0.01) << axis << ' ' << cfm << ' ' << erp;
        }
      }
    }
  }
}

TEST(JointRows, PassiveDampingIsImplicit) {
  // v(n+1) = v(n) / (1 + d h / J)
  for (int axis = 0; axis < 6; ++axis) {
    for (const bullet::AxisSettings& settings : {free_axis(), limited_axis(-100, 100)}) {
      for (const double damping : {0.1, 3.0, 500.0}) {
        Slider s(axis, settings);
        s.hinge.set_damping(damping);
        set_axis_rate(s.child, axis, 2);
        s.steps(20);
        const double expected = 2 * std::pow(1 + damping * kRigStep / s.inertia(), -20);
        EXPECT_NEAR(s.v(), expected, 2e-5) << axis << ' ' << damping;
      }
    }
  }
}

TEST(JointRows, PassiveDampingActsWithEveryDrive) {
  const double damping = 2;
  for (int axis = 0; axis < 6; ++axis) {
    for (const bullet::AxisSettings& settings :
         {spin_axis(free_axis(), 3, 0), servo_axis(free_axis(), 1, 1, 0), spring_axis(free_axis(), 0, 0)}) {
      Slider s(axis, settings);
      s.hinge.set_damping(damping);
      set_axis_rate(s.child, axis, 2);
      s.steps(20);
      EXPECT_NEAR(s.v(), 2 * std::pow(1 + damping * kRigStep / s.inertia(), -20), 2e-5) << axis;
    }
  }
}

TEST(JointRows, AnyDampingIsStableInAChain) {
  for (const double damping : {1.0, 1e4, 1e9, 1e30}) {
    Rig rig;
    btRigidBody* parent = &rig.ground();
    for (int i = 0; i < 6; ++i) {
      btRigidBody& child = rig.part(i == 3 ? 0.05 : 1, Vec3(i == 3 ? 1e-4 : 0.02), {{0.2 * i, 0, 0}, quat_identity()});
      bullet::JointConstraint& hinge =
          rig.joint(*parent, child, {{i == 0 ? -0.1 : 0.1, 0, 0}, quat_identity()}, {{-0.1, 0, 0}, quat_identity()});
      hinge.set_axis(5, free_axis());
      hinge.set_damping(damping);
      child.setAngularVelocity(btVector3(0, 0, i % 2 ? 3.0f : -3.0f));
      parent = &child;
    }
    rig.steps(480);
    for (auto& joint : rig.joints) EXPECT_LT(std::fabs(joint->rate(5)), 3) << damping;
  }
}

TEST(JointRows, CoulombFrictionDeceleratesByItsTorque) {
  for (int axis = 0; axis < 6; ++axis) {
    bullet::AxisSettings settings = free_axis();
    settings.friction = 0.4f;
    Slider s(axis, settings);
    set_axis_rate(s.child, axis, 2);
    s.steps(60);
    EXPECT_NEAR(s.v(), 2 - 0.4 / s.inertia() * 0.25, 1e-4) << axis;
    // finally it sticks, even against a load below the limit
    s.steps(2400);
    EXPECT_NEAR(s.v(), 0, 1e-5) << axis;
    s.push(0.39);
    s.steps(60);
    EXPECT_NEAR(s.v(), 0, 1e-5) << axis;
    s.push(0.6);
    s.steps(60);
    EXPECT_NEAR(s.v(), 0.2 / s.inertia() * 0.25, 1e-4) << axis;
  }
}

TEST(JointRows, DistantLimitHasNoRow) {
  Slider far(5, limited_axis(-2, 2));
  Slider near(5, limited_axis(-2, 0.04));
  btTypedConstraint::btConstraintInfo1 info{};
  far.hinge.getInfo1(&info);
  EXPECT_EQ(info.m_numConstraintRows, 5);
  near.hinge.getInfo1(&info);
  EXPECT_EQ(info.m_numConstraintRows, 6);
  Slider loose(5);
  for (int i = 0; i < 6; ++i) loose.hinge.set_axis(i, free_axis());
  loose.hinge.getInfo1(&info);
  EXPECT_EQ(info.m_numConstraintRows, 0);
}

TEST(JointRows, ConservesMomentumOfAFreePair) {
  // the rows of a slider and a hinge act at one point of both parts: linear and angular momentum are conserved
  for (int axis = 0; axis < 6; ++axis) {
    Rig rig;
    btRigidBody& a = rig.part(3, Vec3(0.2), {{-0.4, 0.1, 0}, quat_identity()});
    btRigidBody& b = rig.part(1, Vec3(0.1), {{0.4, -0.1, 0.2}, quat_identity()});
    bullet::JointConstraint& joint =
        rig.joint(a, b, {{0.4, 0, 0}, quat_identity()}, {{-0.4, 0.2, -0.2}, quat_identity()});
    joint.set_axis(axis, servo_axis(limited_axis(-0.8, 0.9), 0.7, 1, 50));
    a.setLinearVelocity(btVector3(0.2f, -0.1f, 0.3f));
    b.setAngularVelocity(btVector3(0.5f, 0.4f, -0.3f));
    const auto momentum = [&] {
      return 3.0 * bullet::from_bt(a.getLinearVelocity()) + 1.0 * bullet::from_bt(b.getLinearVelocity());
    };
    const auto spin = [&] {
      const Vec3 ca = bullet::from_bt(a.getCenterOfMassPosition());
      const Vec3 cb = bullet::from_bt(b.getCenterOfMassPosition());
      return glm::cross(ca, 3.0 * bullet::from_bt(a.getLinearVelocity())) +
             glm::cross(cb, bullet::from_bt(b.getLinearVelocity())) + 0.2 * bullet::from_bt(a.getAngularVelocity()) +
             0.1 * bullet::from_bt(b.getAngularVelocity());
    };
    const Vec3 p = momentum();
    const Vec3 l = spin();
    rig.steps(240);
    EXPECT_LT(glm::length(momentum() - p), 2e-5) << axis;
    EXPECT_LT(glm::length(spin() - l), 1e-4) << axis;
    EXPECT_NEAR(joint.value(axis), 0.7, 2e-3) << axis;
  }
}

TEST(JointRows, PlanarJointMovesInItsPlaneOnly) {
  Rig rig;
  btRigidBody& child = rig.part(1, Vec3(0.3));
  bullet::JointConstraint& planar = rig.joint(rig.ground(), child);
  planar.set_axis(0, free_axis());
  planar.set_axis(1, free_axis());
  planar.set_axis(5, free_axis());
  child.setLinearVelocity(btVector3(0.5f, -0.3f, 2.0f));
  child.setAngularVelocity(btVector3(1, 1, 1));
  rig.steps(240);
  EXPECT_NEAR(planar.value(0), 0.5, 1e-4);
  EXPECT_NEAR(planar.value(1), -0.3, 1e-4);
  EXPECT_NEAR(planar.value(2), 0, 1e-4);
  EXPECT_NEAR(planar.value(3), 0, 1e-4);
  EXPECT_NEAR(planar.value(4), 0, 1e-4);
  EXPECT_NEAR(planar.value(5), 1, 1e-4);
}

}  // namespace
}  // namespace limber::sim

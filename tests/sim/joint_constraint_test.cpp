// Geometry of joints compared with explicit rotations: orders, signs, turns, rates, inertia.
#include "sim/bullet/joints/joint_constraint.h"

#include <gtest/gtest.h>

#include "joint_rig.h"

namespace limber::sim {
namespace {

const Pose kOblique{{0.1, -0.2, 0.3}, quat_euler(0.4, -0.7, 1.1)};
const Pose kChildFrame{{-0.3, 0.1, 0.2}, quat_euler(-1.2, 0.5, 0.3)};
const Pose kParent{{1, 2, 3}, quat_euler(0.3, 0.2, -0.9)};

// Moves the child so that the joint's frames differ by `motion`.
void place(btRigidBody& parent, btRigidBody& child, const Pose& motion) {
  const Pose pose = bullet::from_bt(parent.getWorldTransform()) * kOblique * motion * kChildFrame.inverse();
  child.setWorldTransform(bullet::to_bt(pose));
}

Quat rotation_about(int axis, double angle) { return quat_axis(unit(axis), angle); }

struct Pair : Rig {
  btRigidBody& parent = part(2, Vec3(0.5), kParent);
  btRigidBody& child = part(1, Vec3(0.2, 0.3, 0.4));
  bullet::JointConstraint& hinge = joint(parent, child, kOblique, kChildFrame);
};

TEST(JointConstraint, MiddleAxisIsALockedOne) {
  struct Case {
    bool x, y, z;
    std::array<int, 3> order;
  };
  const Case cases[] = {{false, false, true, {2, 1, 0}}, {true, false, false, {2, 1, 0}},
                        {true, false, true, {2, 1, 0}},  {true, true, true, {2, 1, 0}},
                        {false, true, false, {2, 0, 1}}, {false, true, true, {2, 0, 1}},
                        {true, true, false, {1, 2, 0}},  {false, false, false, {2, 1, 0}}};
  for (const Case& c : cases) {
    Pair rig;
    if (c.x) rig.hinge.set_axis(3, free_axis());
    if (c.y) rig.hinge.set_axis(4, free_axis());
    if (c.z) rig.hinge.set_axis(5, free_axis());
    EXPECT_EQ(rig.hinge.pose().order(), c.order) << c.x << c.y << c.z;
  }
}

TEST(JointConstraint, MiddleAxisHasTheSmallestRange) {
  Pair rig;
  rig.hinge.set_axis(3, limited_axis(-0.5, 0.4));
  rig.hinge.set_axis(4, limited_axis(-3, 3));
  rig.hinge.set_axis(5, free_axis());
  EXPECT_EQ(rig.hinge.pose().order(), (std::array<int, 3>{2, 0, 1}));
}

TEST(JointConstraint, ReadsTheAngleOfOneFreeAxis) {
  for (int axis = 3; axis < 6; ++axis) {
    for (const double angle : {-3.0, -1.7, -0.4, 0.0, 0.2, 1.6, 3.1}) {
      Pair rig;
      rig.hinge.set_axis(axis, free_axis());
      place(rig.parent, rig.child, {Vec3(0), rotation_about(axis, angle)});
      rig.hinge.reset();
      for (int i = 3; i < 6; ++i) EXPECT_NEAR(rig.hinge.value(i), i == axis ? angle : 0, 2e-6) << axis << i;
    }
  }
}

TEST(JointConstraint, OffsetsAreAlongTheParentsAxes) {
  Pair rig;
  place(rig.parent, rig.child, {{0.4, -0.5, 0.6}, rotation_about(2, 1.0)});
  rig.hinge.refresh();
  const Vec3 d = rig.hinge.pose().offsets();
  EXPECT_NEAR(d.x, 0.4, 2e-6);
  EXPECT_NEAR(d.y, -0.5, 2e-6);
  EXPECT_NEAR(d.z, 0.6, 2e-6);
}

TEST(JointConstraint, AnglesRebuildTheRotation) {
  const std::array<std::array<bool, 3>, 3> freedoms{{{true, true, true}, {false, true, true}, {true, true, false}}};
  for (const auto& f : freedoms) {
    Pair rig;
    for (int i = 0; i < 3; ++i) {
      if (f[static_cast<std::size_t>(i)]) rig.hinge.set_axis(3 + i, free_axis());
    }
    const auto [outer, middle, inner] = rig.hinge.pose().order();
    place(rig.parent, rig.child,
          {Vec3(0), rotation_about(outer, 2.2) * rotation_about(middle, -0.8) * rotation_about(inner, -1.9)});
    rig.hinge.reset();
    EXPECT_NEAR(rig.hinge.value(3 + outer), 2.2, 2e-6);
    EXPECT_NEAR(rig.hinge.value(3 + middle), -0.8, 2e-6);
    EXPECT_NEAR(rig.hinge.value(3 + inner), -1.9, 2e-6);
  }
}

TEST(JointConstraint, RelrotIsRollPitchYawForAnyOrder) {
  Pair rig;
  rig.hinge.set_axis(4, free_axis());
  rig.hinge.set_axis(5, free_axis());
  place(rig.parent, rig.child, {Vec3(0), quat_euler(0.3, -1.2, 2.5)});
  rig.hinge.refresh();
  EXPECT_NE(rig.hinge.pose().order(), (std::array<int, 3>{2, 1, 0}));
  EXPECT_NEAR(rig.hinge.pose().relrot().x, 0.3, 2e-6);
  EXPECT_NEAR(rig.hinge.pose().relrot().y, -1.2, 2e-6);
  EXPECT_NEAR(rig.hinge.pose().relrot().z, 2.5, 2e-6);
}

TEST(JointConstraint, CountsFullTurns) {
  Pair rig;
  rig.hinge.set_axis(5, free_axis());
  for (int i = 0; i <= 100; ++i) {
    place(rig.parent, rig.child, {Vec3(0), rotation_about(2, -0.2 * i)});
    rig.hinge.refresh();
  }
  EXPECT_NEAR(rig.hinge.pose().angles().z, -20, 1e-5);
  EXPECT_NEAR(rig.hinge.pose().relrot().z, -20, 1e-5);
  rig.hinge.reset();
  EXPECT_NEAR(rig.hinge.pose().angles().z, -20 + 6 * kPi, 1e-5);
  rig.hinge.reset({0, 0, 31});
  EXPECT_NEAR(rig.hinge.pose().angles().z, -20 + 16 * kPi, 1e-5);
}

TEST(JointConstraint, ReadsAnglesContinuouslyBeyondThePole) {
  Pair rig;
  for (int i = 3; i < 6; ++i) rig.hinge.set_axis(i, free_axis());
  place(rig.parent, rig.child, {});
  rig.hinge.reset();
  for (int i = 0; i <= 40; ++i) {
    place(rig.parent, rig.child,
          {Vec3(0), rotation_about(2, 0.3) * rotation_about(1, 0.1 * i + 0.013) * rotation_about(0, -0.2)});
    rig.hinge.refresh();
  }
  EXPECT_NEAR(rig.hinge.pose().angles().x, -0.2, 1e-5);
  EXPECT_NEAR(rig.hinge.pose().angles().y, 4.013, 1e-5);
  EXPECT_NEAR(rig.hinge.pose().angles().z, 0.3, 1e-5);
}

TEST(JointConstraint, RatesAreTheDerivativesOfAnglesAndOffsets) {
  // constant velocities of both parts for a time dt: the change of the readouts is the rate times dt
  for (const int locked : {-1, 3, 4, 5}) {
    Pair rig;
    for (int i = 3; i < 6; ++i) {
      if (i != locked) rig.hinge.set_axis(i, free_axis());
    }
    const auto [outer, middle, inner] = rig.hinge.pose().order();
    const double bend = locked < 0 ? 0.9 : 0.0;
    place(rig.parent, rig.child,
          {{0.2, 0.1, -0.3}, rotation_about(outer, 1.3) * rotation_about(middle, bend) * rotation_about(inner, -0.6)});
    rig.parent.setAngularVelocity(btVector3(0.3f, -0.5f, 0.2f));
    rig.parent.setLinearVelocity(btVector3(0.1f, 0.2f, -0.4f));
    rig.child.setAngularVelocity(btVector3(-0.4f, 0.7f, 1.1f));
    rig.child.setLinearVelocity(btVector3(-0.3f, 0.5f, 0.2f));
    rig.hinge.reset();
    double before[6];
    double rates[6];
    for (int i = 0; i < 6; ++i) {
      before[i] = rig.hinge.value(i);
      rates[i] = rig.hinge.rate(i);
    }
    const double dt = 2e-3;
    for (btRigidBody* body : {&rig.parent, &rig.child}) {
      const Pose now = bullet::from_bt(body->getWorldTransform());
      const Vec3 spin = bullet::from_bt(body->getAngularVelocity());
      const Quat turned = quat_axis(normalized(spin), glm::length(spin) * dt) * now.rotation;
      body->setWorldTransform(
          bullet::to_bt(Pose{now.position + bullet::from_bt(body->getLinearVelocity()) * dt, turned}));
    }
    rig.hinge.refresh();
    for (int i = 0; i < 6; ++i) EXPECT_NEAR((rig.hinge.value(i) - before[i]) / dt, rates[i], 5e-3) << locked << i;
  }
}

TEST(JointConstraint, ComputesTheEffectiveInertiaOfAHinge) {
  // I_zz + m r² about the hinge, r = 0.5 across the axis
  Rig rig;
  btRigidBody& child = rig.part(2, {0.1, 0.2, 0.3}, {{0.5, 0, 0.7}, quat_identity()});
  bullet::JointConstraint& hinge = rig.joint(rig.ground(), child, {}, {{-0.5, 0, -0.7}, quat_identity()});
  hinge.set_axis(5, free_axis());
  EXPECT_NEAR(hinge.pose().effective_inertia(5), 0.3 + 2 * 0.25, 1e-5);
}

TEST(JointConstraint, ComputesTheEffectiveInertiaOfASliderAndOfFreeParts) {
  Rig rig;
  btRigidBody& child = rig.part(2, Vec3(0.1), {{0.5, 0, 0}, quat_identity()});
  bullet::JointConstraint& slider = rig.joint(rig.ground(), child, {{0.5, 0, 0}, quat_identity()});
  slider.set_axis(2, free_axis());
  EXPECT_NEAR(slider.pose().effective_inertia(2), 2, 1e-5);

  btRigidBody& other = rig.part(3, Vec3(0.1));
  bullet::JointConstraint& loose = rig.joint(other, child, {{0.5, 0, 0}, quat_identity()});
  for (int i = 0; i < 6; ++i) loose.set_axis(i, free_axis());
  EXPECT_NEAR(loose.pose().effective_inertia(0), 2.0 * 3.0 / 5.0, 1e-5);
  EXPECT_NEAR(loose.pose().effective_inertia(3), 0.05, 1e-6);
}

TEST(JointConstraint, LimitingAnAxisDoesNotUnwindIt) {
  Pair rig;
  rig.hinge.set_axis(5, free_axis());
  for (int i = 0; i <= 100; ++i) {
    place(rig.parent, rig.child, {Vec3(0), rotation_about(2, 0.2 * i)});
    rig.hinge.refresh();
  }
  rig.hinge.set_axis(5, limited_axis(0.5, 1.5));
  EXPECT_NEAR(rig.hinge.pose().angles().z, 20 - 6 * kPi, 1e-5);  // 1.15
}

}  // namespace
}  // namespace limber::sim

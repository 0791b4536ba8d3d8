// IslandWorld: islands are independent of each other, joints keep their order, substeps only change the resolution,
// joined parts don't collide, and steps don't allocate.
#include "sim/bullet/island_world.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "joint_rig.h"

namespace limber::sim {
namespace {

constexpr double kTick = 1.0 / 60.0;

// A world with a floor, boxes that collide, and arms of boxes.
struct IslandFixture {
  IslandFixture() {
    world.setGravity(btVector3(0, 0, -9.81f));
    add(0, plane, {{0, 0, 0}, quat_identity()});
  }
  ~IslandFixture() {
    for (auto& joint : joints) world.removeConstraint(joint.get());
    for (auto& body : bodies) {
      if (body->isInWorld()) world.removeRigidBody(body.get());
    }
  }
  IslandFixture(const IslandFixture&) = delete;
  IslandFixture& operator=(const IslandFixture&) = delete;

  btRigidBody& add(double mass, btCollisionShape& shape, const Pose& pose) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(bullet::to_scalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(bullet::to_scalar(mass), nullptr, &shape, inertia);
    info.m_startWorldTransform = bullet::to_bt(pose);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    bodies.back()->setFriction(0.5f);
    world.addRigidBody(bodies.back().get());
    return *bodies.back();
  }
  // A servo arm of `parts` boxes that lies down on the floor, and a heap of three boxes in its way.
  std::vector<btRigidBody*> arm(const Vec3& at, int parts) {
    std::vector<btRigidBody*> all;
    for (int i = 0; i < parts; ++i) {
      all.push_back(&add(1, box, {at + Vec3(0, 0, 0.3 + 0.21 * i), quat_identity()}));
      if (i == 0) continue;
      const Quat y = quat_axis({1, 0, 0}, -kPi / 2);
      joints.push_back(std::make_unique<bullet::JointConstraint>(*all[static_cast<std::size_t>(i - 1)], *all.back(),
                                                                 bullet::to_bt(Pose{{0, 0, 0.105}, y}),
                                                                 bullet::to_bt(Pose{{0, 0, -0.105}, y})));
      joints.back()->set_axis(5, servo_axis(limited_axis(-2, 2), 0.3 * (i % 3), 2, 20));
      world.addConstraint(joints.back().get());
    }
    for (int i = 0; i < 3; ++i)
      all.push_back(&add(0.5, box, {at + Vec3(0.3, 0.01 * i, 0.12 + 0.22 * i), quat_identity()}));
    return all;
  }

  btStaticPlaneShape plane{btVector3(0, 0, 1), 0};
  btBoxShape box{btVector3(0.05f, 0.05f, 0.1f)};
  std::deque<std::unique_ptr<btRigidBody>> bodies;
  std::deque<std::unique_ptr<bullet::JointConstraint>> joints;
  bullet::IslandWorld world{WorldSetup{0.01, 20}};
};

bool same_bits(const btRigidBody& a, const btRigidBody& b) {
  const btScalar* x = a.getWorldTransform().getBasis()[0];
  const btScalar* y = b.getWorldTransform().getBasis()[0];
  return std::memcmp(x, y, 12 * sizeof(btScalar)) == 0 &&
         std::memcmp(a.getWorldTransform().getOrigin(), b.getWorldTransform().getOrigin(), 12) == 0 &&
         std::memcmp(a.getLinearVelocity(), b.getLinearVelocity(), 12) == 0 &&
         std::memcmp(a.getAngularVelocity(), b.getAngularVelocity(), 12) == 0;
}

TEST(IslandWorld, IslandsAreIndependent) {
  IslandFixture alone;
  IslandFixture crowd;
  const Vec3 at(1, 2, 0);
  // others before it, after it, and one that is added and removed
  for (int i = 0; i < 6; ++i) crowd.arm({10.0 + 2 * i, -5, 0}, 2 + i);
  const auto in_crowd = crowd.arm(at, 6);
  for (int i = 0; i < 6; ++i) crowd.arm({10.0 + 2 * i, 5, 0}, 7 - i);
  btRigidBody& temporary = crowd.add(1, crowd.box, {{-20, 0, 0.5}, quat_identity()});
  const auto single = alone.arm(at, 6);
  for (int tick = 0; tick < 300; ++tick) {
    alone.world.step(kTick / 4, 4);
    crowd.world.step(kTick / 4, 4);
    if (tick == 50) crowd.world.removeRigidBody(&temporary);
    if (tick == 90) crowd.world.addRigidBody(&temporary);
    for (std::size_t i = 0; i < single.size(); ++i)
      ASSERT_TRUE(same_bits(*single[i], *in_crowd[i])) << tick << ' ' << i;
  }
  // the arm moved and had contacts
  EXPECT_GT(glm::length(bullet::from_bt(single[5]->getCenterOfMassPosition()) - (at + Vec3(0, 0, 1.35))), 0.1);
}

TEST(IslandWorld, ResultDoesNotDependOnBatches) {
  IslandFixture one;
  IslandFixture many;
  one.world.getSolverInfo().m_minimumSolverBatchSize = 1;
  many.world.getSolverInfo().m_minimumSolverBatchSize = 1000;
  std::vector<btRigidBody*> a;
  std::vector<btRigidBody*> b;
  for (int i = 0; i < 5; ++i) {
    for (btRigidBody* body : one.arm({2.0 * i, 0, 0}, 3 + i)) a.push_back(body);
    for (btRigidBody* body : many.arm({2.0 * i, 0, 0}, 3 + i)) b.push_back(body);
  }
  for (int tick = 0; tick < 120; ++tick) {
    one.world.step(kTick / 2, 2);
    many.world.step(kTick / 2, 2);
  }
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same_bits(*a[i], *b[i])) << i;
}

TEST(IslandWorld, RemovingAJointKeepsTheOrder) {
  Rig rig;
  btRigidBody* parent = &rig.ground();
  for (int i = 0; i < 6; ++i) {
    btRigidBody& child = rig.part(1, Vec3(0.1), {{0.2 * i, 0, 0}, quat_identity()});
    rig.joint(*parent, child);
    parent = &child;
  }
  rig.world.removeConstraint(rig.joints[2].get());
  rig.joints.erase(rig.joints.begin() + 2);
  ASSERT_EQ(rig.world.getNumConstraints(), 5);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rig.world.getConstraint(i), rig.joints[static_cast<std::size_t>(i)].get());
}

TEST(IslandWorld, FreeFallMatchesTheDiscreteSum) {
  // z(n) = z0 - g h² n(n+1)/2: substeps only change the resolution
  for (const int substeps : {1, 4, 7}) {
    Rig rig;
    rig.world.setGravity(btVector3(0, 0, -9.81f));
    btRigidBody& part = rig.part(3, Vec3(0.1));
    for (int tick = 0; tick < 60; ++tick) rig.world.step(kTick / substeps, substeps);
    const double n = 60 * substeps;
    const double h = kTick / substeps;
    EXPECT_NEAR(part.getCenterOfMassPosition().z(), -9.81 * h * h * n * (n + 1) / 2, 2e-5);
  }
}

TEST(IslandWorld, ForceActsDuringItsTickOnly) {
  for (const int substeps : {1, 4, 7}) {
    Rig rig;
    btRigidBody& part = rig.part(2, Vec3(0.1));
    part.applyCentralForce(btVector3(3, 0, 0));
    rig.world.step(kTick / substeps, substeps);
    EXPECT_NEAR(part.getLinearVelocity().x(), 1.5 * kTick, 1e-6);
    rig.world.step(kTick / substeps, substeps);
    EXPECT_NEAR(part.getLinearVelocity().x(), 1.5 * kTick, 1e-6);
  }
}

TEST(IslandWorld, AppliedForceIsTheMeanOfTheTick) {
  // a brake of 1 N stops 1 kg at 1/240 m/s within the first of four steps
  Rig rig;
  btRigidBody& part = rig.part(1, Vec3(0.1));
  bullet::JointConstraint& joint = rig.joint(rig.ground(), part);
  joint.set_axis(0, spin_axis(free_axis(), 0, 1));
  part.setLinearVelocity(btVector3(bullet::to_scalar(kRigStep), 0, 0));
  rig.steps(4);
  EXPECT_NEAR(joint.drives().applied_force().x, -0.25, 1e-5);
  EXPECT_NEAR(joint.rate(0), 0, 1e-6);
}

TEST(IslandWorld, LongArmFollowsItsServosWithTenIterations) {
  // nine hinges, ±0.3 rad at 0.5 Hz under gravity: the error stays below 3 degrees (stock Bullet: 1.2 rad)
  Rig rig;
  rig.world.setGravity(btVector3(0, 0, -9.81f));
  rig.world.getSolverInfo().m_numIterations = 10;
  btRigidBody* parent = &rig.ground();
  for (int i = 1; i < 10; ++i) {
    btRigidBody& child = rig.part(1, {0.0042, 0.0042, 0.0017}, {{0, 0, -0.2 * i}, quat_identity()});
    const Quat axis = i % 2 ? quat_axis({0, 1, 0}, kPi / 2) : quat_axis({1, 0, 0}, -kPi / 2);
    rig.joint(*parent, child, {{0, 0, -0.1}, axis}, {{0, 0, 0.1}, axis});
    parent = &child;
  }
  double worst = 0;
  for (int i = 0; i < 1440; ++i) {
    const double target = 0.3 * std::sin(kPi * i * kRigStep);
    for (auto& joint : rig.joints) joint->set_axis(5, servo_axis(limited_axis(-1.4, 1.4), target, 2, 10000));
    rig.steps(1);
    for (auto& joint : rig.joints) {
      if (i >= 1200) worst = std::max(worst, std::fabs(joint->value(5) - target));
    }
  }
  EXPECT_LT(worst, 0.05);
}

TEST(IslandWorld, SupportsBulletsOwnConstraints) {
  Rig rig;
  btRigidBody& first = rig.part(1, Vec3(0.1), {{0.5, 0, 0}, quat_identity()});
  btRigidBody& second = rig.part(1, Vec3(0.1), {{1.5, 0, 0}, quat_identity()});
  bullet::JointConstraint& hinge = rig.joint(rig.ground(), first, {}, {{-0.5, 0, 0}, quat_identity()});
  hinge.set_axis(5, spin_axis(free_axis(), 1, 1000));
  btFixedConstraint weld(first, second, bullet::to_bt(Pose{{0.5, 0, 0}, quat_identity()}),
                         bullet::to_bt(Pose{{-0.5, 0, 0}, quat_identity()}));
  rig.world.addConstraint(&weld);
  rig.steps(240);
  EXPECT_NEAR(hinge.value(5), 1, 0.01);
  const Vec3 expected(1.5 * std::cos(hinge.value(5)), 1.5 * std::sin(hinge.value(5)), 0);
  EXPECT_LT(glm::length(bullet::from_bt(second.getCenterOfMassPosition()) - expected), 5e-3);
  rig.world.removeConstraint(&weld);
}

TEST(IslandWorld, StepOfNoLengthDoesNothing) {
  Rig rig;
  rig.world.setGravity(btVector3(0, 0, -9.81f));
  btRigidBody& part = rig.part(1, Vec3(0.1));
  rig.world.step(0, 4);
  rig.world.step(kTick, 0);
  rig.world.step(-1, 4);
  EXPECT_EQ(part.getCenterOfMassPosition().z(), 0);
}

// Simulates two boxes that overlap by 2 cm for a second. Returns the increase of their distance, m: 0 if they don't
// collide.
double separation_after_a_second(IslandFixture& fixture, btRigidBody& a, btRigidBody& b) {
  for (btRigidBody* body : {&a, &b}) {
    body->clearForces();
    body->setLinearVelocity(btVector3(0, 0, 0));
    body->setAngularVelocity(btVector3(0, 0, 0));
  }
  a.setWorldTransform(bullet::to_bt(Pose{{0, 0, 1}, quat_identity()}));
  b.setWorldTransform(bullet::to_bt(Pose{{0.08, 0, 1}, quat_identity()}));
  for (int i = 0; i < 60; ++i) fixture.world.step(kTick, 1);
  return static_cast<double>((b.getCenterOfMassPosition() - a.getCenterOfMassPosition()).x()) - 0.08;
}

TEST(IslandWorld, JoinedPartsCollideOnlyWithoutJoints) {
  IslandFixture fixture;
  fixture.world.setGravity(btVector3(0, 0, 0));
  btRigidBody& a = fixture.add(1, fixture.box, {{0, 0, 1}, quat_identity()});
  btRigidBody& b = fixture.add(1, fixture.box, {{0.08, 0, 1}, quat_identity()});
  EXPECT_GT(separation_after_a_second(fixture, a, b), 0.01);

  // joints of six free axes affect collision only; the boxes overlap and have contacts when they are joined
  a.setWorldTransform(bullet::to_bt(Pose{{0, 0, 1}, quat_identity()}));
  b.setWorldTransform(bullet::to_bt(Pose{{0.08, 0, 1}, quat_identity()}));
  fixture.world.step(1e-4, 1);
  bullet::JointConstraint first(a, b, btTransform::getIdentity(), btTransform::getIdentity());
  bullet::JointConstraint second(b, a, btTransform::getIdentity(), btTransform::getIdentity());
  for (int i = 0; i < 6; ++i) {
    first.set_axis(i, free_axis());
    second.set_axis(i, free_axis());
  }
  fixture.world.addConstraint(&first);
  fixture.world.addConstraint(&second);
  EXPECT_NEAR(separation_after_a_second(fixture, a, b), 0, 1e-6);
  fixture.world.removeConstraint(&first);
  EXPECT_NEAR(separation_after_a_second(fixture, a, b), 0, 1e-6);
  fixture.world.removeConstraint(&second);
  EXPECT_GT(separation_after_a_second(fixture, a, b), 0.01);
  fixture.world.addConstraint(&first);
  EXPECT_NEAR(separation_after_a_second(fixture, a, b), 0, 1e-6);
  fixture.world.removeConstraint(&first);
}

TEST(IslandWorld, BallBouncesByItsRestitution) {
  IslandFixture fixture;
  btSphereShape ball(0.1f);
  btRigidBody& part = fixture.add(1, ball, {{0, 0, 2.1}, quat_identity()});
  part.setRestitution(0.5f);
  part.setContactProcessingThreshold(0);  // speculative contacts would decelerate it
  fixture.bodies.front()->setRestitution(1);
  double highest = 0;
  bool landed = false;
  for (int i = 0; i < 480; ++i) {
    fixture.world.step(kTick / 4, 1);
    const double z = part.getCenterOfMassPosition().z() - 0.1;
    if (z < 0.02) landed = true;
    if (landed) highest = std::max(highest, z);
  }
  EXPECT_NEAR(highest, 0.5, 0.015);
}

// Counts heap allocations of Bullet and IslandWorld.
int bullet_allocations = 0;
void* counting_alloc(std::size_t size) {
  ++bullet_allocations;
  return std::malloc(size);
}
void plain_free(void* memory) { std::free(memory); }

TEST(IslandWorld, StepsDoNotAllocate) {
  IslandFixture fixture;
  for (int i = 0; i < 5; ++i) fixture.arm({2.0 * i, 0, 0}, 6);
  for (int i = 0; i < 120; ++i) fixture.world.step(kTick / 4, 4);
  btAlignedAllocSetCustom(counting_alloc, plain_free);
  bullet_allocations = 0;
  for (int i = 0; i < 120; ++i) fixture.world.step(kTick / 4, 4);
  const int counted = bullet_allocations;
  btAlignedAllocSetCustom(nullptr, nullptr);
  EXPECT_EQ(counted, 0);
}

}  // namespace
}  // namespace limber::sim

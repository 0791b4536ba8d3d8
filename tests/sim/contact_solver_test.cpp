// ContactSolver compared with Bullet's sweeps on random rows: identical to the bit along normals; friction within the
// disc, opposite to the slip.
#include "sim/bullet/contact_solver.h"

#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace limber::sim {
namespace {

constexpr int kBodyCount = 12;  // the first one is static
constexpr int kPairs = 40;

// Bullet's solver with given rows in its pools.
class BulletSolver : public btSequentialImpulseConstraintSolver {
 public:
  explicit BulletSolver(unsigned seed, float coefficient = 0) : generator_(seed), coefficient_(coefficient) {
    info_.m_numIterations = 1;
    info_.m_splitImpulse = 1;
    info_.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
    for (int i = 0; i < kBodyCount; ++i) add_body(i > 0);
    for (int i = 0; i < kPairs; ++i) {
      const int a = static_cast<int>(generator_() % kBodyCount);
      const int b = (a + 1 + static_cast<int>(generator_() % (kBodyCount - 1))) % kBodyCount;
      for (unsigned points = generator_() % 4 + 1; points > 0; --points) add_contact(a, b);
    }
    for (int i = 0; i < friction().size(); ++i) {
      m_orderTmpConstraintPool.push_back(i);
      m_orderFrictionConstraintPool.push_back(i);
    }
  }
  void solve_split_impulses() {
    solveGroupCacheFriendlySplitImpulseIterations(nullptr, 0, nullptr, 0, nullptr, 0, info_, nullptr);
  }
  void sweep() { solveSingleIteration(0, nullptr, 0, nullptr, 0, nullptr, 0, info_, nullptr); }

  btAlignedObjectArray<btSolverBody>& bodies() { return m_tmpSolverBodyPool; }
  btConstraintArray& contacts() { return m_tmpSolverContactConstraintPool; }
  btConstraintArray& friction() { return m_tmpSolverContactFrictionConstraintPool; }

 private:
  float draw(float low, float high) {
    return low + (high - low) * (static_cast<float>(generator_() >> 8) / 16777216.0F);
  }
  btVector3 draw_vector() {
    const float x = draw(-1, 1);
    const float y = draw(-1, 1);
    return {x, y, draw(-1, 1)};
  }
  void add_body(bool moves) {
    btSolverBody& body = bodies().expand();
    std::memset(static_cast<void*>(&body), 0, sizeof body);
    body.m_linearFactor = body.m_angularFactor = btVector3(1, 1, 1);
    if (!moves) return;
    body.m_originalBody = &part_;
    const float inverse_mass = draw(0.2F, 3);
    body.m_invMass = btVector3(inverse_mass, inverse_mass, inverse_mass);
    body.m_deltaLinearVelocity = draw_vector();
    body.m_deltaAngularVelocity = draw_vector();
    body.m_pushVelocity = draw_vector();
    body.m_turnVelocity = draw_vector();
  }
  btSolverConstraint row(int a, int b) {
    btSolverConstraint r;
    std::memset(static_cast<void*>(&r), 0, sizeof r);
    r.m_solverBodyIdA = a;
    r.m_solverBodyIdB = b;
    const btVector3 along = draw_vector();
    if (a > 0) {
      r.m_contactNormal1 = along;
      r.m_relpos1CrossNormal = draw_vector();
      r.m_angularComponentA = draw_vector();
    }
    if (b > 0) {
      r.m_contactNormal2 = -along;
      r.m_relpos2CrossNormal = draw_vector();
      r.m_angularComponentB = draw_vector();
    }
    r.m_jacDiagABInv = draw(0.1F, 0.4F);
    r.m_rhs = draw(-1, 1);
    r.m_cfm = generator_() % 4 == 0 ? draw(0, 0.1F) : 0;
    r.m_appliedImpulse = draw(0, 0.5F);
    return r;
  }
  void add_contact(int a, int b) {
    btSolverConstraint c = row(a, b);
    c.m_frictionIndex = friction().size();
    c.m_upperLimit = 1e10F;
    if (generator_() % 3 != 0) c.m_rhsPenetration = draw(0, 1);
    for (int i = 0; i < 2; ++i) {
      btSolverConstraint f = row(a, b);
      f.m_friction = coefficient_;
      f.m_appliedImpulse = 0;
      f.m_frictionIndex = contacts().size();
      friction().push_back(f);
    }
    contacts().push_back(c);
  }

  std::mt19937 generator_;
  float coefficient_;
  btContactSolverInfo info_;
  btRigidBody part_{btRigidBody::btRigidBodyConstructionInfo(1, nullptr, nullptr)};
};

bool same_bits(const btVector3& x, const btVector3& y) { return std::memcmp(&x, &y, 3 * sizeof(float)) == 0; }

void expect_same(BulletSolver& ours, BulletSolver& theirs) {
  for (int i = 0; i < kBodyCount; ++i) {
    const btSolverBody& x = ours.bodies()[i];
    const btSolverBody& y = theirs.bodies()[i];
    EXPECT_TRUE(x.m_originalBody == nullptr || same_bits(x.m_deltaLinearVelocity, y.m_deltaLinearVelocity)) << i;
    EXPECT_TRUE(x.m_originalBody == nullptr || same_bits(x.m_deltaAngularVelocity, y.m_deltaAngularVelocity)) << i;
    EXPECT_TRUE(x.m_originalBody == nullptr || same_bits(x.m_pushVelocity, y.m_pushVelocity)) << i;
    EXPECT_TRUE(x.m_originalBody == nullptr || same_bits(x.m_turnVelocity, y.m_turnVelocity)) << i;
  }
  for (int i = 0; i < ours.contacts().size(); ++i) {
    EXPECT_EQ(ours.contacts()[i].m_appliedImpulse, theirs.contacts()[i].m_appliedImpulse) << i;
    EXPECT_EQ(ours.contacts()[i].m_appliedPushImpulse, theirs.contacts()[i].m_appliedPushImpulse) << i;
  }
  for (int i = 0; i < ours.friction().size(); ++i) {
    EXPECT_EQ(ours.friction()[i].m_appliedImpulse, theirs.friction()[i].m_appliedImpulse) << i;
  }
}

TEST(ContactSolver, MatchesBulletsNormalImpulses) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    BulletSolver ours(seed);
    BulletSolver theirs(seed);
    bullet::ContactSolver contacts;
    contacts.begin(ours.bodies(), ours.contacts(), ours.friction());
    for (int i = 0; i < 10; ++i) {
      EXPECT_GT(contacts.sweep_split_impulse(), 0);
      EXPECT_GT(contacts.sweep(), 0);
      theirs.solve_split_impulses();
      theirs.sweep();
    }
    contacts.finish();
    expect_same(ours, theirs);
  }
}

TEST(ContactSolver, FrictionStaysWithinTheDisc) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    BulletSolver rows(seed, 0.4F);
    bullet::ContactSolver contacts;
    contacts.begin(rows.bodies(), rows.contacts(), rows.friction());
    for (int i = 0; i < 5; ++i) contacts.sweep();
    contacts.finish();
    int sliding = 0;
    for (int i = 0; i < rows.contacts().size(); ++i) {
      const float normal_impulse = rows.contacts()[i].m_appliedImpulse;
      if (!(normal_impulse > 0)) continue;
      const float force =
          std::hypot(rows.friction()[2 * i].m_appliedImpulse, rows.friction()[2 * i + 1].m_appliedImpulse);
      EXPECT_LE(force, 0.4F * normal_impulse * 1.0001F);
      if (force > 0.4F * normal_impulse * 0.9999F) ++sliding;
    }
    EXPECT_GT(sliding, 5);
  }
}

// A ball that presses with 6 N·s on the floor and slides at 3 m/s: friction is opposite to the slip, even if the two
// rows have different responses (it rotates about one axis more easily).
TEST(ContactSolver, FrictionIsOppositeToTheSlip) {
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(2, nullptr, nullptr));
  for (const double heading : {0.0, 0.4, 0.8, 1.2, 2.0}) {
    btAlignedObjectArray<btSolverBody> bodies;
    btConstraintArray contacts;
    btConstraintArray friction;
    for (int i = 0; i < 2; ++i) std::memset(static_cast<void*>(&bodies.expand()), 0, sizeof(btSolverBody));
    bodies[1].m_originalBody = &ball;
    bodies[1].m_invMass = btVector3(0.5F, 0.5F, 0.5F);
    const btVector3 v(static_cast<float>(3 * std::cos(heading)), static_cast<float>(3 * std::sin(heading)), -3);
    for (const btVector3& along : {btVector3(0, 0, 1), btVector3(1, 0, 0), btVector3(0, 1, 0)}) {
      btSolverConstraint row;
      std::memset(static_cast<void*>(&row), 0, sizeof row);
      row.m_solverBodyIdB = 1;
      row.m_contactNormal2 = along;
      const bool turns = along.x() > 0;
      row.m_relpos2CrossNormal = btVector3(0, turns ? 1 : 0, 0);
      row.m_angularComponentB = btVector3(0, turns ? 1 : 0, 0);
      row.m_jacDiagABInv = turns ? 1 / 1.5F : 2;
      row.m_rhs = -v.dot(along) * row.m_jacDiagABInv;
      row.m_friction = 0.1F;
      (along.z() > 0 ? contacts : friction).push_back(row);
    }
    bullet::ContactSolver sweep;
    sweep.begin(bodies, contacts, friction);
    for (int i = 0; i < 60; ++i) sweep.sweep();
    sweep.finish();
    const btVector3 after = v + bodies[1].m_deltaLinearVelocity + btVector3(bodies[1].m_deltaAngularVelocity.y(), 0, 0);
    const float force_x = friction[0].m_appliedImpulse;
    const float force_y = friction[1].m_appliedImpulse;
    EXPECT_NEAR(std::hypot(force_x, force_y), 0.1F * contacts[0].m_appliedImpulse, 1e-5);
    EXPECT_NEAR(force_x * after.y() - force_y * after.x(), 0, 1e-4) << heading;
    EXPECT_LT(force_x * after.x() + force_y * after.y(), 0) << heading;
  }
}

// A ball of 2 kg hits the floor at 3 m/s, sliding at 0.5 m/s with a friction of 0.4: 6 N·s stop its fall, and the 1 N·s
// that stops its slide is within 0.4 · 6. A second sweep changes nothing.
TEST(ContactSolver, ConvergesInOneSweepForABall) {
  btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(2, nullptr, nullptr));
  btAlignedObjectArray<btSolverBody> bodies;
  btConstraintArray contacts;
  btConstraintArray friction;
  for (int i = 0; i < 2; ++i) std::memset(static_cast<void*>(&bodies.expand()), 0, sizeof(btSolverBody));
  bodies[1].m_originalBody = &ball;
  bodies[1].m_invMass = btVector3(0.5F, 0.5F, 0.5F);
  for (const btVector3& along : {btVector3(0, 0, 1), btVector3(1, 0, 0), btVector3(0, 1, 0)}) {
    btSolverConstraint row;
    std::memset(static_cast<void*>(&row), 0, sizeof row);
    row.m_solverBodyIdB = 1;
    row.m_contactNormal2 = along;
    row.m_jacDiagABInv = 2;
    row.m_rhs = 2 * btVector3(-0.5F, 0, 3).dot(along);
    row.m_friction = 0.4F;
    (along.z() > 0 ? contacts : friction).push_back(row);
  }
  bullet::ContactSolver sweep;
  sweep.begin(bodies, contacts, friction);
  EXPECT_FLOAT_EQ(sweep.sweep(), 36);
  EXPECT_FLOAT_EQ(sweep.impulse(0), 6);
  EXPECT_EQ(sweep.sweep(), 0);
  EXPECT_EQ(sweep.sweep_split_impulse(), 0);  // no penetration
  sweep.finish();
  EXPECT_FLOAT_EQ(contacts[0].m_appliedImpulse, 6);
  EXPECT_FLOAT_EQ(friction[0].m_appliedImpulse, -1);
  EXPECT_FLOAT_EQ(friction[1].m_appliedImpulse, 0);
  EXPECT_FLOAT_EQ(bodies[1].m_deltaLinearVelocity.z(), 3);
}

}  // namespace
}  // namespace limber::sim

// AxisActiveSet: the active set is found in long chains, and restored from the step before.
#include "sim/solver/forest/axis_active_set.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limber::sim {
namespace {

// A body of 1 kg and 1 kg·m² on a hinge about z through its center, with a motor of 0.1 N·m·s and 0.05 rad/s.
struct Hinge {
  explicit Hinge(const solver::ActiveSetWarmStart& before) {
    rows.clear();
    solver::TreeNode& n = rows.forest.add(-1);
    solver::Sym3 one;
    one.xx = one.yy = one.zz = 1;
    n.inertia = solver::SpatialInertia(1, one);
    for (int i = 0; i < 3; ++i) {
      n.axis[i].linear[i] = 1;
      n.axis[3 + i].angular[i] = 1;
    }
    for (int axis = 0; axis < 5; ++axis)
      rows.add(axis, 0, 0, -2 * solver::AxisRow::kInfinity, 2 * solver::AxisRow::kInfinity, solver::AxisRow::other);
    rows.add(5, 0.05, 0, -0.1, 0.1, solver::AxisRow::motor);
    rows.end_node({}, before);
    EXPECT_TRUE(rows.solve(0, 1, 8));
  }
  // applies an impulse, as a contact does
  void apply_contact_impulse(double impulse) {
    rows.forest.node(0).load.angular.z = impulse;
    rows.solve_once(0, 1);
  }
  const solver::AxisRow& motor() { return rows.rows().back(); }
  solver::WorkBudget budget;
  solver::AxisActiveSet rows{budget};
};

// The motor reaches its speed until a larger impulse acts against it. It is deferred then, and the next step defers it
// at once, with the status at its bound.
TEST(AxisActiveSet, RemembersAxesChangedByContacts) {
  Hinge first{{}};
  EXPECT_NEAR(first.motor().impulse, 0.05, 1e-12);
  EXPECT_EQ(first.rows.defer_as_before(0, 1), 0);
  first.apply_contact_impulse(-1);
  EXPECT_NEAR(first.motor().impulse, 1.05, 1e-12) << "the motor still holds";
  EXPECT_EQ(first.rows.defer_violated(0, 1), 1);
  EXPECT_TRUE(first.rows.factor_and_solve_once(0, 1));
  EXPECT_NEAR(first.motor().impulse, 0.1, 1e-12);

  Hinge second{first.rows.active_set(0)};
  EXPECT_EQ(second.motor().initial_status, solver::AxisRow::at_upper);
  EXPECT_EQ(second.rows.defer_as_before(0, 1), 1);
  EXPECT_EQ(second.rows.defer_as_before(0, 1), 0) << "only once";
  EXPECT_EQ(second.motor().status, solver::AxisRow::deferred);

  // no impulse this time: the active set is again that of the tree alone
  Hinge third{second.rows.active_set(0)};
  EXPECT_EQ(third.rows.defer_as_before(0, 1), 0);
}

// An upright chain of boxes of 1 kg and 0.2 m, 0.1 m wide; hinges with motors about x and y in turn.
struct Chain {
  Chain(int count, double max_impulse) {
    solver::Sym3 moment;
    moment.xx = moment.yy = (0.01 + 0.04) / 12;
    moment.zz = (0.01 + 0.01) / 12;
    rows.clear();
    for (int i = 0; i < count; ++i) {
      solver::TreeNode& n = rows.forest.add(i - 1);
      n.inertia = solver::SpatialInertia(1, moment);
      n.offset = {0, 0, 0.2};
      for (int k = 0; k < 3; ++k) {
        Vec3 direction(0);
        direction[k] = 1;
        n.axis[k].linear = direction;
        n.axis[3 + k] = {glm::cross(Vec3(0, 0, -0.1), direction), direction};
      }
      const int hinge = 3 + i % 2;
      for (int axis = 0; axis < 6; ++axis) {
        if (axis != hinge)
          rows.add(axis, 0, 0, -2 * solver::AxisRow::kInfinity, 2 * solver::AxisRow::kInfinity, solver::AxisRow::other);
      }
      rows.add(hinge, 0.6 * fixed::sin(0.4 * i), 0, -max_impulse, max_impulse, solver::AxisRow::motor);
      rows.end_node({}, {});
    }
  }
  solver::WorkBudget budget;
  solver::AxisActiveSet rows{budget};
};

// At first nearly every motor of the lower half seems to be overloaded. Block exchanges alone don't converge.
TEST(AxisActiveSet, FindsTheFewMotorsOfALongChainThatYield) {
  Chain chain(170, 1e6 / 60);
  ASSERT_TRUE(chain.rows.solve_from_scratch(0, 170, 16));
  int yielding = 0;
  for (const solver::AxisRow& row : chain.rows.rows()) {
    ASSERT_NE(row.status, solver::AxisRow::deferred) << row.node;
    if (row.kind != solver::AxisRow::motor) continue;
    const double missing = row.velocity - chain.rows.rate(row.node, row.axis);
    EXPECT_LE(std::fabs(row.impulse), row.upper + 0.1) << row.node;
    if (row.status == solver::AxisRow::active) {
      EXPECT_NEAR(missing, 0, 1e-5) << row.node;
    } else {
      yielding++;
      EXPECT_GT(missing * row.impulse, 0) << row.node << ": a motor at its bound must be slower than its target";
    }
  }
  EXPECT_EQ(yielding, 2);
}

}  // namespace
}  // namespace limber::sim

// AxisActiveSet: the active set is restored from the step before.
#include "sim/solver/forest/axis_active_set.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace limber::sim

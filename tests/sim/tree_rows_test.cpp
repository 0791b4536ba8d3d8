// The laws of trees' axes: what a step remembers of the one before.
#include "sim/tree_rows.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// One body of 1 kg and 1 kg·m² on a hinge about z in its centre, with a motor of 0.1 N·m·s that wants 0.05 rad/s.
struct Hinge {
  explicit Hinge(const TreeMemory& before) {
    rows.clear();
    TreeNode& n = rows.trees.add(-1);
    Sym3 one;
    one.xx = one.yy = one.zz = 1;
    n.inertia = SpatialInertia(1, one);
    for (int i = 0; i < 3; ++i) {
      n.axis[static_cast<std::size_t>(i)].linear[i] = 1;
      n.axis[3 + static_cast<std::size_t>(i)].angular[i] = 1;
    }
    for (int axis = 0; axis < 5; ++axis) rows.add(axis, 0, 0, -2 * kTreeInfinity, 2 * kTreeInfinity, TreeRow::other);
    rows.add(5, 0.05, 0, -0.1, 0.1, TreeRow::motor);
    rows.end_node({}, before);
    EXPECT_TRUE(rows.settle(0, 1, 8));
  }
  // what a contact may do
  void turn(double impulse) {
    rows.trees.node(0).load.angular.z = impulse;
    rows.correct(0, 1);
  }
  const TreeRow& motor() { return rows.rows().back(); }
  Effort effort;
  TreeRows rows{effort};
};

// The motor reaches its speed, until something turns against it with more than it has. Then it is given up, and the
// step that follows gives it up at once, as a row that stands at its bound.
TEST(TreeRows, WhatContactsDidIsRemembered) {
  Hinge first{{}};
  EXPECT_NEAR(first.motor().impulse, 0.05, 1e-12);
  EXPECT_EQ(first.rows.give_up_remembered(0, 1), 0);
  first.turn(-1);
  EXPECT_NEAR(first.motor().impulse, 1.05, 1e-12) << "it still holds";
  EXPECT_EQ(first.rows.give_up_broken(0, 1), 1);
  EXPECT_TRUE(first.rows.refresh(0, 1));
  EXPECT_NEAR(first.motor().impulse, 0.1, 1e-12);

  Hinge second{first.rows.memory(0)};
  EXPECT_EQ(second.motor().guess, TreeRow::at_upper);
  EXPECT_EQ(second.rows.give_up_remembered(0, 1), 1);
  EXPECT_EQ(second.rows.give_up_remembered(0, 1), 0) << "only once";
  EXPECT_EQ(second.motor().status, TreeRow::outer);

  // nothing turned against it this time: it came to stand where the tree alone had it
  Hinge third{second.rows.memory(0)};
  EXPECT_EQ(third.rows.give_up_remembered(0, 1), 0);
}

}  // namespace
}  // namespace limber

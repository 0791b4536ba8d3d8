// WorkBudget: counting work and the tolerance beyond the limit.
#include "sim/solver/work_budget.h"

#include <gtest/gtest.h>

using namespace limber::sim;

namespace {

// A vector operation costs its elements plus eight.
TEST(WorkBudget, IsExceededBeyondItsLimit) {
  solver::WorkBudget budget;
  EXPECT_FALSE(budget.exceeded(1e12)) << "there is no limit before set_limit()";
  budget.reset();
  budget.set_limit(1000);
  EXPECT_FALSE(budget.exceeded(1000));
  EXPECT_TRUE(budget.exceeded(1001));
  budget.charge(40, 12);
  EXPECT_EQ(budget.spent(), 800);
  EXPECT_FALSE(budget.exceeded(200));
  EXPECT_TRUE(budget.exceeded(201));
  EXPECT_EQ(budget.tolerance(1e-6), 1e-6);
  budget.charge(11, 12);
  EXPECT_TRUE(budget.exceeded());
  EXPECT_EQ(budget.tolerance(1e-6), 1e-2);
  EXPECT_EQ(budget.tolerance(0.5), 0.5) << "a larger tolerance stays";
  budget.set_limit(3000);
  EXPECT_FALSE(budget.exceeded());
  budget.reset();
  EXPECT_EQ(budget.spent(), 0);
}

}  // namespace

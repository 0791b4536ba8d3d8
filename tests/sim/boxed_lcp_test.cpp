// BoxedLcp: checks that solutions of random problems and of a block on the floor satisfy the complementarity
// conditions.
#include "sim/solver/lcp/boxed_lcp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limber::sim {
namespace {

// Returns the largest violation, recalculated from the whole matrix. If `converged`, all impulses must be within their
// bounds; otherwise an impulse outside of its bounds counts as a violation.
double largest_violation(solver::BoxedLcp& box, const std::vector<double>& residuals,
                         const std::vector<double>& start_impulses, bool converged = true) {
  double largest = 0;
  for (int i = 0; i < box.size(); ++i) {
    const solver::BoxedLcp::Row& r = box.row(i);
    double residual = residuals[static_cast<std::size_t>(i)];
    for (int k = 0; k < box.size(); ++k) {
      residual -= box.response(i, k) * (box.row(k).impulse - start_impulses[static_cast<std::size_t>(k)]);
    }
    double lower = r.lower;
    double upper = r.upper;
    if (r.normal >= 0) {
      upper = r.friction * std::max(box.row(r.normal).impulse, 0.0);
      lower = -upper;
    }
    if (converged) {
      EXPECT_GE(r.impulse, lower - 1e-9) << i;
      EXPECT_LE(r.impulse, upper + 1e-9) << i;
    }
    const double diagonal = box.response(i, i);
    largest =
        std::max(largest, std::fabs(std::clamp(r.impulse + residual / diagonal, lower, upper) - r.impulse) * diagonal);
  }
  return largest;
}

TEST(BoxedLcp, SolvesRandomProblems) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 generator(seed);
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(generator);
    };
    const int n = 1 + static_cast<int>(seed % 25);
    // response = G·G' + a small diagonal, with units of different magnitude
    std::vector<std::vector<double>> g(static_cast<std::size_t>(n), std::vector<double>(static_cast<std::size_t>(n)));
    for (auto& line : g) {
      const double unit = std::pow(10, draw(-1, 1));
      for (double& x : line) x = unit * draw(-1, 1);
    }
    solver::WorkBudget budget;
    solver::BoxedLcp box(budget);
    box.reset(n);
    std::vector<double> residuals;
    std::vector<double> start_impulses;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n; ++k) {
        double sum = i == k ? 0.01 : 0;
        for (int m = 0; m < n; ++m) {
          sum += g[static_cast<std::size_t>(i)][static_cast<std::size_t>(m)] *
                 g[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
        }
        box.response(i, k) = sum;
      }
      solver::BoxedLcp::Row& r = box.row(i);
      r.residual = draw(-2, 2);
      const int kind = i % 4;
      r.lower = kind == 0 ? 0 : (kind == 1 ? -1e18 : draw(-1, 0));
      r.upper = kind <= 1 ? 1e18 : draw(0, 1);
      r.impulse = kind <= 1 ? 0 : draw(r.lower, r.upper);
      residuals.push_back(r.residual);
      start_impulses.push_back(r.impulse);
    }
    EXPECT_LE(box.solve(1e-7), 1e-5) << seed;
    EXPECT_LT(largest_violation(box, residuals, start_impulses), 1e-5) << seed;
    // the same from other impulses, with wrong initial statuses
    for (int i = 0; i < n; ++i) {
      box.row(i).impulse = start_impulses[static_cast<std::size_t>(i)];
      box.row(i).initial_change = draw(-3, 3);
      box.row(i).initial_status = i % 2 == 0 ? solver::BoxedLcp::at_lower : solver::BoxedLcp::free;
    }
    EXPECT_LE(box.solve(1e-7), 1e-5) << seed;
    EXPECT_LT(largest_violation(box, residuals, start_impulses), 1e-5) << seed;
  }
}

// A block of 2 kg that would penetrate at 1 m/s and slides at 3 m/s: its contact needs 2 N·s, and friction brakes with
// up to 0.5·2 N·s to 3 m/s - 0.5·2/2 m/s, or to 0 if the coefficient is large enough.
TEST(BoxedLcp, BoundsFrictionByItsNormal) {
  for (const double friction : {0.5, 2.0}) {
    solver::WorkBudget budget;
    solver::BoxedLcp box(budget);
    box.reset(2);
    box.response(0, 0) = box.response(1, 1) = 0.5;
    box.row(0) = {1, 0, 0, 1e18, -1, 0};
    box.row(1) = {-3, 0, 0, 0, 0, friction};
    EXPECT_LE(box.solve(1e-9), 1e-9);
    EXPECT_NEAR(box.row(0).impulse, 2, 1e-6);
    EXPECT_NEAR(box.row(1).impulse, -std::min(2 * friction, 6.0), 1e-6);
  }
}

// Four points that bear one load: any distribution is a solution, and the sum is the load.
TEST(BoxedLcp, SolvesDependentRows) {
  solver::WorkBudget budget;
  solver::BoxedLcp box(budget);
  box.reset(4);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) box.response(i, k) = 0.25;
    box.row(i) = {1, 0, 0, 1e18, -1, 0};
  }
  EXPECT_LE(box.solve(1e-9), 1e-9);
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += box.row(i).impulse;
  EXPECT_NEAR(sum, 4, 1e-6);
}

// Sets up eight contacts with friction of a machine with six axes. Returns the residuals.
std::vector<double> set_up_contacts(solver::BoxedLcp& box, unsigned seed) {
  constexpr int kContacts = 8;
  constexpr int kAxes = 6;
  std::mt19937 generator(seed);
  const auto draw = [&] { return static_cast<double>(generator()) / 2147483648.0 - 1; };
  double jacobian[3 * kContacts][kAxes];
  double rates[kAxes];
  for (auto& row : jacobian) {
    for (double& x : row) x = draw();
  }
  for (double& x : rates) x = draw();
  box.reset(3 * kContacts);
  std::vector<double> residuals;
  for (int i = 0; i < box.size(); ++i) {
    for (int k = 0; k < box.size(); ++k) {
      box.response(i, k) = i == k ? 1e-3 : 0;
      for (int m = 0; m < kAxes; ++m) box.response(i, k) += jacobian[i][m] * jacobian[k][m];
    }
    solver::BoxedLcp::Row& r = box.row(i);
    for (int m = 0; m < kAxes; ++m) r.residual -= jacobian[i][m] * rates[m];
    residuals.push_back(r.residual);
    if (i < kContacts) {
      r.upper = 1e18;
    } else {
      r.normal = i % kContacts;
      r.friction = 2;
    }
  }
  return residuals;
}

// Alternating rounds of friction and normals don't converge in one of twenty problems, although each has a solution
// (Anitescu and Potra 1997).
TEST(BoxedLcp, FrictionConverges) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    solver::WorkBudget budget;
    solver::BoxedLcp box(budget);
    const std::vector<double> residuals = set_up_contacts(box, seed);
    EXPECT_LE(box.solve(1e-7), 1e-7) << seed;
    EXPECT_TRUE(box.friction_converged()) << seed;
    EXPECT_LT(largest_violation(box, residuals, std::vector<double>(residuals.size(), 0)), 1e-6) << seed;
  }
}

// Once the budget is exceeded, the tolerance of a row is 0.01; if friction doesn't converge, refine_friction() reduces
// the violation.
TEST(BoxedLcp, ApproximatesBeyondTheBudget) {
  int unconverged = 0;
  int accurate = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    solver::WorkBudget budget;
    solver::BoxedLcp box(budget);
    const std::vector<double> residuals = set_up_contacts(box, seed);
    const std::vector<double> start_impulses(residuals.size(), 0);
    budget.set_limit(0);
    budget.charge(1, 1);
    const double reported = box.solve(1e-7);
    double violation = largest_violation(box, residuals, start_impulses, box.friction_converged());
    if (box.friction_converged()) {
      EXPECT_NEAR(reported, violation, 1e-6) << seed;
    } else {
      unconverged++;
      for (int i = 0; i < box.size(); ++i) {
        double residual = residuals[static_cast<std::size_t>(i)];
        for (int k = 0; k < box.size(); ++k) residual -= box.response(i, k) * box.row(k).impulse;
        box.row(i).residual = residual;
      }
      const double before = violation;
      const double refined = box.refine_friction();
      violation = largest_violation(box, residuals, start_impulses, refined < before);
      EXPECT_NEAR(refined, violation, 1e-6) << seed;
      EXPECT_LE(violation, before) << seed;
    }
    if (violation <= 1e-2 * (1 + 1e-6)) accurate++;
  }
  EXPECT_GE(unconverged, 20);
  EXPECT_GE(accurate, 170);
}

// Three of five rows existed before: the responses between them are preserved, and the outer products of two vectors
// are added to all.
TEST(BoxedLcp, AddsRowsAndOuterProducts) {
  solver::WorkBudget budget;
  solver::BoxedLcp box(budget);
  box.reset(3);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) box.response(i, k) = 10 * (i + 1) * (k + 1);
  }
  const std::vector<int> from{0, -1, 1, -1, 2};
  box.remap(from);
  ASSERT_EQ(box.size(), 5);
  // six elements of rows, padded; elements behind the rows must be ignored
  const std::vector<double> lines{1, 2, 3, 4, 5, 0, 7, 8, 2, -1, 0, 3, 1, 0, 9, 9};
  box.add_outer_products(lines, 8);
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      const auto n = [](int row) { return static_cast<std::size_t>(row); };
      const bool existed = from[n(i)] >= 0 && from[n(k)] >= 0;
      const double before = existed ? 10.0 * (from[n(i)] + 1) * (from[n(k)] + 1) : 0;
      EXPECT_EQ(box.response(i, k), before + lines[n(i)] * lines[n(k)] + lines[n(8 + i)] * lines[n(8 + k)]) << i << k;
    }
  }
}

}  // namespace
}  // namespace limber::sim

// The box solver against its laws, on random problems, and against a block on the floor.
#include "sim/box_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limber {
namespace {

// What the rows miss, calculated anew from the whole matrix. Where friction and normals need not agree, a row beyond
// its bounds misses its law; else it must not be there.
double missed(BoxSolver& box, const std::vector<double>& left, const std::vector<double>& begun, bool agrees = true) {
  double most = 0;
  for (int i = 0; i < box.size(); ++i) {
    const BoxSolver::Row& r = box.row(i);
    double rest = left[static_cast<std::size_t>(i)];
    for (int k = 0; k < box.size(); ++k) {
      rest -= box.response(i, k) * (box.row(k).impulse - begun[static_cast<std::size_t>(k)]);
    }
    double lower = r.lower;
    double upper = r.upper;
    if (r.normal >= 0) {
      upper = r.friction * std::max(box.row(r.normal).impulse, 0.0);
      if (r.most > 0) upper = std::min(upper, r.most);
      lower = -upper;
    }
    if (agrees) {
      EXPECT_GE(r.impulse, lower - 1e-9) << i;
      EXPECT_LE(r.impulse, upper + 1e-9) << i;
    }
    const double own = box.response(i, i);
    most = std::max(most, std::fabs(std::clamp(r.impulse + rest / own, lower, upper) - r.impulse) * own);
  }
  return most;
}

TEST(BoxSolver, MeetsEveryLawOfRandomProblems) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 generator(seed);
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(generator);
    };
    const int n = 1 + static_cast<int>(seed % 25);
    // response = G·G' + a little, units far apart
    std::vector<std::vector<double>> g(static_cast<std::size_t>(n), std::vector<double>(static_cast<std::size_t>(n)));
    for (auto& line : g) {
      const double unit = std::pow(10, draw(-1, 1));
      for (double& x : line) x = unit * draw(-1, 1);
    }
    Effort effort;
    BoxSolver box(effort);
    box.start(n);
    std::vector<double> left;
    std::vector<double> begun;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n; ++k) {
        double sum = i == k ? 0.01 : 0;
        for (int m = 0; m < n; ++m) {
          sum += g[static_cast<std::size_t>(i)][static_cast<std::size_t>(m)] *
                 g[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
        }
        box.response(i, k) = sum;
      }
      BoxSolver::Row& r = box.row(i);
      r.left = draw(-2, 2);
      const int kind = i % 4;
      r.lower = kind == 0 ? 0 : (kind == 1 ? -1e18 : draw(-1, 0));
      r.upper = kind <= 1 ? 1e18 : draw(0, 1);
      r.impulse = kind <= 1 ? 0 : draw(r.lower, r.upper);
      left.push_back(r.left);
      begun.push_back(r.impulse);
    }
    EXPECT_LE(box.solve(1e-7), 1e-5) << seed;
    EXPECT_LT(missed(box, left, begun), 1e-5) << seed;
    // the same from elsewhere, with wrong guesses of where rows stand
    for (int i = 0; i < n; ++i) {
      box.row(i).impulse = begun[static_cast<std::size_t>(i)];
      box.row(i).ahead = draw(-3, 3);
      box.row(i).guess = i % 2 == 0 ? BoxSolver::at_lower : BoxSolver::free;
    }
    EXPECT_LE(box.solve(1e-7), 1e-5) << seed;
    EXPECT_LT(missed(box, left, begun), 1e-5) << seed;
  }
}

// A block of mass 2 kg that would sink at 1 m/s and slides at 3 m/s; its contact holds with 2 N·s and brakes with
// friction's part of it: 3 m/s - 0.5·2/2 m/s are left, or nothing where friction can do more.
TEST(BoxSolver, FrictionFollowsItsNormal) {
  for (const double friction : {0.5, 2.0}) {
    Effort effort;
    BoxSolver box(effort);
    box.start(2);
    box.response(0, 0) = box.response(1, 1) = 0.5;
    box.row(0) = {1, 0, 0, 1e18, -1, 0, 0};
    box.row(1) = {-3, 0, 0, 0, 0, friction, 0};
    EXPECT_LE(box.solve(1e-9), 1e-9);
    EXPECT_NEAR(box.row(0).impulse, 2, 1e-6);
    EXPECT_NEAR(box.row(1).impulse, -std::min(2 * friction, 6.0), 1e-6);
  }
  Effort effort;
  BoxSolver box(effort);
  box.start(2);
  box.response(0, 0) = box.response(1, 1) = 0.5;
  box.row(0) = {1, 0, 0, 1e18, -1, 0, 0};
  box.row(1) = {-3, 0, 0, 0, 0, 0.5, 0.3};
  box.solve(1e-9);
  EXPECT_NEAR(box.row(1).impulse, -0.3, 1e-6);  // its own bound is less
}

// Four points that bear one load: any share will do, the sum is the load's.
TEST(BoxSolver, RowsThatDependOnEachOtherShare) {
  Effort effort;
  BoxSolver box(effort);
  box.start(4);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) box.response(i, k) = 0.25;
    box.row(i) = {1, 0, 0, 1e18, -1, 0, 0};
  }
  EXPECT_LE(box.solve(1e-9), 1e-9);
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += box.row(i).impulse;
  EXPECT_NEAR(sum, 4, 1e-6);
}

// Eight contacts of a machine of six axes, rough; returns what is left of each row.
std::vector<double> touch(BoxSolver& box, unsigned seed) {
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
  box.start(3 * kContacts);
  std::vector<double> left;
  for (int i = 0; i < box.size(); ++i) {
    for (int k = 0; k < box.size(); ++k) {
      box.response(i, k) = i == k ? 1e-3 : 0;
      for (int m = 0; m < kAxes; ++m) box.response(i, k) += jacobian[i][m] * jacobian[k][m];
    }
    BoxSolver::Row& r = box.row(i);
    for (int m = 0; m < kAxes; ++m) r.left -= jacobian[i][m] * rates[m];
    left.push_back(r.left);
    if (i < kContacts) {
      r.upper = 1e18;
    } else {
      r.normal = i % kContacts;
      r.friction = 2;
    }
  }
  return left;
}

// Rounds of friction and normals by turns agree on nothing in one of twenty, and yet each has a solution (Anitescu and
// Potra 1997).
TEST(BoxSolver, FrictionAndNormalsAgreeInTheEnd) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Effort effort;
    BoxSolver box(effort);
    const std::vector<double> left = touch(box, seed);
    EXPECT_LE(box.solve(1e-7), 1e-7) << seed;
    EXPECT_TRUE(box.agrees()) << seed;
    EXPECT_LT(missed(box, left, std::vector<double>(left.size(), 0)), 1e-6) << seed;
  }
}

// With no time left a row may miss its law by a hundredth; where friction and normals do not agree even so, they come
// nearer to each other.
TEST(BoxSolver, WithNoTimeLeftLawsAreNearlyMet) {
  int apart = 0;
  int met = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Effort effort;
    BoxSolver box(effort);
    const std::vector<double> left = touch(box, seed);
    const std::vector<double> begun(left.size(), 0);
    effort.allow(0);
    effort.lines(1, 1);
    const double told = box.solve(1e-7);
    double now = missed(box, left, begun, box.agrees());
    if (box.agrees()) {
      EXPECT_NEAR(told, now, 1e-6) << seed;
    } else {
      apart++;
      for (int i = 0; i < box.size(); ++i) {
        double rest = left[static_cast<std::size_t>(i)];
        for (int k = 0; k < box.size(); ++k) rest -= box.response(i, k) * box.row(k).impulse;
        box.row(i).left = rest;
      }
      const double before = now;
      const double polished = box.polish();
      now = missed(box, left, begun, polished < before);
      EXPECT_NEAR(polished, now, 1e-6) << seed;
      EXPECT_LE(now, before) << seed;
    }
    if (now <= 1e-2 * (1 + 1e-6)) met++;
  }
  EXPECT_GE(apart, 20);
  EXPECT_GE(met, 170);
}

// Three rows of five were there: between them responses stay, and the squares of two lines come on top of all.
TEST(BoxSolver, GrowsByRowsAndSquares) {
  Effort effort;
  BoxSolver box(effort);
  box.start(3);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) box.response(i, k) = 10 * (i + 1) * (k + 1);
  }
  const std::vector<int> from{0, -1, 1, -1, 2};
  box.grow(from);
  ASSERT_EQ(box.size(), 5);
  // as wide as three pairs, and what is behind the rows is another's
  const std::vector<double> lines{1, 2, 3, 4, 5, 0, 7, 8, 2, -1, 0, 3, 1, 0, 9, 9};
  box.add_squares(lines, 8);
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      const auto n = [](int row) { return static_cast<std::size_t>(row); };
      const bool were = from[n(i)] >= 0 && from[n(k)] >= 0;
      const double before = were ? 10.0 * (from[n(i)] + 1) * (from[n(k)] + 1) : 0;
      EXPECT_EQ(box.response(i, k), before + lines[n(i)] * lines[n(k)] + lines[n(8 + i)] * lines[n(8 + k)]) << i << k;
    }
  }
}

}  // namespace
}  // namespace limber

// IncrementalLdlt: changes the selection repeatedly and compares each solution with the matrix itself.
#include "sim/solver/lcp/incremental_ldlt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limber::sim {
namespace {

// Returns G·G' + a small diagonal, with one row and its column set to zero.
std::vector<double> positive_matrix(int n, int stride, std::mt19937& generator, int zero_row) {
  std::uniform_real_distribution<double> draw(-1, 1);
  const auto at = [&](int i, int k) {
    const int place = i * stride + k;
    return static_cast<std::size_t>(place);
  };
  std::vector<double> g(static_cast<std::size_t>(n * stride));
  for (double& x : g) x = draw(generator);
  std::vector<double> out(g.size(), 0);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      if (i == zero_row || k == zero_row) continue;
      if (i == k) out[at(i, k)] = 0.1;
      for (int m = 0; m < n; ++m) out[at(i, k)] += g[at(i, m)] * g[at(k, m)];
    }
  }
  return out;
}

TEST(IncrementalLdlt, SolvesForAnySelection) {
  constexpr int kRows = 15;
  constexpr int kStride = 16;
  constexpr int kZeroRow = 7;
  std::mt19937 generator(3);
  const std::vector<double> matrix = positive_matrix(kRows, kStride, generator, kZeroRow);
  solver::WorkBudget budget;
  solver::IncrementalLdlt factor(budget);
  factor.reset(matrix, kStride);
  std::vector<unsigned char> free(kRows, 0);
  int rejected = 0;
  for (int round = 0; round < 400; ++round) {
    // few rows change at a time, so that most of the factor is reused
    for (unsigned change = generator() % 4; change > 0; --change) free[generator() % kRows] ^= 1;
    const bool positive = factor.select(free, kRows);
    EXPECT_EQ(positive, free[kZeroRow] == 0) << round;
    rejected += positive ? 0 : 1;
    if (!positive) continue;
    const std::vector<int> rows(factor.rows().begin(), factor.rows().end());
    EXPECT_EQ(static_cast<long>(rows.size()), std::count(free.begin(), free.end(), 1)) << round;
    std::vector<double> rates(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rates[i] = std::sin(1.0 * rows[i] + round);
    std::vector<double> impulses = rates;
    factor.solve(impulses);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      double rate = 0;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        const int place = rows[i] * kStride + rows[k];
        rate += matrix[static_cast<std::size_t>(place)] * impulses[k];
      }
      EXPECT_NEAR(rate, rates[i], 1e-9) << "round " << round << ", row " << rows[i];
    }
  }
  EXPECT_GT(rejected, 0);
}

TEST(IncrementalLdlt, RejectsTooManyRows) {
  const std::vector<double> matrix{2, 1, 1, 2};
  solver::WorkBudget budget;
  solver::IncrementalLdlt factor(budget);
  factor.reset(matrix, 2);
  EXPECT_FALSE(factor.select(std::vector<unsigned char>{1, 1}, 1));
  ASSERT_TRUE(factor.select(std::vector<unsigned char>{0, 1}, 1));
  std::vector<double> one{3};
  factor.solve(one);
  EXPECT_DOUBLE_EQ(one[0], 1.5);
}

}  // namespace
}  // namespace limber::sim

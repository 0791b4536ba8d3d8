// Random: the first values of the published algorithm, and the distributions of its results.
#include "base/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace limber {
namespace {

// Computed separately with xoshiro256starstar.c, with a state from splitmix64(seed ^ FNV(name)).
TEST(Random, FirstValuesMatchTheReference) {
  Random plain(1);
  for (const std::uint64_t v :
       {2312103631333294758u, 8577403155483897535u, 7773481203680439003u, 7839922785415594646u}) {
    EXPECT_EQ(plain.next(), v);
  }
  Random named(1, "arm1");
  for (const std::uint64_t v :
       {1601237027680080070u, 2418392151390440779u, 18183815349873040251u, 3301167208230712955u}) {
    EXPECT_EQ(named.next(), v);
  }
}

TEST(Random, EqualSeedsRepeatAndNamesDiffer) {
  Random a(7, "arm1");
  Random b(7, "arm1");
  Random c(7, "arm2");
  Random d(8, "arm1");
  int equal = 0;
  for (int i = 0; i < 1000; i++) {
    const std::uint64_t v = a.next();
    EXPECT_EQ(v, b.next());
    equal += (v == c.next() ? 1 : 0) + (v == d.next() ? 1 : 0);
  }
  EXPECT_EQ(equal, 0);
  EXPECT_EQ(a.state(), b.state());
  EXPECT_NE(a.state(), c.state());
}

double chi_square(const std::vector<int>& counts, double expected) {
  double sum = 0;
  for (const int n : counts) sum += (n - expected) * (n - expected) / expected;
  return sum;
}

// 99 degrees of freedom: 99.9 % of samples are between 60 and 149.
TEST(Random, UniformDrawsFillTheRangeEvenly) {
  Random random(3);
  std::vector<int> low(100);
  std::vector<int> high(100);
  for (int i = 0; i < 100000; i++) {
    const double v = random.uniform(-2, 3);
    ASSERT_GE(v, -2);
    ASSERT_LT(v, 3);
    low[static_cast<std::size_t>((v + 2) * 20)]++;
    // The lower digits must be uniform too.
    const double fine = random.uniform() * 1000;
    high[static_cast<std::size_t>((fine - std::floor(fine)) * 100)]++;
  }
  for (const std::vector<int>& counts : {low, high}) {
    EXPECT_GT(chi_square(counts, 1000), 60);
    EXPECT_LT(chi_square(counts, 1000), 149);
  }
}

TEST(Random, NormalDrawsHaveMeanZeroAndVarianceOne) {
  Random random(4);
  const int n = 100000;
  double sum = 0;
  double square = 0;
  double fourth = 0;
  int within = 0;
  for (int i = 0; i < n; i++) {
    const double v = random.normal();
    ASSERT_TRUE(std::isfinite(v));
    sum += v;
    square += v * v;
    fourth += v * v * v * v;
    within += std::abs(v) < 1 ? 1 : 0;
  }
  // four standard errors: 4/sqrt(n), 4·sqrt(2/n), 4·sqrt(96/n), 4·sqrt(0.217/n)
  EXPECT_NEAR(sum / n, 0, 0.0127);
  EXPECT_NEAR(square / n, 1, 0.0179);
  EXPECT_NEAR(fourth / n, 3, 0.124);
  EXPECT_NEAR(static_cast<double>(within) / n, 0.682689, 0.006);
}

TEST(Random, DirectionsAreUnitVectorsSpreadOverTheSphere) {
  Random random(5);
  const int n = 80000;
  std::vector<int> octants(8);
  Vec3 mean(0);
  Vec3 square(0);
  for (int i = 0; i < n; i++) {
    const Vec3 d = random.direction();
    ASSERT_NEAR(glm::length(d), 1, 1e-12);
    mean += d / static_cast<double>(n);
    square += d * d / static_cast<double>(n);
    octants[(d.x > 0 ? 1U : 0U) + (d.y > 0 ? 2U : 0U) + (d.z > 0 ? 4U : 0U)]++;
  }
  // each coordinate is uniform in -1 .. 1: mean 0, mean square 1/3; four standard errors
  for (int i = 0; i < 3; i++) {
    EXPECT_NEAR(mean[i], 0, 0.0082);
    EXPECT_NEAR(square[i], 1.0 / 3, 0.0043);
  }
  EXPECT_LT(chi_square(octants, n / 8.0), 24.3);  // 7 degrees of freedom, 99.9 %
}

}  // namespace
}  // namespace limber

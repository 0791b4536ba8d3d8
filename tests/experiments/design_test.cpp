// Points of designs.
#include "experiments/design.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace limber::experiments::test {
namespace {

Axis range(const char* name, double min, double max) { return {name, min, max, {}, false, {}}; }
Axis list(const char* name, std::vector<double> values) {
  const auto [min, max] = std::ranges::minmax(values);
  return {name, min, max, values, true, {}};
}

TEST(Design, GridHasAllCombinationsTheLastFastest) {
  const Result<Design> design = Design::create(DesignKind::grid, {list("a", {1, 2}), list("b", {10, 20, 30})}, 0, 1);
  ASSERT_TRUE(design.ok());
  ASSERT_EQ(design->size(), 6u);
  using Point = std::vector<double>;
  EXPECT_EQ(design->point(0), (Point{1, 10}));
  EXPECT_EQ(design->point(2), (Point{1, 30}));
  EXPECT_EQ(design->point(3), (Point{2, 10}));
  EXPECT_EQ(design->point(5), (Point{2, 30}));
}

TEST(Design, LatinHypercubeHasOnePointPerInterval) {
  constexpr std::uint64_t kPoints = 50;
  const Result<Design> design =
      Design::create(DesignKind::latin, {range("a", 0, 1), range("b", -1, 3), range("c", 5, 6)}, kPoints, 7);
  ASSERT_TRUE(design.ok());
  for (std::size_t axis = 0; axis < 3; axis++) {
    const Axis& a = design->axes()[axis];
    std::set<int> intervals;
    for (std::uint64_t n = 0; n < kPoints; n++)
      intervals.insert(static_cast<int>(std::floor((design->point(n)[axis] - a.min) / (a.max - a.min) * kPoints)));
    EXPECT_EQ(intervals.size(), kPoints);
    EXPECT_EQ(*intervals.begin(), 0);
    EXPECT_EQ(*intervals.rbegin(), static_cast<int>(kPoints) - 1);
  }
}

// The first points of Joe and Kuo's program `sobol` with new-joe-kuo-6.
TEST(Design, SobolPointsAreThePublishedOnes) {
  const double expected[][3] = {{0, 0, 0},
                                {0.5, 0.5, 0.5},
                                {0.75, 0.25, 0.25},
                                {0.25, 0.75, 0.75},
                                {0.375, 0.375, 0.625},
                                {0.875, 0.875, 0.125},
                                {0.625, 0.125, 0.875},
                                {0.125, 0.625, 0.375},
                                {0.1875, 0.3125, 0.9375},
                                {0.6875, 0.8125, 0.4375}};
  for (std::uint64_t n = 0; n < 10; n++) {
    for (std::size_t axis = 0; axis < 3; axis++) EXPECT_EQ(sobol_coordinate(axis, n), expected[n][axis]) << n;
  }
}

// Each axis alone is a permutation of the multiples of 2^-k, for the first 2^k points.
TEST(Design, SobolAxesAreStratified) {
  constexpr std::uint64_t kPoints = 1024;
  for (std::size_t axis = 0; axis < Design::kMaxSobolAxes; axis++) {
    std::set<double> seen;
    for (std::uint64_t n = 0; n < kPoints; n++) {
      const double scaled = sobol_coordinate(axis, n) * kPoints;
      EXPECT_EQ(scaled, std::floor(scaled));
      seen.insert(scaled);
    }
    EXPECT_EQ(seen.size(), kPoints) << axis;
  }
}

// Any two axes differ: the mean of the product of independent uniform numbers is 1/4.
TEST(Design, SobolAxesAreIndependent) {
  constexpr std::uint64_t kPoints = 4096;
  for (std::size_t a = 0; a < Design::kMaxSobolAxes; a++) {
    for (std::size_t b = a + 1; b < Design::kMaxSobolAxes; b++) {
      double sum = 0;
      for (std::uint64_t n = 0; n < kPoints; n++) sum += sobol_coordinate(a, n) * sobol_coordinate(b, n);
      EXPECT_NEAR(sum / kPoints, 0.25, 0.0005) << a << " " << b;
    }
  }
}

TEST(Design, RandomPointsDependOnTheSeedAndTheNumberAlone) {
  const auto create = [](std::uint64_t seed) {
    return *Design::create(DesignKind::random, {range("a", 0, 1), range("b", 2, 4)}, 1000, seed);
  };
  const Design design = create(1);
  const std::vector<double> later = design.point(500);
  EXPECT_EQ(create(1).point(500), later);
  EXPECT_NE(create(2).point(500), later);
  double mean = 0;
  for (std::uint64_t n = 0; n < 1000; n++) {
    const double b = design.point(n)[1];
    EXPECT_GE(b, 2);
    EXPECT_LE(b, 4);
    mean += b / 1000;
  }
  EXPECT_NEAR(mean, 3, 4 * 2 / std::sqrt(12.0 * 1000));  // four standard errors
}

TEST(Design, Errors) {
  const auto error = [](DesignKind kind, std::vector<Axis> axes, std::uint64_t samples) {
    const Result<Design> design = Design::create(kind, std::move(axes), samples, 1);
    return design ? "" : design.error();
  };
  EXPECT_NE(error(DesignKind::grid, {range("a", 0, 1)}, 0).find("--param a=0:1/5"), std::string::npos);
  EXPECT_NE(error(DesignKind::random, {range("a", 0, 1)}, 0).find("--samples"), std::string::npos);
  EXPECT_NE(error(DesignKind::random, {range("a", 0, 1)}, Design::kMaxPoints + 1).find("more than"), std::string::npos);
  EXPECT_NE(error(DesignKind::sobol, std::vector<Axis>(22, range("a", 0, 1)), 8).find("latin"), std::string::npos);
  std::vector<double> many(1000);
  EXPECT_NE(error(DesignKind::grid, {list("a", many), list("b", many), list("c", many)}, 0).find("more than"),
            std::string::npos);
}

}  // namespace
}  // namespace limber::experiments::test

// CMA-ES on standard functions.
#include "experiments/cma_es.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"

namespace limber::experiments::test {
namespace {

using Vector = CmaEs::Vector;
using Function = std::function<double(const Vector&)>;

double sphere(const Vector& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return sum;
}

double rosenbrock(const Vector& x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); i++)
    sum += 100 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1 - x[i], 2);
  return sum;
}

/// An ellipsoid with a condition number of 10^6, rotated by a random orthogonal matrix (Gram and Schmidt).
class RotatedEllipsoid {
 public:
  explicit RotatedEllipsoid(std::size_t n) {
    Random random(3, "rotation");
    for (std::size_t i = 0; i < n; i++) {
      Vector row(n);
      for (double& v : row) v = random.normal();
      for (const Vector& other : rows_) {
        double along = 0;
        for (std::size_t k = 0; k < n; k++) along += row[k] * other[k];
        for (std::size_t k = 0; k < n; k++) row[k] -= along * other[k];
      }
      const double length = std::sqrt(sphere(row));
      for (double& v : row) v /= length;
      rows_.push_back(row);
    }
  }
  double operator()(const Vector& x) const {
    double sum = 0;
    for (std::size_t i = 0; i < rows_.size(); i++) {
      double along = 0;
      for (std::size_t k = 0; k < x.size(); k++) along += rows_[i][k] * x[k];
      sum += std::pow(10, 6.0 * static_cast<double>(i) / static_cast<double>(rows_.size() - 1)) * along * along;
    }
    return sum;
  }

 private:
  std::vector<Vector> rows_;
};

/// Number of evaluations until the function is below the target; the limit if it is never reached.
std::size_t evaluations(const Function& function, CmaEs es, double target, std::size_t limit) {
  std::size_t count = 0;
  while (count < limit) {
    const std::vector<Vector> individuals = es.ask();
    Vector values;
    for (const Vector& x : individuals) values.push_back(function(x));
    count += individuals.size();
    es.tell(individuals, values);
    if (*std::ranges::min_element(values) < target) return count;
  }
  return limit;
}

/// Median over nine seeds.
std::size_t median_evaluations(const Function& function, std::size_t n, double start, double sigma, double target) {
  std::vector<std::size_t> counts;
  for (std::uint64_t seed = 1; seed <= 9; seed++)
    counts.push_back(evaluations(function, CmaEs(Vector(n, start), sigma, seed), target, 100'000));
  std::ranges::sort(counts);
  return counts[4];
}

// Bounds from the literature, in ten dimensions: Hansen, Müller and Koumoutsakos (2003), figures 3 and 5, need about
// 2e3 evaluations for the sphere, 6e3 to 7e3 for the ellipsoid, and 6e3 to 8e3 for Rosenbrock's function, to 1e-10.
TEST(CmaEs, NeedsAsManyEvaluationsAsPublished) {
  EXPECT_LT(median_evaluations(sphere, 10, 1, 1, 1e-10), 2200u);
  EXPECT_GT(median_evaluations(sphere, 10, 1, 1, 1e-10), 1000u);
  EXPECT_LT(median_evaluations(RotatedEllipsoid(10), 10, 1, 1, 1e-10), 7500u);
  EXPECT_LT(median_evaluations(rosenbrock, 10, 0, 0.1, 1e-10), 9000u);
}

// The search uses ranks only and is invariant under rotation: an axis-parallel ellipsoid is no easier.
TEST(CmaEs, IsInvariantUnderMonotoneTransformations) {
  const auto run = [](const Function& function) {
    CmaEs es(Vector(5, 1.0), 0.5, 4);
    for (int i = 0; i < 50; i++) {
      const std::vector<Vector> individuals = es.ask();
      Vector values;
      for (const Vector& x : individuals) values.push_back(function(x));
      es.tell(individuals, values);
    }
    return es.mean();
  };
  EXPECT_EQ(run(sphere), run([](const Vector& x) { return std::log(sphere(x)) * 7 - 3; }));
}

TEST(CmaEs, FailedIndividualsAreTheWorst) {
  CmaEs a(Vector(3, 1.0), 0.5, 4);
  CmaEs b = a;
  const std::vector<Vector> individuals = a.ask();
  Vector values;
  for (const Vector& x : individuals) values.push_back(sphere(x));
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
  a.tell(individuals, values);
  values[worst] = std::nan("");
  b.tell(individuals, values);
  EXPECT_EQ(a.mean(), b.mean());
}

TEST(CmaEs, ContinuesFromItsSavedStateWithTheSameBits) {
  CmaEs es(Vector(4, 0.3), 0.2, 11);
  for (int i = 0; i < 30; i++) {
    const Result<CmaEs> restored = CmaEs::restore(es.save());
    ASSERT_TRUE(restored.ok());
    const std::vector<Vector> individuals = es.ask();
    ASSERT_EQ(restored->ask(), individuals);
    Vector values;
    for (const Vector& x : individuals) values.push_back(rosenbrock(x));
    es.tell(individuals, values);
    if (i % 2 == 1) es = *restored, es.tell(individuals, values);
  }
  for (const char* wrong : {"", "{}", "[]", "{\"population\":4}"}) EXPECT_FALSE(CmaEs::restore(wrong).ok()) << wrong;
}

TEST(CmaEs, EigenvectorsDiagonalizeAMatrix) {
  constexpr std::size_t n = 6;
  Random random(2, "matrix");
  std::vector<double> a(n * n);
  for (std::size_t i = 0; i < n; i++) {
    for (std::size_t j = 0; j <= i; j++) a[i * n + j] = a[j * n + i] = random.normal();
  }
  std::vector<double> values;
  std::vector<double> vectors;
  symmetric_eigen(a, n, values, vectors);
  for (std::size_t k = 0; k < n; k++) {
    for (std::size_t i = 0; i < n; i++) {
      double product = 0;
      for (std::size_t j = 0; j < n; j++) product += a[i * n + j] * vectors[j * n + k];
      EXPECT_NEAR(product, values[k] * vectors[i * n + k], 1e-12);
    }
  }
}

}  // namespace
}  // namespace limber::experiments::test

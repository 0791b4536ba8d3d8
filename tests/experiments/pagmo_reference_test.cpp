// CMA-ES and NSGA-II against those of pagmo (Biscani, Izzo 2020) on standard functions.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/problems/rosenbrock.hpp>
#include <pagmo/problems/zdt.hpp>
#include <pagmo/utils/hypervolume.hpp>

#include "experiments/cma_es.h"
#include "experiments/nsga2.h"

namespace limber::experiments::test {
namespace {

using Vector = std::vector<double>;

constexpr std::size_t kSeeds = 5;
constexpr double kTarget = 1e-8;
constexpr std::size_t kEvaluations = 30'000;

template <class Value>
Value median(std::vector<Value> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

std::size_t our_evaluations(const pagmo::problem& problem, double start, double sigma, std::uint64_t seed) {
  CmaEs es(Vector(10, start), sigma, seed);
  std::size_t count = 0;
  while (count < kEvaluations) {
    const std::vector<Vector> individuals = es.ask();
    Vector values;
    for (const Vector& x : individuals) values.push_back(problem.fitness(x)[0]);
    count += individuals.size();
    if (*std::ranges::min_element(values) < kTarget) break;
    es.tell(individuals, values);
  }
  return count;
}

std::size_t pagmo_evaluations(const pagmo::problem& problem, double start, double sigma, unsigned seed) {
  const std::size_t size = CmaEs(Vector(10, start), sigma, 1).population();
  pagmo::population population(problem, 0, seed);
  for (std::size_t i = 0; i < size; i++) population.push_back(Vector(10, start));
  // no tolerances, memory of earlier calls
  pagmo::algorithm algorithm{pagmo::cmaes(1, -1, -1, -1, -1, sigma, 0, 0, true, false, seed)};
  std::size_t count = 0;
  while (count < kEvaluations && population.champion_f()[0] >= kTarget) {
    population = algorithm.evolve(population);
    count += size;
  }
  return count;
}

// The number of evaluations until the target is within a quarter of that of pagmo's CMA-ES.
TEST(PagmoReference, CmaEsNeedsAsManyEvaluations) {
  const auto expect_as_many = [](const pagmo::problem& problem, double start, double sigma) {
    std::vector<std::size_t> ours;
    std::vector<std::size_t> theirs;
    for (unsigned seed = 1; seed <= kSeeds; seed++) {
      ours.push_back(our_evaluations(problem, start, sigma, seed));
      theirs.push_back(pagmo_evaluations(problem, start, sigma, seed));
    }
    EXPECT_LT(median(theirs), kEvaluations);
    EXPECT_LT(static_cast<double>(median(ours)), 1.25 * static_cast<double>(median(theirs))) << problem.get_name();
  };
  expect_as_many(pagmo::problem{pagmo::rosenbrock(10)}, 0, 0.3);
  // a quadratic bowl with its optimum at 0
  struct Bowl {
    Vector fitness(const Vector& x) const {
      double sum = 0;
      for (std::size_t i = 0; i < x.size(); i++) sum += static_cast<double>(1 + i * i) * x[i] * x[i];
      return {sum};
    }
    std::pair<Vector, Vector> get_bounds() const { return {Vector(10, -5.0), Vector(10, 5.0)}; }
  };
  expect_as_many(pagmo::problem{Bowl{}}, 2, 1);
}

double hypervolume_of(const std::vector<Vector>& costs) {
  std::vector<Vector> counted;  // within the reference point
  for (const Vector& point : costs) {
    if (point[0] < 2 && point[1] < 4) counted.push_back(point);
  }
  return counted.empty() ? 0 : pagmo::hypervolume(counted).compute({2, 4});
}

double our_hypervolume(const pagmo::problem& problem, std::size_t size, std::size_t generations, std::uint64_t seed) {
  Nsga2 search({problem.get_nx(), 2, size, seed});
  std::vector<Vector> last;
  for (std::size_t i = 0; i <= generations; i++) {
    const std::vector<Vector> individuals = search.ask();
    std::vector<Vector> objectives;
    last.clear();
    for (const Vector& x : individuals) {
      last.push_back(problem.fitness(x));
      objectives.push_back({-last.back()[0], -last.back()[1]});
    }
    search.tell(individuals, objectives);
  }
  return hypervolume_of(last);
}

double pagmo_hypervolume(const pagmo::problem& problem, std::size_t size, std::size_t generations, unsigned seed) {
  const pagmo::algorithm algorithm{pagmo::nsga2(static_cast<unsigned>(generations), 0.95, 10, 0.01, 50, seed)};
  return hypervolume_of(algorithm.evolve(pagmo::population(problem, size, seed)).get_f());
}

// The hypervolume of the last generation is at least 98 % of that of pagmo's NSGA-II.
TEST(PagmoReference, Nsga2CoversAsMuchOfTheFront) {
  for (const unsigned id : {1U, 2U, 3U}) {
    const pagmo::problem problem{pagmo::zdt(id, 10)};
    std::vector<double> ours;
    std::vector<double> theirs;
    for (unsigned seed = 1; seed <= kSeeds; seed++) {
      ours.push_back(our_hypervolume(problem, 40, 100, seed));
      theirs.push_back(pagmo_hypervolume(problem, 40, 100, seed));
    }
    EXPECT_GT(median(theirs), 0);
    EXPECT_GT(median(ours), 0.98 * median(theirs)) << problem.get_name();
  }
}

}  // namespace
}  // namespace limber::experiments::test

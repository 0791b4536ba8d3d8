// The algorithms of limber-pagmo.so: against pagmo's own loops, on standard functions, resumed, and with extreme
// values.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/gaco.hpp>
#include <pagmo/algorithms/maco.hpp>
#include <pagmo/algorithms/nspso.hpp>
#include <pagmo/algorithms/pso_gen.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "base/random.h"
#include "base/system/process.h"
#include "experiments/search.h"
#include "experiments/search_module.h"

namespace limber::experiments::test {
namespace {

using Vector = Search::Vector;
using enum Search::Algorithm;

constexpr std::size_t kAxes = 5;
constexpr std::uint64_t kSeed = 3;

const LimberSearchModule* pagmo_module() {
  const auto file = std::filesystem::path(LIMBER_PROGRAM).parent_path() / "limber-pagmo.so";
  std::string reason;
  const auto function = reinterpret_cast<const LimberSearchModule* (*)()>(
      system::load_function(file.string(), kSearchModuleFunction, reason));
  EXPECT_NE(function, nullptr) << reason;
  return function == nullptr ? nullptr : function();
}

struct Case {
  const char* name;
  Search::Algorithm algorithm;
  std::size_t objectives;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

/// The costs of an individual: the distance from a point, from two points, or from three.
Vector costs(const Vector& x, std::size_t objectives) {
  Vector sums(objectives);
  for (std::size_t k = 0; k < objectives; k++) {
    for (const double position : x) {
      const double difference = position - (0.2 + 0.3 * static_cast<double>(k));
      sums[k] += difference * difference;
    }
  }
  return sums;
}

class PagmoModule : public testing::TestWithParam<Case> {
 protected:
  Search::Options options(std::size_t axes = kAxes) const {
    Search::Options made;
    made.algorithm = GetParam().algorithm;
    made.axes = axes;
    made.objectives = GetParam().objectives;
    made.seed = kSeed;
    made.module = pagmo_module();
    return made;
  }
  static void tell_next(Search& search, std::size_t objectives) {
    const std::vector<Vector> individuals = search.ask();
    std::vector<Search::Evaluated> values;
    for (const Vector& x : individuals) {
      Search::Evaluated& value = values.emplace_back();
      value.objectives = costs(x, objectives);
      for (double& objective : value.objectives) objective = -objective;
    }
    search.tell(individuals, values);
  }
};

// The problem of costs() for pagmo's own loop, and its evaluator, which records what is evaluated.
struct Problem {
  std::size_t objectives = 1;
  Vector fitness(const Vector& x) const { return costs(x, objectives); }
  Vector::size_type get_nobj() const { return objectives; }
  std::pair<Vector, Vector> get_bounds() const { return {Vector(kAxes, 0.0), Vector(kAxes, 1.0)}; }
};
struct Recorder {
  std::vector<Vector>* individuals = nullptr;
  Vector operator()(const pagmo::problem& problem, const Vector& positions) const {
    Vector all;
    for (auto at = positions.begin(); at != positions.end(); at += kAxes) {
      individuals->emplace_back(at, at + kAxes);
      const Vector fitness = problem.fitness(individuals->back());
      all.insert(all.end(), fitness.begin(), fitness.end());
    }
    return all;
  }
};

TEST_P(PagmoModule, ProposesWhatPagmosLoopDoes) {
  constexpr unsigned kGenerations = 20;
  std::vector<Vector> expected;
  const pagmo::bfe recorder{Recorder{&expected}};
  const auto evolve = [&](auto algorithm) {
    algorithm.set_bfe(recorder);
    (void)pagmo::algorithm{algorithm}.evolve(
        pagmo::population(pagmo::problem{Problem{GetParam().objectives}}, recorder, 40, kSeed));
  };
  // pagmo's defaults, but for gaco no minimal distance of costs, and an archive of 40
  if (GetParam().algorithm == gaco)
    evolve(pagmo::gaco(kGenerations, 40, 1, 0, 0, 1, 7, 100'000, 100'000, 0, false, kSeed));
  if (GetParam().algorithm == maco) evolve(pagmo::maco(kGenerations, 40, 1, 1, 7, 100'000, 0, false, kSeed));
  if (GetParam().algorithm == nspso)
    evolve(pagmo::nspso(kGenerations, 0.6, 2, 2, 1, 0.5, 60, "crowding distance", false, kSeed));
  if (GetParam().algorithm == pso) evolve(pagmo::pso_gen(kGenerations, 0.7298, 2.05, 2.05, 0.5, 5, 2, 4, false, kSeed));

  const auto search = Search::create(options());
  std::vector<Vector> proposed;
  for (unsigned i = 0; i <= kGenerations; i++) {
    const std::vector<Vector> individuals = search->ask();
    proposed.insert(proposed.end(), individuals.begin(), individuals.end());
    tell_next(*search, GetParam().objectives);
  }
  EXPECT_EQ(proposed.size(), 40u * (kGenerations + 1));
  EXPECT_EQ(proposed, expected);
}

TEST_P(PagmoModule, ApproachesTheOptimum) {
  const auto search = Search::create(options());
  while (search->generation() < 60) tell_next(*search, GetParam().objectives);
  const std::vector<Search::Elite> elites = search->elites();
  ASSERT_FALSE(elites.empty());
  if (GetParam().objectives == 1) {
    EXPECT_GT(elites.back().objectives[0], -1e-3);
    return;
  }
  // the optima are on the line from (0.2, …) to (0.5, …), or to (0.8, …)
  std::vector<double> distances;
  for (const Search::Elite& elite : elites) {
    double mean = 0;
    for (const double x : elite.individual) mean += x / kAxes;
    double sum = 0;
    for (const double x : elite.individual) sum += (x - mean) * (x - mean);
    distances.push_back(std::sqrt(sum));
  }
  std::ranges::sort(distances);
  EXPECT_LT(distances[distances.size() / 2], 0.1);
  EXPECT_GT(elites.size(), 20u);
}

TEST_P(PagmoModule, ContinuesWithTheSameBits) {
  const auto whole = Search::create(options());
  for (const std::uint64_t generation : {0u, 1u, 8u}) {
    while (whole->generation() < generation) tell_next(*whole, GetParam().objectives);
    const auto continued = Search::create(options());
    ASSERT_TRUE(continued->restore(whole->save()).ok());
    EXPECT_EQ(continued->ask(), whole->ask());
    for (int i = 0; i < 3; i++) tell_next(*continued, GetParam().objectives);
    if (generation == 8) continue;
    for (int i = 0; i < 3; i++) tell_next(*whole, GetParam().objectives);
    EXPECT_EQ(continued->ask(), whole->ask());
    EXPECT_EQ(continued->save(), whole->save());
  }
}

// Any values, and failures, keep the search going, within its bounds.
TEST_P(PagmoModule, SurvivesAnyValue) {
  Random random(1);
  for (std::size_t run = 0; run < 12; run++) {
    Search::Options made = options(1 + run % 3);
    made.population = 4 + run % 5;
    made.seed = run;
    const auto search = Search::create(made);
    for (int i = 0; i < 60; i++) {
      const std::vector<Vector> individuals = search->ask();
      const std::vector<double> kinds{0, std::nan(""), 1e300, -1e300, 1e9, random.uniform(), random.uniform()};
      const double same = kinds[random.next() % kinds.size()];
      std::vector<Search::Evaluated> values(individuals.size());
      for (std::size_t k = 0; k < individuals.size(); k++) {
        for (const double position : individuals[k]) ASSERT_TRUE(position >= 0 && position <= 1) << position;
        for (std::size_t n = 0; n < made.objectives; n++)
          values[k].objectives.push_back(i % 2 == 0 ? same : kinds[random.next() % kinds.size()]);
      }
      search->tell(individuals, values);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PagmoModule,
                         testing::Values(Case{"gaco", gaco, 1}, Case{"pso", pso, 1}, Case{"maco", maco, 2},
                                         Case{"nspso", nspso, 2}, Case{"maco_3", maco, 3}, Case{"nspso_3", nspso, 3}),
                         [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

}  // namespace
}  // namespace limber::experiments::test

// Searches with a module, here with one that the test controls: costs, elites, saving and restoring.
#include "experiments/module_search.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"

struct LimberModuleSearch {
  std::size_t axes;
  std::size_t objectives;
  limber::Random random;
  std::vector<double> positions;
};

namespace limber::experiments::test {
namespace {

using Vector = Search::Vector;
using Evaluated = Search::Evaluated;

constexpr std::size_t kSize = 4;  // of a generation

std::vector<double>& last_costs() {
  static std::vector<double> costs;
  return costs;
}

// Proposes random positions that depend on all costs.
LimberModuleSearch* create(const char*, std::size_t axes, std::size_t objectives, std::size_t population,
                           std::uint32_t seed) {
  return new LimberModuleSearch{axes, objectives, Random(seed), std::vector<double>(population * axes, 0.5)};
}
const double* ask(LimberModuleSearch* search) { return search->positions.data(); }
void tell(LimberModuleSearch* search, const double* costs) {
  last_costs().assign(costs, costs + search->positions.size() / search->axes * search->objectives);
  double sum = 0;
  for (const double cost : last_costs()) sum = std::sin(sum + cost);
  for (double& position : search->positions) position = std::abs(std::sin(search->random.uniform() + sum));
}
const char* no_error(const LimberModuleSearch*) { return ""; }
void destroy(LimberModuleSearch* search) { delete search; }

constexpr LimberSearchModule kModule{kSearchModuleVersion, create, ask, tell, no_error, destroy};

Search::Options options(Search::Algorithm algorithm, const LimberSearchModule* module = &kModule) {
  Search::Options made;
  made.algorithm = algorithm;
  made.axes = 3;
  made.objectives = algorithm == Search::Algorithm::nspso ? 2 : 1;
  made.population = kSize;
  made.seed = 7;
  made.module = module;
  return made;
}

Evaluated value_of(const Vector& objectives) { return {objectives, {}, 1}; }

void tell_next(Search& search) {
  const std::vector<Vector> individuals = search.ask();
  std::vector<Evaluated> values;
  values.reserve(individuals.size());
  for (const Vector& x : individuals) values.push_back(value_of({x[0] + x[1], x[2]}));
  search.tell(individuals, values);
}

TEST(ModuleSearch, HasAPopulationByDefault) {
  Search::Options made = options(Search::Algorithm::gaco);
  made.population = 0;
  const auto search = Search::create(made);
  EXPECT_EQ(search->population(), ModuleSearch::kPopulation);
  EXPECT_EQ(search->ask().size(), ModuleSearch::kPopulation);
  EXPECT_EQ(search->ask()[0].size(), 3u);
}

// Modules minimize. A failed individual, in any objective, has the largest costs so far.
TEST(ModuleSearch, FailedIndividualsHaveTheLargestCosts) {
  const double nan = std::nan("");
  const auto search = Search::create(options(Search::Algorithm::nspso));
  const auto tell_values = [&](const std::vector<Vector>& objectives) {
    std::vector<Evaluated> values;
    values.reserve(objectives.size());
    for (const Vector& objective : objectives) values.push_back(value_of(objective));
    search->tell(search->ask(), values);
    return last_costs();
  };
  EXPECT_EQ(tell_values({{nan, nan}, {nan, 1}, {nan, nan}, {nan, nan}}), Vector(8, 0.0));
  EXPECT_EQ(tell_values({{1, -2}, {3, 4}, {nan, 100}, {-std::numeric_limits<double>::infinity(), 1}}),
            (Vector{-1, 2, -3, -4, 0, 2, 0, 2}));
  EXPECT_EQ(tell_values({{-5, -1}, {nan, nan}, {-6, 0}, {1e300, -1e300}}), (Vector{5, 1, 6, 1e9, 6, 0, -1e9, 1e9}));
  EXPECT_EQ(tell_values({{1, 1}, {nan, nan}, {1, 1}, {1, 1}}), (Vector{-1, -1, 6, 1e9, -1, -1, -1, -1}));
  EXPECT_EQ(search->generation(), 4u);
}

TEST(ModuleSearch, ContinuesWithTheSameBits) {
  for (const std::uint64_t saved_at : {0u, 1u, 5u}) {
    const auto whole = Search::create(options(Search::Algorithm::nspso));
    while (whole->generation() < saved_at) tell_next(*whole);
    const auto continued = Search::create(options(Search::Algorithm::nspso));
    for (std::uint64_t i = 0; i < 3; i++) tell_next(*continued);  // restoring replaces what it had
    ASSERT_TRUE(continued->restore(whole->save()).ok());
    EXPECT_EQ(continued->generation(), saved_at);
    for (int i = 0; i < 4; i++) {
      EXPECT_EQ(continued->ask(), whole->ask());
      tell_next(*whole);
      tell_next(*continued);
    }
    EXPECT_EQ(continued->save(), whole->save());
    EXPECT_GT(whole->elites().size(), 0u);
  }
}

TEST(ModuleSearch, ElitesNeedNoModule) {
  const auto search = Search::create(options(Search::Algorithm::nspso));
  for (int i = 0; i < 3; i++) tell_next(*search);
  const auto read = Search::create(options(Search::Algorithm::nspso, nullptr));
  ASSERT_TRUE(read->restore(search->save()).ok());
  EXPECT_EQ(read->generation(), 3u);
  ASSERT_EQ(read->elites().size(), search->elites().size());
  for (std::size_t i = 0; i < read->elites().size(); i++)
    EXPECT_EQ(read->elites()[i].individual, search->elites()[i].individual);
}

// Another version of a library may propose others.
TEST(ModuleSearch, DetectsOtherProposals) {
  const auto search = Search::create(options(Search::Algorithm::nspso));
  for (int i = 0; i < 3; i++) tell_next(*search);
  LimberSearchModule other = kModule;
  other.tell = [](LimberModuleSearch* changed, const double* costs) {
    tell(changed, costs);
    changed->positions[1] = std::nextafter(changed->positions[1], 0.0);
  };
  const Result<void> restored = Search::create(options(Search::Algorithm::nspso, &other))->restore(search->save());
  ASSERT_FALSE(restored.ok());
  EXPECT_NE(restored.error().find("another version of pagmo"), std::string::npos) << restored.error();
}

TEST(ModuleSearch, RejectsDamagedStates) {
  const auto search = Search::create(options(Search::Algorithm::gaco));
  std::vector<Evaluated> values(kSize, value_of({1}));
  search->tell(search->ask(), values);
  const std::string good = search->save();
  ASSERT_TRUE(search->restore(good).ok());
  const auto expect_damaged = [&](const std::string& text) {
    const Result<void> restored = search->restore(text);
    ASSERT_FALSE(restored.ok()) << text;
    EXPECT_EQ(restored.error(), "the state of the search is damaged") << text;
  };
  const std::string cost = "bff0000000000000";  // -1
  const auto at = good.find(cost);
  ASSERT_NE(at, std::string::npos) << good;
  const auto replaced = [&](const std::string& text) { return std::string(good).replace(at, cost.size(), text); };
  expect_damaged("");
  expect_damaged("{}");
  expect_damaged("[1,2]");
  expect_damaged(replaced(""));                  // a cost less
  expect_damaged(replaced(cost + cost));         // a cost more
  expect_damaged(replaced("bff000000000000"));   // a digit less
  expect_damaged(replaced("bff00000000000x0"));  // no digit
  expect_damaged(replaced("7ff8000000000000"));  // not a number
  expect_damaged(replaced("7fefffffffffffff"));  // too large
}

}  // namespace
}  // namespace limber::experiments::test

// NSGA-II, Pareto fronts, and searches with several objectives.
#include "experiments/nsga2.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "experiments/elite_list.h"
#include "experiments/search.h"

namespace limber::experiments::test {
namespace {

using Vector = Nsga2::Vector;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
const double kNan = std::nan("");

/// Schaffer's function: minimizes x² and (x − 2)² with x in −4 .. 6; the front is x in 0 .. 2.
Vector schaffer(const Vector& individual) {
  const double x = -4 + 10 * individual[0];
  return {-x * x, -(x - 2) * (x - 2)};
}

std::vector<Vector> all(const std::vector<Vector>& individuals) {
  std::vector<Vector> values;
  for (const Vector& x : individuals) values.push_back(schaffer(x));
  return values;
}

TEST(Domination, NeedsOneBetterAndNoWorse) {
  EXPECT_TRUE(dominates({1, 2}, {1, 1}));
  EXPECT_TRUE(dominates({2, 2}, {1, 1}));
  EXPECT_FALSE(dominates({1, 1}, {1, 1}));
  EXPECT_FALSE(dominates({2, 0}, {1, 1}));
}

TEST(Domination, CrowdingIsTheDistanceOfNeighbors) {
  const std::vector<Vector> points{{0, 4}, {1, 3}, {4, 0}};
  const Vector distances = crowding_distances({&points[0], &points[1], &points[2]});
  EXPECT_EQ(distances, (Vector{kInfinite, 2, kInfinite}));  // (4 − 0) / 4 + (4 − 0) / 4
  EXPECT_TRUE(crowding_distances({}).empty());
}

TEST(EliteList, WithOneObjectiveKeepsEachImprovement) {
  EliteList list(1, 1);
  for (const double value : {1.0, 3.0, 2.0, 3.0, kNan, 4.0}) list.add({{0.5}, {value}, {}, 0, 0, 0});
  ASSERT_EQ(list.elites().size(), 3u);
  EXPECT_EQ(list.elites()[1].objectives, Vector{3});
  EXPECT_EQ(list.elites()[2].objectives, Vector{4});
}

TEST(EliteList, WithSeveralObjectivesIsTheFrontInOrder) {
  EliteList list(1, 2);
  std::uint64_t number = 0;
  for (const Vector& point : std::vector<Vector>{{1, 1}, {0, 3}, {2, 0}, {1, 1}, {1, 2}, {0.5, 1.5}, {3, kInfinite}})
    list.add({{0.5}, point, {}, 0, number++, 0});
  ASSERT_EQ(list.elites().size(), 3u);
  EXPECT_EQ(list.elites()[0].objectives, (Vector{2, 0}));
  EXPECT_EQ(list.elites()[1].objectives, (Vector{1, 2}));
  EXPECT_EQ(list.elites()[2].objectives, (Vector{0, 3}));
  EliteList restored(1, 2);
  ASSERT_TRUE(restored.restore(list.save()).ok());
  EXPECT_EQ(restored.save(), list.save());
  EXPECT_FALSE(EliteList(2, 2).restore(list.save()).ok());
}

TEST(EliteList, AFullFrontLosesItsMostCrowdedElite) {
  EliteList list(1, 2, 4);
  for (const double x : {0.0, 1.0, 0.9, 0.4, 0.2}) list.add({{0.5}, {x, 1 - x}, {}, 0, 0, 0});
  std::vector<double> first;
  for (const Elite& elite : list.elites()) first.push_back(elite.objectives[0]);
  // the neighbors of 0.2 are nearest to each other: 0.4 − 0
  EXPECT_EQ(first, (std::vector<double>{1, 0.9, 0.4, 0}));
}

TEST(Nsga2, FindsTheFrontOfSchaffersFunction) {
  Nsga2 search({1, 2, 20, 7});
  EliteList front(1, 2);
  for (int i = 0; i < 30; i++) {
    const std::vector<Vector> individuals = search.ask();
    ASSERT_EQ(individuals.size(), 20u);
    for (const Vector& x : individuals) {
      EXPECT_TRUE(x[0] >= 0 && x[0] <= 1);
      front.add({x, schaffer(x), {}, 0, 0, 0});
    }
    search.tell(individuals, all(individuals));
  }
  double before = -4;
  for (const Elite& elite : front.elites()) {
    const double x = -4 + 10 * elite.individual[0];
    EXPECT_GE(x, -0.05);
    EXPECT_LE(x, 2.05);
    EXPECT_TRUE(before == -4 || x - before < 0.2) << "a gap in the front";
    before = x;
  }
  EXPECT_LT(-4 + 10 * front.elites().front().individual[0], 0.1);
  EXPECT_GT(before, 1.9);
}

TEST(Nsga2, FailedIndividualsAreWorseThanAllOthers) {
  Nsga2 search({1, 2, 4, 7});
  search.tell({{0.1}, {0.2}, {0.3}, {0.4}}, {{kNan, 9}, {1, 1}, {kNan, kNan}, {0, 0}});
  // better ones replace both failures
  search.tell({{0.5}, {0.6}, {0.7}, {0.8}}, {{-1, -1}, {kInfinite, 5}, {-2, -2}, {kNan, 1}});
  const std::string state = search.save();
  EXPECT_NE(state.find("[0.5]"), std::string::npos) << state;
  EXPECT_NE(state.find("[0.7]"), std::string::npos) << state;
  for (const char* failed : {"[0.1]", "[0.3]", "[0.6]", "[0.8]"})
    EXPECT_EQ(state.find(failed), std::string::npos) << state;
}

TEST(Nsga2, ContinuesFromItsSavedStateWithTheSameBits) {
  Search::Options options;
  options.algorithm = Search::Algorithm::nsga2;
  options.axes = 1;
  options.objectives = 2;
  options.population = 8;
  const std::unique_ptr<Search> whole = Search::create(options);
  std::unique_ptr<Search> interrupted = Search::create(options);
  for (int i = 0; i < 20; i++) {
    const std::string state = interrupted->save();
    interrupted = Search::create(options);
    ASSERT_TRUE(interrupted->restore(state).ok());
    for (Search* search : {whole.get(), interrupted.get()}) {
      const std::vector<Vector> individuals = search->ask();
      std::vector<Search::Evaluated> values;
      for (const Vector& x : individuals) values.push_back({schaffer(x), {}, 1});
      if (i == 3) values[2].objectives[0] = kNan;
      search->tell(individuals, values);
    }
    ASSERT_EQ(whole->save(), interrupted->save());
    ASSERT_EQ(whole->ask(), interrupted->ask());
  }
  for (const char* wrong : {"", "{}", "3", R"({"nsga2":"{}","elites":"[]"})",
                            R"({"nsga2":"{\"generation\":1,\"parents\":[]}","elites":"[]"})"})
    EXPECT_FALSE(interrupted->restore(wrong).ok()) << wrong;
}

}  // namespace
}  // namespace limber::experiments::test

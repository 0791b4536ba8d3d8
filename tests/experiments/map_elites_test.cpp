// MAP-Elites, and searches within bounds.
#include "experiments/map_elites.h"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "experiments/search.h"

namespace limber::experiments::test {
namespace {

using Vector = MapElites::Vector;

/// The descriptors are the first two positions, the fitness the negative square of the third: the best of each cell has
/// a third position of 0.
std::vector<MapElites::Evaluated> evaluate(const std::vector<Vector>& individuals) {
  std::vector<MapElites::Evaluated> values;
  for (const Vector& x : individuals) values.push_back({-x[2] * x[2], {x[0], x[1]}, 1});
  return values;
}

MapElites::Options options() {
  MapElites::Options options;
  options.axes = 3;
  options.descriptors = {{"a", 0, 1, 10}, {"b", 0, 1, 5}};
  return options;
}

TEST(MapElites, CellsFollowFromTheRanges) {
  MapElites::Options options;
  options.descriptors = {{"a", -1, 1, 4}, {"b", 0, 10, 5}};
  const MapElites search(options);
  EXPECT_EQ(search.cells(), 20u);
  EXPECT_EQ(search.cell_of({-1, 0}), 0u);
  EXPECT_EQ(search.cell_of({-0.51, 9.9}), 4u);
  EXPECT_EQ(search.cell_of({-0.5, 0}), 5u);
  EXPECT_EQ(search.cell_of({1, 10}), 19u);
  EXPECT_EQ(search.cell_of({1e300, -1e300}), 15u);  // outside: the first or last cell
  EXPECT_EQ(MapElites::cell_along(options.descriptors[0], -0.5), 1u);
  EXPECT_EQ(MapElites::cell_along(options.descriptors[1], 11), 4u);
}

TEST(MapElites, FillsAllCellsWithTheBest) {
  MapElites search(options());
  double sum_before = -1e9;
  for (int i = 0; i < 200; i++) {
    const std::vector<Vector> individuals = search.ask();
    ASSERT_EQ(individuals.size(), 100u);
    for (const Vector& x : individuals) {
      for (const double position : x) EXPECT_TRUE(position >= 0 && position <= 1);
    }
    search.tell(individuals, evaluate(individuals));
    if (search.elites().size() < search.cells()) continue;
    double sum = 0;
    for (const auto& [cell, elite] : search.elites()) sum += elite.fitness;
    EXPECT_GE(sum, sum_before);  // an elite is only replaced by a better one
    sum_before = sum;
  }
  ASSERT_EQ(search.elites().size(), 50u);
  for (const auto& [cell, elite] : search.elites()) {
    EXPECT_EQ(search.cell_of(elite.descriptors), cell);
    EXPECT_GT(elite.fitness, -1e-3);
  }
}

TEST(MapElites, KeepsTheFirstOfEqualsAndSkipsFailures) {
  MapElites search(options());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vector> individuals{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}};
  search.tell(individuals, {{1, {0.5, 0.5}, 7}, {1, {0.5, 0.5}, 8}, {nan, {0.9, 0.9}, 9}, {5, {0.9, nan}, 10}});
  ASSERT_EQ(search.elites().size(), 1u);
  EXPECT_EQ(search.elites().begin()->second.hash, 7u);
  EXPECT_EQ(search.elites().begin()->second.fitness, 1);
}

TEST(Search, ContinuesFromItsSavedStateWithTheSameBits) {
  for (const bool archive : {false, true}) {
    Search::Options options;
    options.axes = 3;
    options.seed = 5;
    if (archive) options.algorithm = Search::Algorithm::map_elites;
    if (archive) options.descriptors = {{"a", 0, 1, 10}, {"b", 0, 1, 5}};
    const std::unique_ptr<Search> whole = Search::create(options);
    std::unique_ptr<Search> interrupted = Search::create(options);
    for (int i = 0; i < 20; i++) {
      const std::string state = interrupted->save();
      interrupted = Search::create(options);
      ASSERT_TRUE(interrupted->restore(state).ok());
      for (Search* search : {whole.get(), interrupted.get()}) {
        const std::vector<Vector> individuals = search->ask();
        std::vector<Search::Evaluated> values;
        for (const MapElites::Evaluated& value : evaluate(individuals))
          values.push_back({{value.fitness}, value.descriptors, value.hash});
        search->tell(individuals, values);
      }
      ASSERT_EQ(whole->save(), interrupted->save());
    }
    for (const char* wrong : {"", "{}", "3", "{\"elites\":[]}"})
      EXPECT_FALSE(interrupted->restore(wrong).ok()) << wrong;
  }
}

TEST(Search, WithoutDescriptorsFindsTheBestWithinTheRange) {
  Search::Options options;
  options.axes = 3;
  const std::unique_ptr<Search> search = Search::create(options);
  for (int i = 0; i < 100; i++) {
    const std::vector<Vector> individuals = search->ask();
    std::vector<Search::Evaluated> values;
    for (const Vector& x : individuals) {
      for (const double position : x) EXPECT_TRUE(position >= 0 && position <= 1);
      // the optimum is at a corner, at the bounds of the range
      values.push_back({{x[0] + x[1] - x[2]}, {}, 1});
    }
    search->tell(individuals, values);
  }
  EXPECT_NEAR(search->elites().back().objectives[0], 2, 1e-3);
}

TEST(Search, ReflectionFoldsIntoTheRange) {
  EXPECT_EQ(reflected(0.25), 0.25);
  EXPECT_EQ(reflected(-0.25), 0.25);
  EXPECT_EQ(reflected(1.25), 0.75);
  EXPECT_EQ(reflected(2.25), 0.25);
  EXPECT_EQ(reflected(-1.25), 0.75);
}

}  // namespace
}  // namespace limber::experiments::test

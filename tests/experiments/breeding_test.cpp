// Breeding: what operations keep, change and restore.
#include "experiments/breeding.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace limber::experiments::test {
namespace {

using Vector = Breeding::Vector;

Axis ranged(const char* name, double min, double max) { return {name, min, max, {}, false, {}, false}; }
Axis gaits() { return {"gait", 0, 2, {0, 1, 2}, true, {"walk", "trot", "bound"}, false}; }

Breeding breed(double amount = 0.1, std::uint64_t seed = 1) {
  return Breeding({ranged("rate", 1, 3), ranged("depth", 0, 1), gaits()}, {{0.5, 0.25, 0.5}}, amount, seed);
}

TEST(Breeding, BeginsWithTheParentsAndVariationsOfThem) {
  const Breeding one = breed();
  EXPECT_EQ(one.values(0), (std::vector<double>{2, 0.25, 1}));
  std::set<double> rates;
  for (std::size_t i = 0; i < Breeding::kCount; i++) rates.insert(one.values(i)[0]);
  EXPECT_EQ(rates.size(), Breeding::kCount);
  EXPECT_TRUE(one.current().kept[0]);
  EXPECT_FALSE(one.current().kept[1]);
  EXPECT_FALSE(one.can_undo());
  const std::vector<Vector> many(12, Vector{1, 1, 0.5});
  const Breeding full({ranged("rate", 1, 3), ranged("depth", 0, 1), gaits()}, many, 0.1, 1);
  for (std::size_t i = 0; i < Breeding::kCount; i++) EXPECT_EQ(full.values(i), (std::vector<double>{3, 1, 1}));
}

TEST(Breeding, KeepsTheLikedOnesInTheirPlace) {
  Breeding breeding = breed();
  breeding.toggle_liked(4);
  const Breeding::Generation before = breeding.current();
  for (const int operation : {0, 1, 2}) {
    const bool changed = operation == 0   ? breeding.mutate(0.1)
                         : operation == 1 ? breeding.cross()
                                          : breeding.randomize();
    EXPECT_TRUE(changed);
    const Breeding::Generation& now = breeding.current();
    for (std::size_t i = 0; i < Breeding::kCount; i++) {
      EXPECT_EQ(now.kept[i], i == 4);
      EXPECT_EQ(now.individuals[i] == before.individuals[i], i == 4) << operation << " " << i;
      EXPECT_FALSE(now.liked[i]);
    }
    breeding.undo();
    EXPECT_EQ(breeding.current().individuals, before.individuals);
    EXPECT_EQ(breeding.current().liked, before.liked);
  }
}

/// With a deviation of 0.02 the mean square distance of a child from its parent is 0.0004 along each axis.
TEST(Breeding, MutationsDeviateByTheAmount) {
  const Axis axis = ranged("a", 0, 1);
  const std::size_t axes = 2000;
  Breeding breeding(std::vector<Axis>(axes, axis), {Vector(axes, 0.5)}, 0.02, 3);
  double sum = 0;
  for (std::size_t i = 1; i < Breeding::kCount; i++) {
    for (const double position : breeding.current().individuals[i]) sum += (position - 0.5) * (position - 0.5);
  }
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(8 * axes)), 0.02, 0.001);
}

TEST(Breeding, PositionsStayWithinTheRange) {
  Breeding breeding(std::vector<Axis>(50, ranged("a", 0, 1)), {Vector(50, 0.01), Vector(50, 0.99)}, 0.5, 1);
  for (int n = 0; n < 40; n++) {
    breeding.toggle_liked(static_cast<std::size_t>(n) % Breeding::kCount);
    ASSERT_TRUE(n % 2 == 0 ? breeding.mutate(9) : breeding.cross());
    for (const Vector& individual : breeding.current().individuals) {
      for (const double position : individual) ASSERT_TRUE(position >= 0 && position <= 1) << position;
    }
  }
}

/// Crossed positions are within the parents' distance and a quarter of it beyond; choices come from either parent.
TEST(Breeding, CrossesTheLikedOnes) {
  const Axis axis = ranged("a", 0, 1);
  Breeding breeding({axis, gaits()}, {{0.4, 0.1}, {0.6, 0.9}}, 0.5, 1);
  breeding.toggle_liked(0);
  breeding.toggle_liked(1);
  ASSERT_TRUE(breeding.cross());
  std::set<double> choices;
  for (std::size_t i = 2; i < Breeding::kCount; i++) {
    const Vector& child = breeding.current().individuals[i];
    EXPECT_GE(child[0], 0.4 - 0.05);
    EXPECT_LE(child[0], 0.6 + 0.05);
    choices.insert(child[1]);
  }
  EXPECT_EQ(choices, (std::set<double>{0.1, 0.9}));
}

TEST(Breeding, HeldParametersStay) {
  Breeding breeding = breed();
  breeding.toggle_held(1);
  const Breeding::Generation before = breeding.current();
  ASSERT_TRUE(breeding.randomize());
  for (std::size_t i = 0; i < Breeding::kCount; i++) {
    EXPECT_EQ(breeding.current().individuals[i][1], before.individuals[i][1]);
    EXPECT_NE(breeding.current().individuals[i][0], before.individuals[i][0]);
  }
  breeding.toggle_liked(2);
  ASSERT_TRUE(breeding.mutate(0.3));
  for (std::size_t i = 0; i < Breeding::kCount; i++)
    EXPECT_EQ(breeding.current().individuals[i][1], before.individuals[2][1]);
}

TEST(Breeding, UndoesAndRedoes) {
  Breeding breeding = breed();
  std::vector<Breeding::Generation> seen = {breeding.current()};
  for (int n = 0; n < 3; n++) {
    ASSERT_TRUE(breeding.mutate(0.1));
    seen.push_back(breeding.current());
  }
  breeding.redo();  // there is nothing to redo
  for (int n = 2; n >= 0; n--) {
    breeding.undo();
    EXPECT_EQ(breeding.current().individuals, seen[static_cast<std::size_t>(n)].individuals);
  }
  EXPECT_FALSE(breeding.can_undo());
  breeding.undo();
  breeding.redo();
  EXPECT_EQ(breeding.current().individuals, seen[1].individuals);
  ASSERT_TRUE(breeding.mutate(0.1));  // replaces what was undone, with other numbers
  EXPECT_FALSE(breeding.can_redo());
  EXPECT_NE(breeding.current().individuals, seen[2].individuals);
  EXPECT_EQ(breeding.current().number, 5u);
}

TEST(Breeding, ForgetsTheOldestGenerations) {
  Breeding breeding = breed();
  for (std::size_t n = 0; n < Breeding::kMaxGenerations + 20; n++) ASSERT_TRUE(breeding.mutate(0.1));
  std::size_t undone = 0;
  for (; breeding.can_undo(); undone++) breeding.undo();
  EXPECT_EQ(undone, Breeding::kMaxGenerations - 1);
}

TEST(Breeding, NothingChangesIfAllAreLiked) {
  Breeding breeding = breed();
  for (std::size_t i = 0; i < Breeding::kCount; i++) breeding.toggle_liked(i);
  EXPECT_FALSE(breeding.mutate(0.1));
  EXPECT_FALSE(breeding.cross());
  EXPECT_FALSE(breeding.randomize());
  EXPECT_FALSE(breeding.can_undo());
}

TEST(Breeding, TheSeedDeterminesIt) {
  Breeding a = breed(), b = breed();
  const Breeding other = breed(0.1, 2);
  EXPECT_NE(a.current().individuals, other.current().individuals);
  for (Breeding* each : {&a, &b}) {
    each->toggle_liked(3);
    each->toggle_liked(5);
    ASSERT_TRUE(each->cross());
  }
  EXPECT_EQ(a.current().individuals, b.current().individuals);
}

TEST(Breeding, PositionsOfValues) {
  const Axis rate = ranged("rate", 1, 3);
  EXPECT_EQ(rate.position_of(1.5), 0.25);
  EXPECT_EQ(rate.position_of(9), 1);
  const Axis gait = gaits();
  for (const double value : {0.0, 1.0, 2.0}) EXPECT_EQ(gait.at(gait.position_of(value)), value);
  const Axis list{"n", 1, 5, {1, 2, 5}, true, {}, false};
  EXPECT_EQ(list.at(list.position_of(4.9)), 5);
}

}  // namespace
}  // namespace limber::experiments::test

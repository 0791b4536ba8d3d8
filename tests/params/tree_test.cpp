// The tree is the store's structure, and its walks find what the catalog's find.
#include "params/tree.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "params/catalog.h"

namespace limber {
namespace {

using namespace rows;

double far_away(const void*) { return 7; }

struct Thing {
  void read_pair(double* out) const {
    out[0] = far_away(this);
    out[1] = out[2] = 0;
  }
};

const Table& toy_table() {
  static const Table table(
      "toy", "/room/toy/<toy>", "",
      {number("weight", "kg", 1, 0, 10, "Mass."), live(readout(number("height", "m", 0, 0, 9, "z."))),
       view<&Thing::read_pair>(readout(vec3("pair", "", {0, 0, 0}, -9, 9, "Computed."))),
       view<&Thing::read_pair>(readout(vec3("other", "", {0, 0, 0}, -9, 9, "Computed."))),
       live(state(boolean("on", true, "Whether."))), action("press", 0, 0, "Pressed.")});
  return table;
}

struct Room {
  Thing thing;
  Store store;
  NodeId group = store.add_group(store.add_group(store.root(), "room"), "toy");
  NodeId ball = store.add(toy_table(), group, "ball", &thing);
  NodeId odd = store.add(toy_table(), group, "my ball/50%", &thing);
  NodeId lid = store.add(toy_table(), ball, "lid", &thing);
};

TEST(Tree, HoldsEveryNodeInOrderWithItsPath) {
  Room room;
  const Tree tree(room.store);
  std::vector<std::string> expected;
  room.store.walk(room.store.root(), [&](NodeId id) { expected.push_back(room.store.path(id)); });
  std::vector<std::string> paths;
  for (std::uint32_t i = 0; i < tree.nodes().size(); i++) paths.push_back(tree.path(i));
  EXPECT_EQ(paths, expected);
  EXPECT_EQ(paths, (std::vector<std::string>{"/", "/room", "/room/toy", "/room/toy/ball", "/room/toy/ball/lid",
                                             "/room/toy/my%20ball%2F50%25"}));
  std::vector<std::string> toys;
  tree.each_child(2, [&](std::uint32_t child) {
    toys.emplace_back(tree.name(child));
    return true;
  });
  EXPECT_EQ(toys, (std::vector<std::string>{"ball", "my ball/50%"}));
}

TEST(Tree, NumbersStandWhereTheStoreHasThem) {
  Room room;
  const double height = 3;
  *room.store.tell(room.odd, toy_table().at("height")) = height;
  const double weight = 4;
  ASSERT_TRUE(room.store.set(room.odd, "weight", {&weight, 1}).ok());
  const Tree tree(room.store);
  const auto at = [&](const std::string& path) {
    return tree.numbers(*tree.find("/room/toy/my%20ball%2F50%25/" + path));
  };
  EXPECT_EQ(at("weight").block, TreeNumbers::Block::kept);
  EXPECT_EQ(room.store.kept()[at("weight").at], 4);
  EXPECT_EQ(at("height").block, TreeNumbers::Block::live);
  EXPECT_EQ(room.store.live()[at("height").at], 3);
  EXPECT_EQ(room.store.live()[at("on").at], 1);
  // views stand one behind the other, thing after thing: two of three numbers each
  EXPECT_EQ(tree.views_width(), 18u);
  EXPECT_EQ(tree.numbers(*tree.find("/room/toy/ball/pair")).at, 0u);
  EXPECT_EQ(tree.numbers(*tree.find("/room/toy/ball/other")).at, 3u);
  EXPECT_EQ(tree.numbers(*tree.find("/room/toy/ball/lid/pair")).at, 6u);
  EXPECT_EQ(at("other").at, 15u);
  EXPECT_EQ(at("press").block, TreeNumbers::Block::none);
}

// both walks are one: each of these finds the same, or says the same
TEST(Tree, FindsAndMatchesAsTheCatalogDoes) {
  Room room;
  const Tree tree(room.store);
  for (const char* path :
       {"/room/toy/ball/weight", "/Room/TOY/ball/Weight", "/room/toy/Ball/weight", "/room/toy/ball", "/roem",
        "/room/toy/ball/wait", "room", "", "/room/toy/my ball/x", "/room/toy/ball/lid/on/"}) {
    const Result<Place> of_store = find_place(room.store, path);
    const Result<TreePlace> of_tree = tree.find(path);
    ASSERT_EQ(of_store.ok(), of_tree.ok()) << path;
    if (!of_store) {
      EXPECT_EQ(of_tree.error(), of_store.error());
    } else {
      EXPECT_EQ(tree.nodes()[of_tree->node].id, of_store->node) << path;
      EXPECT_EQ(of_tree->row, of_store->row) << path;
    }
  }
  for (const char* pattern :
       {"/room/toy/*/weight", "//on", "/room/*/ball/*", "/room/toy/{ball,none}/he*", "//", "/room/toy/ball/pair"}) {
    PatternBudget budget;
    PatternBudget other;
    const Result<std::vector<Place>> of_store = match_places(room.store, pattern, budget);
    const Result<std::vector<TreePlace>> of_tree = tree.match(pattern, other, 1000);
    EXPECT_EQ(budget.left, other.left);
    ASSERT_EQ(of_store->size(), of_tree->size()) << pattern;
    for (std::size_t i = 0; i < of_store->size(); i++) {
      EXPECT_EQ(tree.nodes()[(*of_tree)[i].node].id, (*of_store)[i].node) << pattern;
      EXPECT_EQ((*of_tree)[i].row, (*of_store)[i].row) << pattern;
    }
  }
  PatternBudget budget;
  EXPECT_EQ(tree.match("//on", budget, 2)->size(), 2u);
  EXPECT_EQ(tree.find("/")->node, 0u);
  EXPECT_EQ(tree.find("/")->row, nullptr);
}

TEST(Tree, StaysAsItWasWhileTheStoreChanges) {
  Room room;
  const Tree tree(room.store);
  room.store.remove(room.ball);
  EXPECT_EQ(tree.nodes().size(), 6u);
  EXPECT_EQ(tree.path(*tree.find("/room/toy/ball/lid/weight")), "/room/toy/ball/lid/weight");
  EXPECT_FALSE(Tree(room.store).find("/room/toy/ball").ok());
}

}  // namespace
}  // namespace limber

// TreeSnapshot: a copy of the store's structure; its lookups give the same results as the catalog's.
#include "properties/tree_snapshot.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "properties/catalog.h"

namespace limber {
namespace {

using namespace properties;

double constant_value(const void*) { return 7; }

struct Thing {
  void read_pair(double* out) const {
    out[0] = constant_value(this);
    out[1] = out[2] = 0;
  }
};

const PropertyTable& toy_table() {
  static const PropertyTable table(
      "toy", "/room/toy/<toy>", "",
      {number("weight", "kg", 1, 0, 10, "Mass."), transient(readout(number("height", "m", 0, 0, 9, "z."))),
       computed<&Thing::read_pair>(readout(vec3("pair", "", {0, 0, 0}, -9, 9, "Computed."))),
       computed<&Thing::read_pair>(readout(vec3("other", "", {0, 0, 0}, -9, 9, "Computed."))),
       transient(state(boolean("on", true, "Whether."))), action("press", 0, 0, "Pressed.")});
  return table;
}

struct TreeFixture {
  Thing thing;
  Store store;
  NodeId group = store.add_group(store.add_group(store.root(), "room"), "toy");
  NodeId ball = store.add(toy_table(), group, "ball", &thing);
  NodeId escaped = store.add(toy_table(), group, "my ball/50%", &thing);
  NodeId lid = store.add(toy_table(), ball, "lid", &thing);
};

TEST(TreeSnapshot, HasAllNodesInOrderWithPaths) {
  TreeFixture fixture;
  const TreeSnapshot tree(fixture.store);
  std::vector<std::string> expected;
  fixture.store.walk(fixture.store.root(), [&](NodeId id) { expected.push_back(fixture.store.path(id)); });
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

TEST(TreeSnapshot, LocatesValuesLikeTheStore) {
  TreeFixture fixture;
  const double height = 3;
  *fixture.store.mutable_values(fixture.escaped, toy_table().at("height")) = height;
  const double weight = 4;
  ASSERT_TRUE(fixture.store.set(fixture.escaped, "weight", {&weight, 1}).ok());
  const TreeSnapshot tree(fixture.store);
  const auto at = [&](const std::string& path) {
    return tree.location(*tree.find("/room/toy/my%20ball%2F50%25/" + path));
  };
  EXPECT_EQ(at("weight").block, ValueLocation::Block::persistent);
  EXPECT_EQ(fixture.store.persistent_values()[at("weight").offset], 4);
  EXPECT_EQ(at("height").block, ValueLocation::Block::transient);
  EXPECT_EQ(fixture.store.transient_values()[at("height").offset], 3);
  EXPECT_EQ(fixture.store.transient_values()[at("on").offset], 1);
  // The block of computed properties has two properties of three numbers per node.
  EXPECT_EQ(tree.computed_width(), 18u);
  EXPECT_EQ(tree.location(*tree.find("/room/toy/ball/pair")).offset, 0u);
  EXPECT_EQ(tree.location(*tree.find("/room/toy/ball/other")).offset, 3u);
  EXPECT_EQ(tree.location(*tree.find("/room/toy/ball/lid/pair")).offset, 6u);
  EXPECT_EQ(at("other").offset, 15u);
  EXPECT_EQ(at("press").block, ValueLocation::Block::none);
}

// Both lookups have the same results and the same errors.
TEST(TreeSnapshot, FindsAndMatchesLikeTheCatalog) {
  TreeFixture fixture;
  const TreeSnapshot tree(fixture.store);
  for (const char* path :
       {"/room/toy/ball/weight", "/Room/TOY/ball/Weight", "/room/toy/Ball/weight", "/room/toy/ball", "/roem",
        "/room/toy/ball/wait", "room", "", "/room/toy/my ball/x", "/room/toy/ball/lid/on/"}) {
    const Result<PropertyRef> of_store = find_property(fixture.store, path);
    const Result<TreePropertyRef> of_tree = tree.find(path);
    ASSERT_EQ(of_store.ok(), of_tree.ok()) << path;
    if (!of_store) {
      EXPECT_EQ(of_tree.error(), of_store.error());
    } else {
      EXPECT_EQ(tree.nodes()[of_tree->node].id, of_store->node) << path;
      EXPECT_EQ(of_tree->property, of_store->property) << path;
    }
  }
  for (const char* pattern :
       {"/room/toy/*/weight", "//on", "/room/*/ball/*", "/room/toy/{ball,none}/he*", "//", "/room/toy/ball/pair"}) {
    PatternBudget budget;
    PatternBudget other;
    const Result<std::vector<PropertyRef>> of_store = match_properties(fixture.store, pattern, budget);
    const Result<std::vector<TreePropertyRef>> of_tree = tree.match(pattern, other, 1000);
    EXPECT_EQ(budget.remaining, other.remaining);
    ASSERT_EQ(of_store->size(), of_tree->size()) << pattern;
    for (std::size_t i = 0; i < of_store->size(); i++) {
      EXPECT_EQ(tree.nodes()[(*of_tree)[i].node].id, (*of_store)[i].node) << pattern;
      EXPECT_EQ((*of_tree)[i].property, (*of_store)[i].property) << pattern;
    }
  }
  PatternBudget budget;
  EXPECT_EQ(tree.match("//on", budget, 2)->size(), 2u);
  EXPECT_EQ(tree.find("/")->node, 0u);
  EXPECT_EQ(tree.find("/")->property, nullptr);
}

TEST(TreeSnapshot, DoesNotChangeWithTheStore) {
  TreeFixture fixture;
  const TreeSnapshot tree(fixture.store);
  fixture.store.remove(fixture.ball);
  EXPECT_EQ(tree.nodes().size(), 6u);
  EXPECT_EQ(tree.path(*tree.find("/room/toy/ball/lid/weight")), "/room/toy/ball/lid/weight");
  EXPECT_FALSE(TreeSnapshot(fixture.store).find("/room/toy/ball").ok());
}

}  // namespace
}  // namespace limber

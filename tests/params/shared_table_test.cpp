// Tables that come while the program runs: equal ones are one, and a node is given another.
#include <gtest/gtest.h>

#include "params/toy.h"

namespace limber {
namespace {

using namespace rows;
using Numbers = std::vector<double>;

std::vector<Row> two_rows() {
  return {number("size", "m", 1, 0, 5, "A size."), choice("mode", {"off", "on", "auto"}, 1, "A mode.")};
}

TEST(SharedTable, EqualOnesAreOne) {
  const Table* const table = &shared_table("thing", "/things/<thing>", two_rows());
  EXPECT_EQ(&shared_table("thing", "/things/<thing>", two_rows()), table);
  EXPECT_EQ(table->kept_width(), 2U);
  EXPECT_NE(&shared_table("other", "/things/<thing>", two_rows()), table);
  EXPECT_NE(&shared_table("thing", "/others/<thing>", two_rows()), table);
}

TEST(SharedTable, WhateverDiffersInARowMakesAnother) {
  const auto differs = [](void (*change)(Row&)) {
    std::vector<Row> rows = two_rows();
    change(rows[0]);
    return &shared_table("thing", "/things/<thing>", std::move(rows)) !=
           &shared_table("thing", "/things/<thing>", two_rows());
  };
  EXPECT_TRUE(differs([](Row& row) { row.initial[0] = 2; }));
  EXPECT_TRUE(differs([](Row& row) { row.max = 6; }));
  EXPECT_TRUE(differs([](Row& row) { row.doc = "Another."; }));
  EXPECT_TRUE(differs([](Row& row) { row.live = true; }));
  EXPECT_TRUE(differs([](Row& row) { row.effect = [](void*) {}; }));
  EXPECT_TRUE(differs([](Row& row) { row.written = [](void*, const Row&) {}; }));
}

struct Node {
  Store store;
  NodeId first = store.add_group(store.root(), "first");
  int thing = 0;
  int other = 0;
  NodeId id = store.add(shared_table("thing", "/<thing>", two_rows()), store.root(), "it", &thing);
  NodeId last = store.add_group(store.root(), "last");
};

TEST(Retable, KeepsWhatBothHaveInTheNewRanges) {
  Node n;
  ASSERT_TRUE(test::set(n.store, n.id, "size", {4}).ok());
  ASSERT_TRUE(test::set(n.store, n.id, "mode", {2}).ok());
  // the label "auto" stands first now; size is narrower; a row came
  const NodeId id = n.store.retable(
      n.id,
      shared_table("thing", "/<thing>",
                   {number("fresh", "", 7, 0, 9, "A new one."), choice("mode", {"auto", "on"}, 1, "A mode."),
                    number("size", "m", 1, 0, 3, "A size.")}),
      &n.other);
  EXPECT_FALSE(n.store.alive(n.id));
  ASSERT_TRUE(n.store.alive(id));
  EXPECT_EQ(test::read(n.store, id, "size"), Numbers{3});
  EXPECT_EQ(test::read(n.store, id, "mode"), Numbers{0});
  EXPECT_EQ(test::read(n.store, id, "fresh"), Numbers{7});
  EXPECT_EQ(n.store.thing(id), &n.other);
  // in its place, under its name
  EXPECT_EQ(n.store.child(n.store.root(), "it"), id);
  EXPECT_EQ(n.store.children(n.store.root())[1], id);
}

TEST(Retable, WhatIsOfAnotherTypeOrGoneIsTheDefault) {
  Node n;
  ASSERT_TRUE(test::set(n.store, n.id, "size", {4}).ok());
  ASSERT_TRUE(test::set(n.store, n.id, "mode", {0}).ok());
  const NodeId id = n.store.retable(
      n.id,
      shared_table("thing", "/<thing>",
                   {vec3("size", "m", {1, 2, 3}, 0, 9, "Three sizes."), choice("mode", {"on", "auto"}, 1, "A mode.")}),
      &n.other);
  EXPECT_EQ(test::read(n.store, id, "size"), (Numbers{1, 2, 3}));
  EXPECT_EQ(test::read(n.store, id, "mode"), Numbers{1});
}

TEST(Retable, TheSameTableKeepsTheNode) {
  Node n;
  ASSERT_TRUE(test::set(n.store, n.id, "size", {4}).ok());
  const std::uint64_t structure = n.store.structure_version();
  EXPECT_EQ(n.store.retable(n.id, n.store.table(n.id), &n.other), n.id);
  EXPECT_EQ(n.store.thing(n.id), &n.other);
  EXPECT_EQ(n.store.structure_version(), structure);
  EXPECT_TRUE(n.store.retable({77, 3}, n.store.table(n.id), &n.other).null());
}

TEST(Written, IsToldOfEveryWriteAtOnce) {
  static int told = 0;
  static std::string last;
  std::vector<Row> rows = two_rows();
  for (Row& row : rows) {
    row.written = [](void* thing, const Row& row) {
      told++;
      last = row.name;
      *static_cast<int*>(thing) += 1;
    };
  }
  Store store;
  int thing = 0;
  const NodeId id = store.add(shared_table("listener", "/<listener>", std::move(rows)), store.root(), "it", &thing);
  EXPECT_EQ(told, 0);
  ASSERT_TRUE(test::set(store, id, "size", {1}).ok());  // the value that it has
  EXPECT_EQ(told, 1);
  ASSERT_TRUE(test::set(store, id, "mode", {2}).ok());
  EXPECT_EQ(last, "mode");
  EXPECT_FALSE(test::set(store, id, "mode", {9}).ok());  // refused: nothing was written
  EXPECT_EQ(told, 2);
  EXPECT_EQ(thing, 2);
}

}  // namespace
}  // namespace limber

// Tables that are defined at run time: equal ones are shared; changing the table of a node; write callbacks.
#include <gtest/gtest.h>

#include "properties/toy.h"

namespace limber {
namespace {

using namespace properties;
using Numbers = std::vector<double>;

std::vector<Property> two_properties() {
  return {number("size", "m", 1, 0, 5, "A size."), choice("mode", {"off", "on", "auto"}, 1, "A mode.")};
}

TEST(SharedTable, EqualTablesAreShared) {
  const PropertyTable* const table = &shared_table("thing", "/things/<thing>", two_properties());
  EXPECT_EQ(&shared_table("thing", "/things/<thing>", two_properties()), table);
  EXPECT_EQ(table->persistent_width(), 2U);
  EXPECT_NE(&shared_table("other", "/things/<thing>", two_properties()), table);
  EXPECT_NE(&shared_table("thing", "/others/<thing>", two_properties()), table);
}

TEST(SharedTable, AnyDifferenceMakesANewTable) {
  const auto differs = [](void (*change)(Property&)) {
    std::vector<Property> properties = two_properties();
    change(properties[0]);
    return &shared_table("thing", "/things/<thing>", std::move(properties)) !=
           &shared_table("thing", "/things/<thing>", two_properties());
  };
  EXPECT_TRUE(differs([](Property& property) { property.initial[0] = 2; }));
  EXPECT_TRUE(differs([](Property& property) { property.max = 6; }));
  EXPECT_TRUE(differs([](Property& property) { property.doc = "Another."; }));
  EXPECT_TRUE(differs([](Property& property) { property.transient = true; }));
  EXPECT_TRUE(differs([](Property& property) { property.on_change = [](void*) {}; }));
  EXPECT_TRUE(differs([](Property& property) { property.on_write = [](void*, const Property&) {}; }));
}

struct Fixture {
  Store store;
  NodeId first = store.add_group(store.root(), "first");
  int thing = 0;
  int other = 0;
  NodeId id = store.add(shared_table("thing", "/<thing>", two_properties()), store.root(), "it", &thing);
  NodeId last = store.add_group(store.root(), "last");
};

TEST(ChangeTable, KeepsCommonPropertiesClampedToNewRanges) {
  Fixture n;
  ASSERT_TRUE(test::set(n.store, n.id, "size", {4}).ok());
  ASSERT_TRUE(test::set(n.store, n.id, "mode", {2}).ok());
  // The label "auto" is first now, the range of size is smaller, and there is a new property.
  const NodeId id = n.store.change_table(
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
  EXPECT_EQ(n.store.object(id), &n.other);
  // It keeps its position and name.
  EXPECT_EQ(n.store.child(n.store.root(), "it"), id);
  EXPECT_EQ(n.store.children(n.store.root())[1], id);
}

TEST(ChangeTable, OtherTypesAndMissingLabelsGetDefaults) {
  Fixture n;
  ASSERT_TRUE(test::set(n.store, n.id, "size", {4}).ok());
  ASSERT_TRUE(test::set(n.store, n.id, "mode", {0}).ok());
  const NodeId id = n.store.change_table(
      n.id,
      shared_table("thing", "/<thing>",
                   {vec3("size", "m", {1, 2, 3}, 0, 9, "Three sizes."), choice("mode", {"on", "auto"}, 1, "A mode.")}),
      &n.other);
  EXPECT_EQ(test::read(n.store, id, "size"), (Numbers{1, 2, 3}));
  EXPECT_EQ(test::read(n.store, id, "mode"), Numbers{1});
}

TEST(ChangeTable, SameTableKeepsTheId) {
  Fixture n;
  ASSERT_TRUE(test::set(n.store, n.id, "size", {4}).ok());
  const std::uint64_t structure = n.store.structure_version();
  EXPECT_EQ(n.store.change_table(n.id, n.store.table(n.id), &n.other), n.id);
  EXPECT_EQ(n.store.object(n.id), &n.other);
  EXPECT_EQ(n.store.structure_version(), structure);
  EXPECT_TRUE(n.store.change_table({77, 3}, n.store.table(n.id), &n.other).null());
}

TEST(OnWrite, IsCalledAfterEachWrite) {
  static int writes = 0;
  static std::string last;
  std::vector<Property> properties = two_properties();
  for (Property& property : properties) {
    property.on_write = [](void* thing, const Property& property) {
      writes++;
      last = property.name;
      *static_cast<int*>(thing) += 1;
    };
  }
  Store store;
  int thing = 0;
  const NodeId id =
      store.add(shared_table("listener", "/<listener>", std::move(properties)), store.root(), "it", &thing);
  EXPECT_EQ(writes, 0);
  ASSERT_TRUE(test::set(store, id, "size", {1}).ok());  // an equal value
  EXPECT_EQ(writes, 1);
  ASSERT_TRUE(test::set(store, id, "mode", {2}).ok());
  EXPECT_EQ(last, "mode");
  EXPECT_FALSE(test::set(store, id, "mode", {9}).ok());  // rejected: nothing was written
  EXPECT_EQ(writes, 2);
  EXPECT_EQ(thing, 2);
}

}  // namespace
}  // namespace limber

// Path events for added and removed objects.
#include "net/oscquery/path_events.h"

#include <gtest/gtest.h>

#include "properties/store.h"

namespace limber::oscquery {
namespace {

using namespace properties;
using Frames = std::vector<std::string>;

const PropertyTable& first_kind() {
  static const PropertyTable table("kind", "/room/<kind>", "",
                                   {number("a", "", 0, 0, 1, "A."), number("b", "", 0, 0, 1, "B.")});
  return table;
}
// `a` has another range, `b` is removed, `c` is new.
const PropertyTable& second_kind() {
  static const PropertyTable table("kind", "/room/<kind>", "",
                                   {number("a", "", 0, 0, 2, "A."), number("c", "", 0, 0, 1, "C.")});
  return table;
}

struct NoticesFixture {
  Store store;
  NodeId group = store.add_group(store.root(), "room");

  NodeId add(const std::string& name, const PropertyTable& table = first_kind()) {
    return store.add(table, group, name, nullptr);
  }
  TreeSnapshot tree() const { return TreeSnapshot(store); }
};

TEST(PathEvents, IgnoreUnchangedNodes) {
  NoticesFixture fixture;
  fixture.add("x");
  const TreeSnapshot before = fixture.tree();
  EXPECT_EQ(path_events_between(before, fixture.tree()), Frames{});
  // removed and created again, as by a reset: the same addresses
  NoticesFixture again;
  again.add("x");
  EXPECT_EQ(path_events_between(before, again.tree()), Frames{});
}

TEST(PathEvents, ReportTopmostPath) {
  NoticesFixture fixture;
  const NodeId x = fixture.add("x");
  fixture.add("y");
  const TreeSnapshot before = fixture.tree();
  fixture.store.remove(x);
  const NodeId z = fixture.add("my z");
  fixture.store.add(first_kind(), z, "within", nullptr);
  EXPECT_EQ(path_events_between(before, fixture.tree()), (Frames{R"({"COMMAND":"PATH_ADDED","DATA":"/room/my%20z"})",
                                                                 R"({"COMMAND":"PATH_REMOVED","DATA":"/room/x"})"}));
}

TEST(PathEvents, ReportChangedProperties) {
  NoticesFixture fixture;
  const NodeId x = fixture.add("x");
  const TreeSnapshot before = fixture.tree();
  fixture.store.change_table(x, second_kind(), nullptr);
  EXPECT_EQ(path_events_between(before, fixture.tree()), (Frames{R"({"COMMAND":"PATH_REMOVED","DATA":"/room/x/b"})",
                                                                 R"({"COMMAND":"PATH_CHANGED","DATA":"/room/x/a"})",
                                                                 R"({"COMMAND":"PATH_ADDED","DATA":"/room/x/c"})"}));
}

TEST(PathEvents, MergeTooMany) {
  NoticesFixture fixture;
  const TreeSnapshot before = fixture.tree();
  for (std::size_t i = 0; i < kMaxPathEvents; i++) fixture.add("n" + std::to_string(i));
  EXPECT_EQ(path_events_between(before, fixture.tree()).size(), kMaxPathEvents);
  fixture.add("one more");
  EXPECT_EQ(path_events_between(before, fixture.tree()), Frames{R"({"COMMAND":"PATH_CHANGED","DATA":"/room"})"});
  fixture.store.add_group(fixture.store.root(), "roof");
  EXPECT_EQ(path_events_between(before, fixture.tree()), Frames{R"({"COMMAND":"PATH_CHANGED","DATA":"/"})"});
}

}  // namespace
}  // namespace limber::oscquery

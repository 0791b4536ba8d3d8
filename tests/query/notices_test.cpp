// What is told of things that come and go.
#include "query/notices.h"

#include <gtest/gtest.h>

#include "params/store.h"

namespace limber {
namespace {

using namespace rows;
using Frames = std::vector<std::string>;

const Table& first_kind() {
  static const Table table("kind", "/room/<kind>", "",
                           {number("a", "", 0, 0, 1, "A."), number("b", "", 0, 0, 1, "B.")});
  return table;
}
// `a` has another range, `b` is gone, `c` is new
const Table& second_kind() {
  static const Table table("kind", "/room/<kind>", "",
                           {number("a", "", 0, 0, 2, "A."), number("c", "", 0, 0, 1, "C.")});
  return table;
}

struct Room {
  Store store;
  NodeId room = store.add_group(store.root(), "room");

  NodeId add(const std::string& name, const Table& table = first_kind()) {
    return store.add(table, room, name, nullptr);
  }
  Tree tree() const { return Tree(store); }
};

TEST(Notices, NothingOfWhatStayed) {
  Room room;
  room.add("x");
  const Tree before = room.tree();
  EXPECT_EQ(notices_between(before, room.tree()), Frames{});
  // removed and made anew, as a reset does: the same addresses
  Room again;
  again.add("x");
  EXPECT_EQ(notices_between(before, again.tree()), Frames{});
}

TEST(Notices, TheTopmostOfWhatCameAndWent) {
  Room room;
  const NodeId x = room.add("x");
  room.add("y");
  const Tree before = room.tree();
  room.store.remove(x);
  const NodeId z = room.add("my z");
  room.store.add(first_kind(), z, "within", nullptr);
  EXPECT_EQ(notices_between(before, room.tree()), (Frames{R"({"COMMAND":"PATH_ADDED","DATA":"/room/my%20z"})",
                                                          R"({"COMMAND":"PATH_REMOVED","DATA":"/room/x"})"}));
}

TEST(Notices, RowsOfAThingThatIsOfAnotherKindNow) {
  Room room;
  const NodeId x = room.add("x");
  const Tree before = room.tree();
  room.store.retable(x, second_kind(), nullptr);
  EXPECT_EQ(notices_between(before, room.tree()), (Frames{R"({"COMMAND":"PATH_REMOVED","DATA":"/room/x/b"})",
                                                          R"({"COMMAND":"PATH_CHANGED","DATA":"/room/x/a"})",
                                                          R"({"COMMAND":"PATH_ADDED","DATA":"/room/x/c"})"}));
}

TEST(Notices, TooManyAreOne) {
  Room room;
  const Tree before = room.tree();
  for (std::size_t i = 0; i < kMostNotices; i++) room.add("n" + std::to_string(i));
  EXPECT_EQ(notices_between(before, room.tree()).size(), kMostNotices);
  room.add("one more");
  EXPECT_EQ(notices_between(before, room.tree()), Frames{R"({"COMMAND":"PATH_CHANGED","DATA":"/room"})"});
  room.store.add_group(room.store.root(), "roof");
  EXPECT_EQ(notices_between(before, room.tree()), Frames{R"({"COMMAND":"PATH_CHANGED","DATA":"/"})"});
}

}  // namespace
}  // namespace limber

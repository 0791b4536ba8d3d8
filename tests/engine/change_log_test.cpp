// The log of changes: gestures are merged into one line, floods are counted, the oldest lines are dropped.
#include "engine/edits/change_log.h"

#include "engine/edits/change_recorder.h"

#include "engine/show.h"

namespace limber::engine::test {
namespace {

struct ChangeRecorderTest : ::testing::Test {
  PropertyTable table{
      "thing", "/thing", "", {properties::number("a", "", 1, -100, 100, ""), properties::boolean("on", false, "")}};
  Store store;
  std::vector<NodeId> nodes;
  ChangeLog log;
  ChangeRecorder recorder{log};
  CommandOrigin source{CommandSource::console};

  ChangeRecorderTest() {
    for (int i = 0; i < 100; i++) nodes.push_back(store.add(table, store.root(), fmt::format("t{}", i), nullptr));
  }
  void set(std::size_t node, const char* property_name, double value, double time) {
    recorder.begin(source, time);
    recorder.on_write(nodes[node], table.at(property_name), store.values(nodes[node], table.at(property_name)));
    ASSERT_TRUE(store.set(nodes[node], property_name, {&value, 1}).ok());
  }
  std::vector<std::string> lines(double since = 0) const {
    std::vector<std::string> texts;
    for (const ChangeEntry& line : log.since(since))
      texts.push_back(fmt::format("{:g} {} {} {}>{}", line.time, line.source, line.path, line.from, line.to));
    return texts;
  }
};

using Lines = std::vector<std::string>;

TEST_F(ChangeRecorderTest, MergesAGestureIntoOneLine) {
  set(0, "a", 2, 10);
  set(0, "a", 3, 10.01);
  recorder.flush(store);
  EXPECT_EQ(lines(), Lines{"10.01 console /t0/a 1>3"});
  set(0, "a", 4, 10.4);
  set(1, "on", 1, 10.4);
  set(2, "a", 1, 10.4);  // unchanged
  recorder.flush(store);
  EXPECT_EQ(lines(), (Lines{"10.4 console /t0/a 1>4", "10.4 console /t1/on false>true"}));
  set(0, "a", 5, 11);  // after the merge interval
  recorder.flush(store);
  source = {CommandSource::panel};
  set(0, "a", 6, 11.1);  // another source
  recorder.flush(store);
  EXPECT_EQ(lines(11), (Lines{"11 console /t0/a 4>5", "11.1 panel /t0/a 5>6"}));
}

TEST_F(ChangeRecorderTest, CountsAFloodAndSkipsRemovedObjects) {
  for (std::size_t i = 0; i < 100; i++) set(i, "a", 2, 1);
  store.remove(nodes[0]);
  recorder.flush(store);
  const Lines all_lines = lines();
  EXPECT_LE(all_lines.size(), ChangeRecorder::kMaxPerTick + 1);
  EXPECT_GT(all_lines.size(), 10u);
  EXPECT_EQ(all_lines.back(), fmt::format("1 console ({} more values) >", 100 - all_lines.size()));
  for (const std::string& line : all_lines) EXPECT_EQ(line.find("/t0/"), std::string::npos);
}

TEST(ChangeLog, DropsTheOldestLines) {
  ChangeLog log;
  const std::uint64_t first = log.add({0, 1, "console", "/a", "1", "2", 0});
  for (std::size_t i = 1; i < ChangeLog::kMaxEntries; i++) log.add({0, 2, "console", "/b", "1", "2", 0});
  EXPECT_TRUE(log.update(first, 3, "4"));
  EXPECT_EQ(log.since(3).size(), 1u);
  EXPECT_EQ(log.after(ChangeLog::kMaxEntries).size(), 1u) << "updated lines are returned";
  EXPECT_EQ(log.after(ChangeLog::kMaxEntries - 1).back().to, "4");
  log.add({0, 2, "console", "/b", "1", "2", 0});
  EXPECT_FALSE(log.update(first, 4, "5"));
  EXPECT_EQ(log.since(0).size(), ChangeLog::kMaxEntries);
  EXPECT_TRUE(log.since(3).empty());
}

}  // namespace
}  // namespace limber::engine::test

// The log of what hands have set: gestures make one line, a flood is counted, the oldest lines go.
#include "engine/change_log.h"

#include "engine/change_notes.h"

#include "engine/show.h"

namespace limber::engine_test {
namespace {

struct Noted : ::testing::Test {
  Table table{"thing", "/thing", "", {rows::number("a", "", 1, -100, 100, ""), rows::boolean("on", false, "")}};
  Store store;
  std::vector<NodeId> things;
  ChangeLog log;
  ChangeNotes notes{log};
  Origin hand{Hand::console};

  Noted() {
    for (int i = 0; i < 100; i++) things.push_back(store.add(table, store.root(), fmt::format("t{}", i), nullptr));
  }
  void set(std::size_t thing, const char* row, double value, double time) {
    notes.begin(hand, time);
    notes.heard(things[thing], table.at(row), store.values(things[thing], table.at(row)));
    ASSERT_TRUE(store.set(things[thing], row, {&value, 1}).ok());
  }
  std::vector<std::string> lines(double since = 0) const {
    std::vector<std::string> texts;
    for (const ChangeLine& line : log.since(since))
      texts.push_back(fmt::format("{:g} {} {} {}>{}", line.time, line.who, line.path, line.from, line.to));
    return texts;
  }
};

using Lines = std::vector<std::string>;

TEST_F(Noted, AGestureIsOneLine) {
  set(0, "a", 2, 10);
  set(0, "a", 3, 10.01);
  notes.tell(store);
  EXPECT_EQ(lines(), Lines{"10.01 console /t0/a 1>3"});
  set(0, "a", 4, 10.4);
  set(1, "on", 1, 10.4);
  set(2, "a", 1, 10.4);  // as it is
  notes.tell(store);
  EXPECT_EQ(lines(), (Lines{"10.4 console /t0/a 1>4", "10.4 console /t1/on false>true"}));
  set(0, "a", 5, 11);  // later than a gesture lasts
  notes.tell(store);
  hand = {Hand::panel};
  set(0, "a", 6, 11.1);  // another hand
  notes.tell(store);
  EXPECT_EQ(lines(11), (Lines{"11 console /t0/a 4>5", "11.1 panel /t0/a 5>6"}));
}

TEST_F(Noted, AFloodIsCountedAndThingsThatHaveGoneAreNot) {
  for (std::size_t i = 0; i < 100; i++) set(i, "a", 2, 1);
  store.remove(things[0]);
  notes.tell(store);
  const Lines all = lines();
  EXPECT_LE(all.size(), ChangeNotes::kMostATick + 1);
  EXPECT_GT(all.size(), 10u);
  EXPECT_EQ(all.back(), fmt::format("1 console ({} more values) >", 100 - all.size()));
  for (const std::string& line : all) EXPECT_EQ(line.find("/t0/"), std::string::npos);
}

TEST(ChangeLog, TheOldestLinesGo) {
  ChangeLog log;
  const std::uint64_t first = log.add({0, 1, "console", "/a", "1", "2", 0});
  for (std::size_t i = 1; i < ChangeLog::kMostLines; i++) log.add({0, 2, "console", "/b", "1", "2", 0});
  EXPECT_TRUE(log.renew(first, 3, "4"));
  EXPECT_EQ(log.since(3).size(), 1u);
  EXPECT_EQ(log.after(ChangeLog::kMostLines).size(), 1u) << "what was renewed is news";
  EXPECT_EQ(log.after(ChangeLog::kMostLines - 1).back().to, "4");
  log.add({0, 2, "console", "/b", "1", "2", 0});
  EXPECT_FALSE(log.renew(first, 4, "5"));
  EXPECT_EQ(log.since(0).size(), ChangeLog::kMostLines);
  EXPECT_TRUE(log.since(3).empty());
}

}  // namespace
}  // namespace limber::engine_test

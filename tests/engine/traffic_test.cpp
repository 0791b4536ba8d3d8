// What went in and out: kept while somebody watches, bounded, as text for people.
#include "engine/traffic.h"

#include <gtest/gtest.h>

#include <memory>

namespace limber {
namespace {

TEST(Traffic, IsKeptWhileSomebodyWatches) {
  Traffic traffic;
  EXPECT_FALSE(traffic.watched());
  {
    const Traffic::Watch one(traffic);
    auto other = std::make_unique<Traffic::Watch>(traffic);
    other.reset();
    EXPECT_TRUE(traffic.watched());
    traffic.note(true, "127.0.0.1:5", {"/a", {Arg::of(1.0)}});
    traffic.note(false, "127.0.0.1:6", {"/b", {}});
  }
  EXPECT_FALSE(traffic.watched());
  const std::vector<TrafficLine> all = traffic.since(0);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].number, 1u);
  EXPECT_TRUE(all[0].in);
  EXPECT_EQ(all[0].end, "127.0.0.1:5");
  EXPECT_FALSE(all[1].in);
  EXPECT_LE(all[0].time, all[1].time);
  EXPECT_EQ(traffic.newest(), 2u);
  ASSERT_EQ(traffic.since(1).size(), 1u);
  EXPECT_EQ(traffic.since(1)[0].message.address, "/b");
  EXPECT_TRUE(traffic.since(2).empty());
}

TEST(Traffic, TheOldestGoWhenThereAreTooMany) {
  Traffic traffic;
  for (std::size_t i = 0; i < Traffic::kMostLines + 10; i++) traffic.note(true, "", {"/a", {}});
  std::vector<TrafficLine> all = traffic.since(0);
  EXPECT_EQ(all.size(), Traffic::kMostLines);
  EXPECT_EQ(all.front().number, 11u);
  // large messages count by their bytes
  Message large{"/large", {}};
  large.args.assign(5000, Arg::of(1.0));
  for (int i = 0; i < 100; i++) traffic.note(true, "", large);
  all = traffic.since(0);
  EXPECT_LT(all.size() * 5000 * sizeof(Arg), Traffic::kMostBytes + 5000 * sizeof(Arg));
  EXPECT_GE(all.size(), 10u);
}

TEST(Traffic, MessagesAsText) {
  EXPECT_EQ(message_text({"/a/b", {}}), "/a/b");
  EXPECT_EQ(message_text({"/m", {Arg::of("arm"), Arg::of(0.3), Arg::of(true), Arg{}}}), "/m arm 0.3 true nil");
  EXPECT_EQ(message_text({"/m", {Arg::of(1.0 / 3), Arg::of(12.0)}}), "/m 0.33333 12");
  EXPECT_EQ(message_text({"/m", {Arg::of("two words"), Arg::of("")}}), "/m \"two words\" \"\"");
  EXPECT_EQ(message_text({"/m\x1b", {Arg::of("\x07")}}), "/m\\x1b \\x07") << "nothing steers a terminal";
  Message many{"/m", {}};
  many.args.assign(20, Arg::of(1.0));
  EXPECT_EQ(message_text(many), "/m 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 … (20 in all)");
}

}  // namespace
}  // namespace limber

// The message log: enabled by a watcher, bounded, as readable text.
#include "engine/output/message_log.h"

#include <gtest/gtest.h>

#include <memory>

namespace limber::engine {
namespace {

TEST(MessageLog, IsEnabledByAWatcher) {
  MessageLog message_log;
  EXPECT_FALSE(message_log.enabled());
  {
    const MessageLog::Watch one(message_log);
    auto other = std::make_unique<MessageLog::Watch>(message_log);
    other.reset();
    EXPECT_TRUE(message_log.enabled());
    message_log.add(true, "127.0.0.1:5", {"/a", {Arg::of(1.0)}});
    message_log.add(false, "127.0.0.1:6", {"/b", {}});
  }
  EXPECT_FALSE(message_log.enabled());
  const std::vector<LoggedMessage> all = message_log.since(0);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].number, 1u);
  EXPECT_TRUE(all[0].incoming);
  EXPECT_EQ(all[0].peer, "127.0.0.1:5");
  EXPECT_FALSE(all[1].incoming);
  EXPECT_LE(all[0].time, all[1].time);
  EXPECT_EQ(message_log.newest(), 2u);
  ASSERT_EQ(message_log.since(1).size(), 1u);
  EXPECT_EQ(message_log.since(1)[0].message.address, "/b");
  EXPECT_TRUE(message_log.since(2).empty());
}

TEST(MessageLog, DropsTheOldestEntries) {
  MessageLog message_log;
  for (std::size_t i = 0; i < MessageLog::kMaxEntries + 10; i++) message_log.add(true, "", {"/a", {}});
  std::vector<LoggedMessage> all = message_log.since(0);
  EXPECT_EQ(all.size(), MessageLog::kMaxEntries);
  EXPECT_EQ(all.front().number, 11u);
  // large messages count by their bytes
  Message large{"/large", {}};
  large.args.assign(5000, Arg::of(1.0));
  for (int i = 0; i < 100; i++) message_log.add(true, "", large);
  all = message_log.since(0);
  EXPECT_LT(all.size() * 5000 * sizeof(Arg), MessageLog::kMaxBytes + 5000 * sizeof(Arg));
  EXPECT_GE(all.size(), 10u);
}

TEST(MessageLog, FormatsMessages) {
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
}  // namespace limber::engine

// The log's ring: numbered lines, the last 1000 lines, counts per level, escaped control characters.
#include "base/log/log.h"

#include <gtest/gtest.h>

#include <thread>

namespace limber {
namespace {

struct Log : testing::Test {
  Log() { log_to_stderr(false); }
  ~Log() override { log_to_stderr(true); }
  static std::uint64_t newest() {
    const std::vector<LogLine> lines = log_since(0);
    return lines.empty() ? 0 : lines.back().number;
  }
};

TEST_F(Log, ReturnsNewerLines) {
  const std::uint64_t seen = newest();
  log_info("one {}", 1);
  log_warning("two");
  log_error("three");
  const std::vector<LogLine> lines = log_since(seen);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].text, "one 1");
  EXPECT_EQ(lines[0].level, LogLevel::info);
  EXPECT_EQ(lines[1].level, LogLevel::warning);
  EXPECT_EQ(lines[2].level, LogLevel::error);
  EXPECT_EQ(lines[2].number, seen + 3);
  EXPECT_EQ(log_since(seen + 2).size(), 1u);
  EXPECT_TRUE(log_since(seen + 3).empty());
  EXPECT_TRUE(log_since(seen + 1000000).empty());
}

TEST_F(Log, KeepsTheLastThousand) {
  const std::uint64_t seen = newest();
  for (int i = 1; i <= 1005; i++) log_info("line {}", i);
  const std::vector<LogLine> lines = log_since(seen);
  ASSERT_EQ(lines.size(), 1000u);
  EXPECT_EQ(lines.front().text, "line 6");
  EXPECT_EQ(lines.back().text, "line 1005");
  for (std::size_t i = 1; i < lines.size(); i++) ASSERT_EQ(lines[i].number, lines[i - 1].number + 1);
}

TEST_F(Log, CountsPerLevel) {
  const std::uint64_t infos = log_count(LogLevel::info);
  const std::uint64_t warnings = log_count(LogLevel::warning);
  const std::uint64_t errors = log_count(LogLevel::error);
  log_warning("a");
  log_warning("b");
  log_error("c");
  EXPECT_EQ(log_count(LogLevel::info), infos);
  EXPECT_EQ(log_count(LogLevel::warning), warnings + 2);
  EXPECT_EQ(log_count(LogLevel::error), errors + 1);
}

TEST_F(Log, EscapesControlCharacters) {
  log_info("{}", "\x1b[31mred\x07");
  EXPECT_EQ(log_since(0).back().text, "\\x1b[31mred\\x07");
}

TEST_F(Log, WritesTheLevelToStderrUnlessSilenced) {
  testing::internal::CaptureStderr();
  log_error("not shown");
  log_to_stderr(true);
  log_info("plain");
  log_warning("careful");
  log_error("broken");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "limber: plain\nlimber: warning: careful\nlimber: error: broken\n");
}

TEST_F(Log, StoresPrintedLinesInTheRingOnly) {
  const std::uint64_t seen = log_newest();
  EXPECT_EQ(seen, newest());
  log_to_stderr(true);
  testing::internal::CaptureStderr();
  log_line(LogLevel::print, "a script's");
  log_line(LogLevel::print, std::string(1000000, 'x'));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const std::vector<LogLine> lines = log_since(seen);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "a script's");
  EXPECT_EQ(lines[0].level, LogLevel::print);
  EXPECT_EQ(lines[1].text.size(), 4096u) << "long lines are shortened";
  EXPECT_EQ(log_newest(), seen + 2);
}

TEST_F(Log, AcceptsLinesFromAnyThread) {
  const std::uint64_t seen = newest();
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; t++) {
    threads.emplace_back([] {
      for (int i = 0; i < 200; i++) log_info("{}", i);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(log_since(seen).size(), 800u);
}

}  // namespace
}  // namespace limber

// Rate limits of the log.
#include "base/log/log_throttle.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/log/output.h"
#include "base/text.h"

namespace limber {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(TokenBucket, AllowsABurstThenOnePerInterval) {
  TokenBucket bucket(3, 10);
  EXPECT_TRUE(bucket.try_consume(1000));
  EXPECT_TRUE(bucket.try_consume(1000));
  EXPECT_TRUE(bucket.try_consume(1001));
  EXPECT_FALSE(bucket.try_consume(1009));
  EXPECT_TRUE(bucket.try_consume(1010));
  EXPECT_FALSE(bucket.try_consume(1019));
  EXPECT_TRUE(bucket.try_consume(1020));
  EXPECT_FALSE(bucket.try_consume(1015)) << "no token if the clock steps back";
  for (int i = 0; i < 3; i++) EXPECT_TRUE(bucket.try_consume(5000)) << "the bucket refills in a pause";
  EXPECT_FALSE(bucket.try_consume(5000));
}

TEST(LogThrottle, AllowsASourceTenLinesThenOneAMinute) {
  LogThrottle throttle;
  const std::uint64_t source = log_source("scene.lua:3: fails");
  int written = 0;
  std::uint64_t reported = 0;
  const int day = 86400;
  for (int i = 0; i < day * 100; i++) {  // at 100 Hz
    const auto more = throttle.admit(source, i * kSecond / 100);
    if (!more) continue;
    written++;
    reported += *more;
  }
  EXPECT_EQ(written, LogThrottle::kBurst + day / 60 - 1);
  EXPECT_EQ(written + throttle.suppressed(), day * 100U);
  EXPECT_LE(throttle.suppressed() - reported, 6000U) << "each line reports the number suppressed before it";
}

TEST(LogThrottle, SourcesAreIndependent) {
  LogThrottle throttle;
  for (int i = 0; i < 1000; i++) (void)throttle.admit(1, i);
  for (int i = 0; i < LogThrottle::kBurst; i++) EXPECT_EQ(throttle.admit(2, 1000), 0U);
  EXPECT_EQ(throttle.admit(2, 1000), std::nullopt);
  EXPECT_EQ(throttle.admit(1, 61 * kSecond), 990U);
  EXPECT_EQ(throttle.admit(2, 61 * kSecond), 1U);
}

TEST(LogThrottle, ResetsSourcesButNotTheTotalLimit) {
  LogThrottle throttle;
  int written = 0;
  for (int i = 0; i < 1000; i++) {
    for (int k = 0; k < 20; k++) written += throttle.admit(7, 5) ? 1 : 0;
    throttle.forget_sources();
  }
  EXPECT_EQ(written, LogThrottle::kTotalBurst);
}

TEST(LogThrottle, LimitsAllSourcesTogether) {
  LogThrottle throttle;
  std::uint64_t written = 0;
  const int seconds = 3600;
  for (int i = 0; i < seconds * 100; i++) {  // each line has a different source
    if (throttle.admit(static_cast<std::uint64_t>(i), i * kSecond / 100)) written++;
  }
  EXPECT_NEAR(static_cast<double>(written), LogThrottle::kTotalBurst + seconds * 2, 2);
}

TEST(LogSource, IgnoresMeasuredValuesButNotNames) {
  const auto same = [](std::string_view a, std::string_view b) { return log_source(a) == log_source(b); };
  EXPECT_TRUE(same("target 1.25 is outside -3..4.5", "target 0.1 is outside -17..1e9"));
  EXPECT_TRUE(same("limited to 5 m/s (12 times)", "limited to 6 m/s (9 times)"));
  EXPECT_FALSE(same("body 'arm1': too fast", "body 'arm2': too fast"));
  EXPECT_FALSE(same("body 'arm 1': too fast", "body 'arm 2': too fast"));
  EXPECT_FALSE(same("scene.lua:12: no", "scene.lua:13: no"));
  EXPECT_FALSE(same("from 10.0.0.1:9003: no", "from 10.0.0.1:9004: no"));
  EXPECT_TRUE(same("it can't take 3 of them", "it can't take 4 of them")) << "an apostrophe opens no quote";
  EXPECT_FALSE(same("one thing", "another"));
}

// Returns the log's output on standard error.
template <class Function>
std::vector<std::string> lines_on_stderr(Function function) {
  testing::internal::CaptureStderr();
  function();
  std::vector<std::string> lines;
  const std::string text = testing::internal::GetCapturedStderr();
  for (const std::string_view line : split(text, '\n')) {
    if (!line.empty()) lines.emplace_back(line);
  }
  return lines;
}

TEST(LogLimit, AppliesPerLevelAndIgnoresMeasuredValues) {
  const std::uint64_t before = log_newest();
  const auto lines = lines_on_stderr([] {
    for (int i = 0; i < 500; i++) {
      log_info("throttle test: {} info", i);
      log_warning("throttle test: {} warning", i * 0.25);
      log_error("throttle test: {} error", -1 - i);
    }
  });
  EXPECT_EQ(lines.size(), 30U);
  EXPECT_EQ(lines.back(), "limber: error: throttle test: -10 error");
  EXPECT_EQ(log_newest(), before + 1500) << "the panel gets every line";
  EXPECT_GE(log_suppressed(), 1470U);
}

TEST(LogLimit, AppliesToAPlaceWithAnyText) {
  const auto lines = lines_on_stderr([] {
    for (int i = 0; i < 500; i++) log_line(LogLevel::error, std::string(1 + i % 100, 'q'), "throttle.lua:7");
  });
  EXPECT_EQ(lines.size(), 10U);
}

TEST(LogLimit, PrintIsNotLimitedInBatchMode) {
  testing::internal::CaptureStdout();
  for (int i = 0; i < 5000; i++) log_print("line", OutputTo::out);
  EXPECT_EQ(testing::internal::GetCapturedStdout().size(), 25000U);
}

}  // namespace
}  // namespace limber

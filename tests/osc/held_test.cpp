// Time tags: which commands are scheduled, for how long, and in which order they become due.
#include "net/osc/scheduled_commands.h"

#include <gtest/gtest.h>

#include "osc/osc_test_tools.h"

namespace limber::osc {
namespace {

using namespace test;
using Handling = ScheduledCommands::ScheduleResult;

constexpr std::uint64_t kSecond = std::uint64_t{1} << 32;

engine::Command command(double number) { return {{{"/n", {Arg::of(number)}}}, {}}; }

std::vector<double> consume_due(ScheduledCommands& scheduled) {
  std::vector<double> numbers;
  while (const auto c = scheduled.pop_due()) numbers.push_back(c->messages.at(0).args.at(0).number);
  return numbers;
}

TEST(ScheduledCommands, AcceptsOnlyNearFuture) {
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  ScheduledCommands scheduled(clock);
  engine::Command c = command(1);
  EXPECT_EQ(scheduled.schedule(1, c), Handling::now);
  EXPECT_EQ(scheduled.schedule(manual_clock.ntp, c), Handling::now);
  EXPECT_EQ(scheduled.schedule(manual_clock.ntp - kSecond, c), Handling::now);
  EXPECT_EQ(scheduled.schedule(manual_clock.ntp + 10 * kSecond + 1, c), Handling::too_far);
  EXPECT_EQ(scheduled.schedule(~std::uint64_t{0}, c), Handling::too_far);
  EXPECT_EQ(c.messages.size(), 1u) << "moved although it was not scheduled";
  EXPECT_FALSE(scheduled.timeout());
  EXPECT_EQ(scheduled.schedule(manual_clock.ntp + 10 * kSecond, c), Handling::scheduled);
}

TEST(ScheduledCommands, LimitsBytes) {
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  ScheduledCommands scheduled(clock);
  const std::string large(ScheduledCommands::kMaxBytes / 2, 'x');
  const auto offer = [&] {
    engine::Command c{{{"/n", {Arg::of(std::string_view(large))}}}, {}};
    return scheduled.schedule(manual_clock.ntp + kSecond, c);
  };
  EXPECT_EQ(offer(), Handling::scheduled);
  EXPECT_EQ(offer(), Handling::full) << "the overhead counts too";
  manual_clock.advance(1);
  ASSERT_TRUE(scheduled.pop_due());
  EXPECT_EQ(offer(), Handling::scheduled) << "delivered commands do not count";
}

TEST(ScheduledCommands, OrdersByTagThenArrival) {
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  ScheduledCommands scheduled(clock);
  const std::pair<double, double> given[] = {{3, 0.75}, {1, 0.25}, {4, 0.75}, {2, 0.5}};
  for (const auto& [number, seconds] : given) {
    engine::Command c = command(number);
    EXPECT_EQ(scheduled.schedule(manual_clock.ntp + static_cast<std::uint64_t>(seconds * 4294967296.0), c),
              Handling::scheduled);
  }
  EXPECT_TRUE(consume_due(scheduled).empty());
  EXPECT_EQ(scheduled.timeout(), 250'000'001);
  manual_clock.advance(0.25);
  EXPECT_EQ(scheduled.timeout(), 0);
  EXPECT_EQ(consume_due(scheduled), std::vector<double>{1});
  EXPECT_EQ(scheduled.timeout(), 250'000'001);
  manual_clock.advance(0.5);
  EXPECT_EQ(consume_due(scheduled), (std::vector<double>{2, 3, 4}));
  EXPECT_FALSE(scheduled.timeout());
}

TEST(ScheduledCommands, ReportsFullSchedule) {
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  ScheduledCommands scheduled(clock);
  for (std::size_t i = 0; i < 1024; i++) {
    engine::Command c = command(0);
    ASSERT_EQ(scheduled.schedule(manual_clock.ntp + kSecond, c), Handling::scheduled);
  }
  engine::Command c = command(0);
  EXPECT_EQ(scheduled.schedule(manual_clock.ntp + kSecond, c), Handling::full);
  EXPECT_EQ(scheduled.size(), 1024u);
}

// The system clock is set back by an hour: scheduled commands become due ten seconds after their arrival at the latest.
TEST(ScheduledCommands, SurvivesClockSetBack) {
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  ScheduledCommands scheduled(clock);
  engine::Command c = command(1);
  ASSERT_EQ(scheduled.schedule(manual_clock.ntp + kSecond, c), Handling::scheduled);
  manual_clock.ntp -= 3600 * kSecond;
  EXPECT_EQ(scheduled.timeout(), 10'000'000'000);
  manual_clock.advance(9.999);
  EXPECT_TRUE(consume_due(scheduled).empty());
  manual_clock.advance(0.001);
  EXPECT_EQ(consume_due(scheduled), std::vector<double>{1});
}

// Ten seconds ahead: the timeout does not overflow.
TEST(ScheduledCommands, LongestTimeoutDoesNotOverflow) {
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  ScheduledCommands scheduled(clock);
  engine::Command c = command(1);
  ASSERT_EQ(scheduled.schedule(manual_clock.ntp + 10 * kSecond, c), Handling::scheduled);
  EXPECT_EQ(scheduled.timeout(), 10'000'000'000);
}

}  // namespace
}  // namespace limber::osc

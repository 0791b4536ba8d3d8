// Time tags: what waits, how long, and in which order it comes.
#include "osc/held.h"

#include <gtest/gtest.h>

#include "osc/osc_test_tools.h"

namespace limber {
namespace {

using namespace osc_test;
using Verdict = HeldCommands::Verdict;

constexpr std::uint64_t kSecond = std::uint64_t{1} << 32;

Command command(double number) { return {{{"/n", {Arg::of(number)}}}, {}}; }

std::vector<double> all_due(HeldCommands& held) {
  std::vector<double> numbers;
  while (const auto c = held.due()) numbers.push_back(c->messages.at(0).args.at(0).number);
  return numbers;
}

TEST(Held, NowPastAndFarDoNotWait) {
  HandClock hand;
  const NetClock clock = hand.clock();
  HeldCommands held(clock);
  Command c = command(1);
  EXPECT_EQ(held.offer(1, c), Verdict::now);
  EXPECT_EQ(held.offer(hand.ntp, c), Verdict::now);
  EXPECT_EQ(held.offer(hand.ntp - kSecond, c), Verdict::now);
  EXPECT_EQ(held.offer(hand.ntp + 10 * kSecond + 1, c), Verdict::far);
  EXPECT_EQ(held.offer(~std::uint64_t{0}, c), Verdict::far);
  EXPECT_EQ(c.messages.size(), 1u) << "taken although it does not wait";
  EXPECT_FALSE(held.wait());
  EXPECT_EQ(held.offer(hand.ntp + 10 * kSecond, c), Verdict::held);
}

TEST(Held, BytesAreBoundedToo) {
  HandClock hand;
  const NetClock clock = hand.clock();
  HeldCommands held(clock);
  const std::string large(HeldCommands::kMostBytes / 2, 'x');
  const auto offer = [&] {
    Command c{{{"/n", {Arg::of(std::string_view(large))}}}, {}};
    return held.offer(hand.ntp + kSecond, c);
  };
  EXPECT_EQ(offer(), Verdict::held);
  EXPECT_EQ(offer(), Verdict::full) << "two halves and what surrounds them are more than the whole";
  hand.turn(1);
  ASSERT_TRUE(held.due());
  EXPECT_EQ(offer(), Verdict::held) << "what went weighs no more";
}

TEST(Held, ComesInOrderOfTagsThenOfArrival) {
  HandClock hand;
  const NetClock clock = hand.clock();
  HeldCommands held(clock);
  const std::pair<double, double> given[] = {{3, 0.75}, {1, 0.25}, {4, 0.75}, {2, 0.5}};
  for (const auto& [number, seconds] : given) {
    Command c = command(number);
    EXPECT_EQ(held.offer(hand.ntp + static_cast<std::uint64_t>(seconds * 4294967296.0), c), Verdict::held);
  }
  EXPECT_TRUE(all_due(held).empty());
  EXPECT_EQ(held.wait(), 250'000'001);
  hand.turn(0.25);
  EXPECT_EQ(held.wait(), 0);
  EXPECT_EQ(all_due(held), std::vector<double>{1});
  EXPECT_EQ(held.wait(), 250'000'001);
  hand.turn(0.5);
  EXPECT_EQ(all_due(held), (std::vector<double>{2, 3, 4}));
  EXPECT_FALSE(held.wait());
}

TEST(Held, FullIsSaid) {
  HandClock hand;
  const NetClock clock = hand.clock();
  HeldCommands held(clock);
  for (std::size_t i = 0; i < 1024; i++) {
    Command c = command(0);
    ASSERT_EQ(held.offer(hand.ntp + kSecond, c), Verdict::held);
  }
  Command c = command(0);
  EXPECT_EQ(held.offer(hand.ntp + kSecond, c), Verdict::full);
  EXPECT_EQ(held.size(), 1024u);
}

// the system's clock is turned back an hour: what waits still comes, ten seconds after it arrived at the latest
TEST(Held, SystemClockTurnedBack) {
  HandClock hand;
  const NetClock clock = hand.clock();
  HeldCommands held(clock);
  Command c = command(1);
  ASSERT_EQ(held.offer(hand.ntp + kSecond, c), Verdict::held);
  hand.ntp -= 3600 * kSecond;
  EXPECT_EQ(held.wait(), 10'000'000'000);
  hand.turn(9.999);
  EXPECT_TRUE(all_due(held).empty());
  hand.turn(0.001);
  EXPECT_EQ(all_due(held), std::vector<double>{1});
}

// ten seconds ahead: no overflow in the wait
TEST(Held, LongestWait) {
  HandClock hand;
  const NetClock clock = hand.clock();
  HeldCommands held(clock);
  Command c = command(1);
  ASSERT_EQ(held.offer(hand.ntp + 10 * kSecond, c), Verdict::held);
  EXPECT_EQ(held.wait(), 10'000'000'000);
}

}  // namespace
}  // namespace limber

// The clock's schedule with times that the test turns: pace, catching up, letting go, saying once that it is late.
#include "engine/clock.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

using namespace std::chrono_literals;
using Time = Clock::Time;

constexpr double kTick = 1.0 / 64;  // exact in binary, and in nanoseconds: 15 625 000

Time at(double seconds) { return Time(std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9))); }
double seconds(Time t) { return std::chrono::duration<double>(t.time_since_epoch()).count(); }

// plays until `until` on a machine whose ticks cost `cost` seconds each; gives how many ticks there were
int play(Clock& clock, double& now, double until, double cost, double speed = 1) {
  int ticks = 0;
  while (true) {
    now = std::max(now, seconds(clock.due()));
    if (now >= until) return ticks;
    clock.tick(at(now), kTick, speed);
    now += cost;
    ticks++;
  }
}

TEST(Clock, KeepsThePaceWhateverTheTicksCost) {
  for (const double cost : {0.0, 0.001, 0.015}) {
    Clock clock;
    double now = 100;
    clock.restart(at(now));
    EXPECT_EQ(play(clock, now, 110, cost), 640) << cost;
    EXPECT_NEAR(clock.speed_reached(), 1, 0.001) << cost;
    EXPECT_FALSE(clock.take_late());
  }
}

TEST(Clock, SpeedStretchesTime) {
  Clock clock;
  double now = 5;
  clock.restart(at(now));
  EXPECT_EQ(play(clock, now, 6, 0, 4), 256);
  EXPECT_NEAR(clock.speed_reached(), 4, 0.01);
  const double begin = now = seconds(clock.due());
  EXPECT_EQ(play(clock, now, begin + 2, 0, 0.25), 32);
}

TEST(Clock, AShortStallIsCaughtUp) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  int ticks = play(clock, now, 1, 0.001);
  now = 1.2;  // 0.2 s in which nothing was possible
  ticks += play(clock, now, 2, 0.001);
  EXPECT_EQ(ticks, 128) << "none is missing in the end";
}

TEST(Clock, ALongStallIsLetGo) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  play(clock, now, 1, 0);
  now = 11;  // a laptop's lid was closed
  clock.tick(at(now), kTick, 1);
  EXPECT_NEAR(seconds(clock.due()), 11 + kTick, 1e-9) << "no hurry after ten lost seconds";
  EXPECT_EQ(play(clock, now, 12, 0), 63) << "with the one above 64 in a second";
}

TEST(Clock, CountsWhatAStallCosts) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  play(clock, now, 1, 0);
  EXPECT_EQ(clock.lost(100), 0) << "the system was suspended before";
  now = 4;
  clock.tick(at(now), kTick, 1);
  EXPECT_EQ(clock.lost(100), 3) << "the tick was due at 1 s";
  play(clock, now, 5, 0);
  EXPECT_EQ(clock.lost(100), 0) << "counted once";
  play(clock, now, 6, 0);
  EXPECT_EQ(clock.lost(130), 30) << "steady_clock stood still meanwhile";
  EXPECT_EQ(clock.lost(130), 0);
  EXPECT_EQ(clock.let_go(), 2u);
}

TEST(Clock, CatchesUpAQuarterOfASecondAtMost) {
  for (const double stall : {0.05, 0.1, 0.24, 0.26, 0.5, 3.0}) {
    Clock clock;
    double now = 0;
    clock.restart(at(now));
    play(clock, now, 1, 0);
    now = seconds(clock.due()) + stall;
    int at_once = 0;
    while (seconds(clock.due()) <= now) {
      clock.tick(at(now), kTick, 1);
      at_once++;
    }
    EXPECT_LE(at_once, 17) << stall << ": 0.25 s are 16 ticks, and the one that is due";
    EXPECT_EQ(at_once, stall > 0.25 ? 1 : 1 + static_cast<int>(stall / kTick)) << stall;
  }
}

TEST(Clock, TellsOnceThatItIsLate) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  // each tick costs twice its time: half the speed
  play(clock, now, 1.9, 2 * kTick);
  EXPECT_FALSE(clock.take_late()) << "two seconds of it first";
  play(clock, now, 30, 2 * kTick);
  EXPECT_NEAR(clock.speed_reached(), 0.5, 0.02);
  EXPECT_TRUE(clock.take_late());
  EXPECT_FALSE(clock.take_late());
  play(clock, now, 60, 2 * kTick);
  EXPECT_FALSE(clock.take_late()) << "said already";
  play(clock, now, 65, 0);
  play(clock, now, 70, 2 * kTick);
  EXPECT_TRUE(clock.take_late()) << "it had kept up in between";
}

TEST(Clock, FourPercentAreNotLate) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  play(clock, now, 30, kTick / 0.96);
  EXPECT_FALSE(clock.take_late());
}

TEST(Clock, MeasuresWhatWaitsForNothing) {
  Clock clock;
  clock.restart(at(0));
  for (int i = 1; i <= 1000; i++) clock.measure(at(i * 0.001), kTick);
  EXPECT_NEAR(clock.speed_reached(), kTick / 0.001, 0.5);
  EXPECT_FALSE(clock.take_late());
  EXPECT_EQ(clock.due(), at(1)) << "a pause begins its waiting now";
}

}  // namespace
}  // namespace limber

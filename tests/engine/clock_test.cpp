// Clock with simulated real time: pace, catching up after short stalls, dropped time, overload detection.
#include "engine/clock.h"

#include <gtest/gtest.h>

namespace limber::engine {
namespace {

using namespace std::chrono_literals;
using Time = Clock::Time;

constexpr double kTick = 1.0 / 64;  // exact in binary, and in nanoseconds: 15 625 000

Time at(double seconds) { return Time(std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9))); }
double seconds(Time t) { return std::chrono::duration<double>(t.time_since_epoch()).count(); }

// Runs ticks that take `cost` seconds each until time `until`; returns the number of ticks.
int play(Clock& clock, double& now, double until, double cost, double speed = 1) {
  int ticks = 0;
  while (true) {
    now = std::max(now, seconds(clock.next_tick()));
    if (now >= until) return ticks;
    clock.tick(at(now), kTick, speed);
    now += cost;
    ticks++;
  }
}

TEST(Clock, KeepsPaceForAnyCostOfTicks) {
  for (const double cost : {0.0, 0.001, 0.015}) {
    Clock clock;
    double now = 100;
    clock.restart(at(now));
    EXPECT_EQ(play(clock, now, 110, cost), 640) << cost;
    EXPECT_NEAR(clock.speed_reached(), 1, 0.001) << cost;
    EXPECT_FALSE(clock.consume_late());
  }
}

TEST(Clock, SpeedScalesTheSchedule) {
  Clock clock;
  double now = 5;
  clock.restart(at(now));
  EXPECT_EQ(play(clock, now, 6, 0, 4), 256);
  EXPECT_NEAR(clock.speed_reached(), 4, 0.01);
  const double begin = now = seconds(clock.next_tick());
  EXPECT_EQ(play(clock, now, begin + 2, 0, 0.25), 32);
}

TEST(Clock, CatchesUpAfterAShortStall) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  int ticks = play(clock, now, 1, 0.001);
  now = 1.2;  // a stall of 0.2 s
  ticks += play(clock, now, 2, 0.001);
  EXPECT_EQ(ticks, 128) << "no tick is missing";
}

TEST(Clock, DropsTimeAfterALongStall) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  play(clock, now, 1, 0);
  now = 11;  // for example, a laptop's lid was closed
  clock.tick(at(now), kTick, 1);
  EXPECT_NEAR(seconds(clock.next_tick()), 11 + kTick, 1e-9) << "ten lost seconds are not caught up";
  EXPECT_EQ(play(clock, now, 12, 0), 63) << "64 in a second, including the one above";
}

TEST(Clock, CountsTimeLostInStalls) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  play(clock, now, 1, 0);
  EXPECT_EQ(clock.lost_seconds(100), 0) << "the system was suspended before";
  now = 4;
  clock.tick(at(now), kTick, 1);
  EXPECT_EQ(clock.lost_seconds(100), 3) << "the tick was due at 1 s";
  play(clock, now, 5, 0);
  EXPECT_EQ(clock.lost_seconds(100), 0) << "counted once";
  play(clock, now, 6, 0);
  EXPECT_EQ(clock.lost_seconds(130), 30) << "steady_clock does not count a suspension";
  EXPECT_EQ(clock.lost_seconds(130), 0);
  EXPECT_EQ(clock.stalls(), 2u);
}

TEST(Clock, CatchesUpAtMostAQuarterOfASecond) {
  for (const double stall : {0.05, 0.1, 0.24, 0.26, 0.5, 3.0}) {
    Clock clock;
    double now = 0;
    clock.restart(at(now));
    play(clock, now, 1, 0);
    now = seconds(clock.next_tick()) + stall;
    int at_once = 0;
    while (seconds(clock.next_tick()) <= now) {
      clock.tick(at(now), kTick, 1);
      at_once++;
    }
    EXPECT_LE(at_once, 17) << stall << ": 0.25 s are 16 ticks, and the one that is due";
    EXPECT_EQ(at_once, stall > 0.25 ? 1 : 1 + static_cast<int>(stall / kTick)) << stall;
  }
}

TEST(Clock, ReportsOverloadOnce) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  // each tick costs twice its time: half the speed
  play(clock, now, 1.9, 2 * kTick);
  EXPECT_FALSE(clock.consume_late()) << "only after two seconds";
  play(clock, now, 30, 2 * kTick);
  EXPECT_NEAR(clock.speed_reached(), 0.5, 0.02);
  EXPECT_TRUE(clock.consume_late());
  EXPECT_FALSE(clock.consume_late());
  play(clock, now, 60, 2 * kTick);
  EXPECT_FALSE(clock.consume_late()) << "reported already";
  play(clock, now, 65, 0);
  play(clock, now, 70, 2 * kTick);
  EXPECT_TRUE(clock.consume_late()) << "the speed had recovered in between";
}

TEST(Clock, FourPercentSlowerIsNoOverload) {
  Clock clock;
  double now = 0;
  clock.restart(at(now));
  play(clock, now, 30, kTick / 0.96);
  EXPECT_FALSE(clock.consume_late());
}

TEST(Clock, MeasuresSpeedWithoutSchedule) {
  Clock clock;
  clock.restart(at(0));
  for (int i = 1; i <= 1000; i++) clock.measure_speed(at(i * 0.001), kTick);
  EXPECT_NEAR(clock.speed_reached(), kTick / 0.001, 0.5);
  EXPECT_FALSE(clock.consume_late());
  EXPECT_EQ(clock.next_tick(), at(1)) << "the next tick is due immediately";
}

}  // namespace
}  // namespace limber::engine

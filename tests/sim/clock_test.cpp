// Musical time: beats, tempo changes, synchronization, taps, checkpoints.
#include "sim/clock/beat_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/behavior/behavior_list.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim {
namespace {

using namespace test;

struct ClockFixture : WorldFixture {
  BeatClock& clock() { return world.behaviors().clock(); }
  double value(const char* name) { return number(clock().id(), name); }
  void call(const char* action, const std::vector<double>& values = {}) {
    const Result<void> done = BeatClock::table().at(action).invoke(&clock(), values);
    EXPECT_TRUE(done.ok()) << (done.ok() ? "" : done.error());
  }
  std::string rejection(double beat, double tempo) {
    const Result<void> done = BeatClock::table().at("sync").invoke(&clock(), std::vector<double>{beat, tempo});
    return done ? "" : done.error();
  }
  /// Ticks until a full beat is reached, at most 1000.
  void tick_until_beat() {
    for (int i = 0; i < 1000 && !clock().reached(1); i++) ticks(1);
  }
};

TEST(Clock, CountsBeatsAndBars) {
  ClockFixture s;
  s.set(s.clock().id(), "beats_per_bar", {3});
  EXPECT_EQ(s.clock().reached(1), 0.0) << "the start is a beat";
  for (int tick = 1; tick <= 1200; tick++) {
    s.ticks(1);
    const double beat = tick / 30.0;  // 120 per minute, 60 ticks in a second
    EXPECT_NEAR(s.value("beat"), beat, 1e-9);
    EXPECT_EQ(s.value("bar"), std::floor(tick / 90));
    EXPECT_NEAR(s.value("phase"), beat / 3 - std::floor(tick / 90), 1e-8);
    EXPECT_EQ(s.clock().reached(1).has_value(), tick % 30 == 0) << tick;
    EXPECT_EQ(s.clock().reached(0.5).has_value(), tick % 15 == 0) << tick;
    if (tick % 30 == 0) {
      EXPECT_EQ(s.clock().reached(1), tick / 30);
    }
  }
}

TEST(Clock, ATempoChangeKeepsTheBeat) {
  ClockFixture s;
  double beat = 0;
  for (const double tempo : {60.0, 61.0, 200.0, 20.0, 999.0}) {
    s.set(s.clock().id(), "tempo", {tempo});
    s.ticks(1);  // takes effect in this tick
    beat += tempo / 3600;
    EXPECT_NEAR(s.value("beat"), beat, 1e-9) << tempo;
    EXPECT_EQ(s.value("current_tempo"), tempo);
    s.ticks(50);
    beat += 50 * tempo / 3600;
    EXPECT_NEAR(s.value("beat"), beat, 1e-9) << tempo;
  }
}

TEST(Clock, StopsAndStarts) {
  ClockFixture s;
  s.ticks(40);
  s.set(s.clock().id(), "playing", {0});
  s.ticks(100);
  EXPECT_NEAR(s.value("beat"), 40 / 30.0, 1e-9);
  EXPECT_FALSE(s.clock().reached(1));
  s.set(s.clock().id(), "playing", {1});
  s.ticks(5);
  EXPECT_NEAR(s.value("beat"), 45 / 30.0, 1e-9);
  s.call("start");
  EXPECT_EQ(s.value("beat"), 0);
  EXPECT_EQ(s.clock().reached(1), 0.0);
  s.ticks(30);
  EXPECT_EQ(s.clock().reached(1), 1.0);
}

TEST(Clock, FollowsSmallDifferencesByDegreesAndLargeOnesAtOnce) {
  ClockFixture s;
  s.ticks(10);
  s.call("sync", {100.25, 90});
  EXPECT_EQ(s.value("beat"), 100.25) << "the first one";
  EXPECT_EQ(s.value("synced"), 1);
  EXPECT_EQ(s.value("current_tempo"), 90);
  s.ticks(60);
  EXPECT_NEAR(s.value("beat"), 101.75, 1e-9);
  for (const double difference : {0.3, -0.3}) {
    const double start = s.value("beat");
    s.call("sync", {start + difference, 90});
    EXPECT_EQ(s.value("beat"), start) << "no jump";
    double last = start;
    for (int tick = 1; tick <= 120; tick++) {
      s.ticks(1);
      const double rate = (s.value("beat") - last) * 3600 / 90;  // of the beats of a tick
      EXPECT_GE(rate, 0.5 - 1e-9);
      EXPECT_LE(rate, 1.5 + 1e-9);
      last = s.value("beat");
    }
    EXPECT_NEAR(last, start + difference + 3, 0.01) << "two seconds later";
  }
  s.call("sync", {7, 90});
  EXPECT_EQ(s.value("beat"), 7);
  EXPECT_EQ(s.clock().reached(1), 7.0);
  s.ticks(119);
  EXPECT_EQ(s.value("synced"), 1);
  s.ticks(1);
  EXPECT_EQ(s.value("synced"), 0) << "two seconds without a message";
  EXPECT_NEAR(s.value("beat"), 10, 1e-9) << "it goes on";
}

// Messages of another clock arrive late by different times, and its tempo changes: the beats never jump.
TEST(Clock, FollowsATempoRampWithJitter) {
  ClockFixture s;
  double beat = 0;
  double last = 0;
  for (int tick = 0; tick < 1200; tick++) {
    const double tempo = 90 + 60 * tick / 1200.0;
    const double late = tempo / 60 * 0.004 * (tick % 3);
    if (tick % 6 == 0) s.call("sync", {beat - late, tempo});
    s.ticks(1);
    beat += tempo / 3600;
    if (tick > 60) {
      EXPECT_NEAR(s.value("beat"), beat, 0.03);
    }
    EXPECT_GT(s.value("beat"), last);
    last = s.value("beat");
  }
}

TEST(Clock, TapsSetTheTempoAndThePhase) {
  ClockFixture s;
  s.ticks(7);
  for (int tap = 0; tap < 4; tap++) {
    s.call("tap");
    s.ticks(40);  // 90 per minute
  }
  EXPECT_NEAR(s.value("current_tempo"), 90, 1e-9);
  EXPECT_NEAR(s.value("tempo"), 90, 1e-9);
  s.ticks(200);
  s.tick_until_beat();
  // the taps were in ticks 7, 47, …
  EXPECT_EQ(static_cast<int>(s.world.tick() - 7) % 40, 0) << s.world.tick();
  s.ticks(300);
  s.call("tap");
  EXPECT_NEAR(s.value("current_tempo"), 90, 1e-9) << "a single tap is none";
}

TEST(Clock, RejectsImpossibleValues) {
  ClockFixture s;
  EXPECT_EQ(s.rejection(0, 0), "the tempo must be 20 to 999 beats per minute, got 0");
  EXPECT_EQ(s.rejection(2e9, 100), "the beat must be -1e9 to 1e9, got 2000000000");
  EXPECT_EQ(s.value("synced"), 0);
  s.call("sync", {-3.5, 100});
  EXPECT_EQ(s.value("bar"), -1);
  EXPECT_NEAR(s.value("phase"), 0.125, 1e-9);
  s.tick_until_beat();
  EXPECT_NEAR(s.value("beat"), -3, 0.03);
}

// The clock of a scene that doesn't use it adds nothing to the hash.
TEST(Clock, IsPartOfTheStateOnlyIfItIsChanged) {
  ClockFixture a;
  ClockFixture b;
  a.ticks(10);
  b.ticks(10);
  EXPECT_EQ(a.clock().state_hash(5), 5u);
  b.call("sync", {3, 121});
  EXPECT_NE(a.world.state_hash(), b.world.state_hash());
}

TEST(Clock, ACheckpointContainsIt) {
  ClockFixture s;
  s.ticks(20);
  s.call("tap");
  s.call("sync", {50.2, 77});
  s.ticks(5);
  s.call("sync", {50.6, 78});
  s.ticks(1);
  PageStore pages;
  Archive archive;
  WorldCheckpoint checkpoint;
  checkpoint.capture(s.world, pages, nullptr, archive);
  const auto run = [&] {
    std::vector<double> beats;
    for (int i = 0; i < 100; i++) {
      s.ticks(1);
      beats.push_back(s.value("beat"));
    }
    return beats;
  };
  const std::vector<double> first = run();
  s.call("start");
  s.ticks(3);
  checkpoint.restore(s.world, pages, archive);
  EXPECT_EQ(run(), first);
  checkpoint.release(pages);
}

}  // namespace
}  // namespace limber::sim

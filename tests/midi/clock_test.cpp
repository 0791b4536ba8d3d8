// The MIDI clock in both directions, with jitter, losses and bunches.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "net/midi/clock/clock_in.h"
#include "net/midi/clock/clock_out.h"

namespace limber::midi::test {
namespace {

// Seconds between pulses.
double period_of(double tempo) { return 60 / (tempo * kPulsesPerBeat); }
double tempo_of(const PulseLine& line) { return 60 / (line.period * kPulsesPerBeat); }

TEST(PulseTracker, MeasuresASteadyTempo) {
  for (const double tempo : {20.0, 63.5, 120.0, 300.0, 999.0}) {
    PulseTracker tracker;
    for (int i = 0; i < 48; i++) {
      EXPECT_EQ(tracker.line().has_value(), i >= 7) << i;
      tracker.accept(i * period_of(tempo));
    }
    EXPECT_NEAR(tempo_of(*tracker.line()), tempo, 1e-6 * tempo);
    EXPECT_NEAR(tracker.line()->at(47), 47 * period_of(tempo), 1e-9);
    EXPECT_EQ(tracker.number(), 47);
  }
}

// The standard error of a slope over 48 pulses with uniform jitter of ±j is j/√3 / √(48³/12) per pulse, of the line's
// end 2·j/√3 / √48: five times these at most.
TEST(PulseTracker, AveragesJitter) {
  constexpr double kJitter = 3e-3;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-kJitter, kJitter);
  const double period = period_of(120);
  PulseTracker tracker;
  const double deviation = kJitter / std::sqrt(3.0);
  for (int i = 0; i < 2000; i++) {
    tracker.accept(i * period + jitter(random));
    if (i < 48) continue;
    ASSERT_NEAR(tracker.line()->period, period, 5 * deviation / std::sqrt(48.0 * 48 * 48 / 12)) << i;
    ASSERT_NEAR(tracker.line()->at(i), i * period, 5 * 2 * deviation / std::sqrt(48.0)) << i;
  }
  EXPECT_EQ(tracker.number(), 1999);
}

TEST(PulseTracker, LostPulsesDoNotDelayTheBeat) {
  const double period = period_of(120);
  PulseTracker tracker;
  for (int i = 0; i < 480; i++) {
    const bool lost = i % 100 == 70 || i == 200 || i == 201;
    if (!lost) tracker.accept(i * period);
    if (i > 48) {
      ASSERT_NEAR(tempo_of(*tracker.line()), 120, 1.2) << i;
    }
  }
  EXPECT_EQ(tracker.number(), 479);
  EXPECT_NEAR(tracker.line()->at(479), 479 * period, 1e-6);
}

// Drivers deliver pulses together: three at the time of the last.
TEST(PulseTracker, BunchesCountAsSinglePulses) {
  const double period = period_of(120);
  PulseTracker tracker;
  for (int i = 0; i < 240; i++) {
    const bool late = i % 24 == 10 || i % 24 == 11;
    const int arrival = late ? i - i % 24 + 12 : i;
    tracker.accept(arrival * period);
    if (i > 48) {
      ASSERT_NEAR(tempo_of(*tracker.line()), 120, 1.2) << i;
    }
  }
  EXPECT_EQ(tracker.number(), 239);
  EXPECT_NEAR(tracker.line()->at(239), 239 * period, 1e-4);
}

TEST(PulseTracker, FollowsChangesOfTempo) {
  for (const double to : {60.0, 115.0, 118.0, 122.0, 125.0, 240.0}) {
    PulseTracker tracker;
    double time = 0;
    for (int i = 0; i < 96; i++) tracker.accept(time = i * period_of(120));
    for (int i = 0; i < 48; i++) tracker.accept(time += period_of(to));
    EXPECT_NEAR(tempo_of(*tracker.line()), to, 0.005 * to);
    EXPECT_EQ(tracker.number(), 143) << to;
    EXPECT_NEAR(tracker.line()->at(143), time, 1e-3) << to;
  }
}

TEST(PulseTracker, FollowsARamp) {
  PulseTracker tracker;
  double time = 0;
  for (int i = 0; i < 960; i++) {
    const double tempo = 100 + i * 0.05;  // 48 beats per minute in 40 beats
    tracker.accept(time += period_of(tempo));
    if (i > 48) {
      ASSERT_NEAR(tempo_of(*tracker.line()), tempo, 4) << i;
    }
  }
  EXPECT_EQ(tracker.number(), 959);
}

TEST(PulseTracker, StartsAgainAfterAPause) {
  PulseTracker tracker;
  for (int i = 0; i < 48; i++) tracker.accept(i * period_of(120));
  tracker.accept(10);
  EXPECT_FALSE(tracker.line().has_value());
}

// Sends pulses from number `from` to `to` at the times of a tempo that began at `begin`; returns the messages.
std::vector<std::string> play(ClockIn& clock, int from, int to, double tempo, double begin = 0) {
  std::vector<std::string> texts;
  for (int i = from; i < to; i++) {
    const double time = begin + i * period_of(tempo);
    clock.accept({MidiKind::clock}, time);
    for (const Message& message : clock.drain(time)) {
      std::string text = message.address;
      const bool has_time = message.args.size() == 3;
      if (has_time) {
        EXPECT_EQ(message.args[2].number, time);
      }
      for (std::size_t k = 0; k < message.args.size() - (has_time ? 1 : 0); k++)
        text += fmt::format(" {:.3f}", message.args[k].number);
      texts.push_back(text);
    }
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(MidiClockIn, SynchronizesOncePerBeat) {
  ClockIn clock;
  // the tempo is known at the seventh pulse: number 6, beat 6/24
  EXPECT_EQ(play(clock, 0, 96, 120), (Texts{"/clock/sync 0.250 120.000", "/clock/sync 1.000 120.000",
                                            "/clock/sync 2.000 120.000", "/clock/sync 3.000 120.000"}));
}

TEST(MidiClockIn, StartBeginsAtZeroWithTheKnownTempo) {
  ClockIn clock;
  play(clock, 0, 60, 90);
  clock.accept({MidiKind::start}, 60 * period_of(90));
  EXPECT_EQ(play(clock, 60, 110, 90), (Texts{"/clock/playing 1.000", "/clock/sync 0.000 90.000",
                                             "/clock/sync 1.000 90.000", "/clock/sync 2.000 90.000"}));
}

TEST(MidiClockIn, ContinueBeginsAtTheSongPosition) {
  ClockIn clock;
  play(clock, 0, 48, 120);
  clock.accept({MidiKind::stop}, 1);
  EXPECT_EQ(play(clock, 48, 60, 120), Texts{"/clock/playing 0.000"}) << "nothing while it is stopped";
  clock.accept({MidiKind::song_position, 0, 40, 1}, 1.3);  // 168 sixteenths
  clock.accept({MidiKind::resume}, 1.3);
  EXPECT_EQ(play(clock, 60, 62, 120), (Texts{"/clock/playing 1.000", "/clock/sync 42.000 120.000"}));
}

TEST(MidiClockIn, ContinueGoesOnWhereItStopped) {
  ClockIn clock;
  clock.accept({MidiKind::start}, 0);
  play(clock, 0, 36, 120);
  clock.accept({MidiKind::stop}, 0);
  play(clock, 36, 60, 120);
  clock.accept({MidiKind::resume}, 0);
  EXPECT_EQ(play(clock, 60, 61, 120), (Texts{"/clock/playing 1.000", "/clock/sync 1.500 120.000"}));
}

// Plays the clock of a simulation with ticks of 1/60 s; returns the bytes with the beat at which they were sent.
struct Sent {
  std::uint8_t byte;
  double beat;
};
class ClockPlayer {
 public:
  /// Advances by seconds in steps of a millisecond.
  void play(double seconds, bool readings = true) {
    for (int i = 0; i < std::lround(seconds * 1000); i++) {
      if (readings && now >= next_tick_) {
        next_tick_ = now + 1 / 60.0;
        clock.update({.beat = beat, .tempo = tempo, .playing = playing}, now);
      }
      (void)clock.send_due(now, [&](std::span<const std::uint8_t> bytes) {
        for (const std::uint8_t byte : bytes) sent.push_back({byte, beat});
      });
      now += 1e-3;
      if (playing) beat += tempo / 60 * 1e-3;
    }
  }
  std::size_t count(std::uint8_t byte) const {
    return static_cast<std::size_t>(std::ranges::count(sent, byte, &Sent::byte));
  }
  ClockOut clock;
  std::vector<Sent> sent;
  double now = 100, beat = 0, tempo = 120;
  bool playing = true;

 private:
  double next_tick_ = 0;
};

TEST(MidiClockOut, SendsPulsesAtTheirBeats) {
  ClockPlayer player;
  player.play(5);
  ASSERT_FALSE(player.sent.empty());
  EXPECT_EQ(player.sent[0].byte, 0xfa);
  EXPECT_EQ(player.count(0xf8), 240u);
  for (std::size_t i = 1; i < player.sent.size(); i++) {
    ASSERT_EQ(player.sent[i].byte, 0xf8);
    ASSERT_NEAR(player.sent[i].beat, static_cast<double>(i - 1) / 24, 0.005) << i;  // 2 ms
  }
}

TEST(MidiClockOut, StopsAndContinues) {
  ClockPlayer player;
  player.play(1.1);
  player.playing = false;
  player.sent.clear();
  player.play(1);
  ASSERT_FALSE(player.sent.empty());
  EXPECT_EQ(player.sent.back().byte, 0xfc);
  EXPECT_LE(player.count(0xf8), 1u) << "before the stop is read";
  player.sent.clear();
  player.playing = true;
  player.play(0.5);
  ASSERT_GE(player.sent.size(), 4u);
  EXPECT_EQ(player.sent[0].byte, 0xf2);
  EXPECT_EQ(player.sent[1].byte, 9) << "the next sixteenth after beat 2.2";
  EXPECT_EQ(player.sent[3].byte, 0xfb);
}

TEST(MidiClockOut, StartsAtBeat0) {
  ClockPlayer player;
  player.beat = -4;  // a program that leads the clock counts in
  player.play(1.5);
  EXPECT_TRUE(player.sent.empty()) << "MIDI has no position before the start";
  player.play(1.5);
  EXPECT_EQ(player.sent[0].byte, 0xfa);
  EXPECT_EQ(player.count(0xfa) + player.count(0xfc), 1u);
  EXPECT_NEAR(player.sent[1].beat, 0, 0.005);
  EXPECT_EQ(player.count(0xf8), 48u);
  player.beat = -2;
  player.play(0.1);
  EXPECT_EQ(player.sent.back().byte, 0xfc);
}

TEST(MidiClockOut, AJumpIsASongPosition) {
  ClockPlayer player;
  player.play(1);
  player.beat = 40;
  player.sent.clear();
  player.play(0.1);
  ASSERT_GE(player.sent.size(), 5u);
  std::size_t i = 0;
  while (i < player.sent.size() && player.sent[i].byte == 0xf8) i++;
  ASSERT_LE(i, 1u);
  EXPECT_EQ(player.sent[i].byte, 0xfc);
  EXPECT_EQ(player.sent[i + 1].byte, 0xf2);
  EXPECT_EQ(player.sent[i + 2].byte | player.sent[i + 3].byte << 7, 161) << "the sixteenth after beat 40.03";
}

TEST(MidiClockOut, LatePulsesFollowOneByOne) {
  ClockPlayer player;
  player.play(1);
  player.now += 0.1;  // the thread was delayed: 4.8 pulses
  player.beat += 0.2;
  player.sent.clear();
  std::size_t last = 0;
  for (int i = 0; i < 200; i++) {
    player.play(0.001);
    ASSERT_LE(player.sent.size() - last, 1u);
    last = player.sent.size();
  }
  // after 0.2 s: the 4.8 late ones and 9.6
  EXPECT_NEAR(static_cast<double>(player.count(0xf8)), 14.4, 1.0);
}

TEST(MidiClockOut, WithoutReadingsThePulsesEnd) {
  ClockPlayer player;
  player.play(1);
  player.sent.clear();
  player.play(3, false);
  EXPECT_LE(player.count(0xf8), 25u) << "half a second";
}

}  // namespace
}  // namespace limber::midi::test

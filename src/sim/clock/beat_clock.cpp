// BeatClock: tempo, synchronization and taps.
#include "sim/clock/beat_clock.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

constexpr double kTolerance = 1e-9;       // beats; a beat is reached this much early, in spite of rounding
constexpr double kJump = 0.5;             // beats; larger differences are not corrected by degrees
constexpr double kCorrectionTime = 0.25;  // s, time constant of corrections
constexpr double kMaxCorrection = 0.5;  // of the beats of a tick, so that a correction never stops or doubles the tempo
constexpr double kSyncTimeout = 2;      // s without a sync after which the clock counts as not synchronized
constexpr double kMaxBeat = 1e9;
constexpr double kMaxTapInterval = 60 / kMinTempo;  // s

struct ClockProperties {
  const Property &tempo, &beats_per_bar, &playing, &beat;
};

const ClockProperties& clock_properties() {
  static const auto at = [](const char* name) -> const Property& { return BeatClock::table().at(name); };
  static const ClockProperties found{at("tempo"), at("beats_per_bar"), at("playing"), at("beat")};
  return found;
}

}  // namespace

const PropertyTable& BeatClock::table() {
  static const PropertyTable table(
      "clock", "/clock", "",
      {
          on_change<&BeatClock::apply_tempo>(
              number("tempo", "beats/min", 120, kMinTempo, kMaxTempo,
                     "Tempo to play at, until another program or taps set another one (see current_tempo).")),
          integer("beats_per_bar", 4, 1, 64, "Beats in a bar."),
          transient(state(boolean("playing", true, "Beats pass."))),
          transient(readout(number("beat", "beats", 0, -kMaxBeat, kMaxBeat,
                                   "Beats since the start of the scene, or since the start of the program that leads "
                                   "the clock, with the fraction of the present one."))),
          transient(readout(integer("bar", 0, -kMaxBeat, kMaxBeat, "Complete bars since beat 0."))),
          transient(readout(number("phase", "", 0, 0, 1, "Position in the bar: 0 at its start, up to 1 at its end."))),
          transient(readout(
              number("current_tempo", "beats/min", 120, kMinTempo, kMaxTempo, "The tempo at which the beats pass."))),
          transient(readout(boolean("synced", false, "True while another program or device leads the clock."))),
          invokes<&BeatClock::act_start>(action("start", 0, 0, "Starts at beat 0.")),
          invokes<&BeatClock::act_sync>(
              action("sync", 2, 2,
                     "Follows another clock: its beat now, and its tempo. A difference of up to half a beat is "
                     "corrected within a second, a larger one at once.")),
          invokes<&BeatClock::act_tap>(
              action("tap", 0, 0,
                     "Taps a beat: two or more, at most 3 s apart, set the tempo, and each is the nearest full beat.")),
      });
  return table;
}

BeatClock::BeatClock(World& world)
    : world_(world), id_(world.store().add(table(), world.store().root(), "clock", this)) {}

double BeatClock::setting(const Property& property) const { return world_.store().values(id_, property)[0]; }

double BeatClock::beats_per_bar() const { return setting(clock_properties().beats_per_bar); }

ClockReading BeatClock::reading() const {
  return {state_.beat, state_.tempo, setting(clock_properties().tempo), beats_per_bar(),
          setting(clock_properties().playing) != 0};
}

void BeatClock::set(const Property& property, double value) { (void)world_.store().set(id_, property, {&value, 1}); }

std::optional<double> BeatClock::reached(double every) const {
  const double now = std::floor((state_.beat + kTolerance) / every);
  if (now == std::floor((state_.previous + kTolerance) / every)) return std::nullopt;
  return now;
}

void BeatClock::step() {
  const double time = world_.time();
  const double playing = setting(clock_properties().playing);
  if (playing != state_.playing) state_.changed = 1;
  state_.playing = playing;
  state_.previous = state_.beat;
  if (playing == 0) {
    state_.anchor_beat = state_.beat;
    state_.anchor_time = time;
  }
  state_.beat = state_.anchor_beat + (time - state_.anchor_time) * state_.tempo / 60;
  if (state_.correction != 0 && playing != 0) {
    const double most = kMaxCorrection * (state_.beat - state_.previous);
    const double part = state_.correction * std::min(1.0, world_.timestep() / kCorrectionTime);
    const double added = std::clamp(part, -most, most);
    state_.beat += added;
    state_.correction = std::abs(state_.correction) < kTolerance ? 0 : state_.correction - added;
    state_.anchor_beat = state_.beat;
    state_.anchor_time = time;
  }
  publish();
}

void BeatClock::publish() {
  double* const out = world_.store().mutable_values(id_, clock_properties().beat);  // the readouts are contiguous
  const double bars = (state_.beat + kTolerance) / beats_per_bar();
  out[0] = state_.beat;
  out[1] = std::floor(bars);
  out[2] = bars - std::floor(bars);
  out[3] = state_.tempo;
  out[4] = state_.synced_at >= 0 && world_.time() - state_.synced_at < kSyncTimeout ? 1 : 0;
}

std::uint64_t BeatClock::state_hash(std::uint64_t start) const {
  const double playing = setting(clock_properties().playing);
  if (state_.changed == 0 && playing != 0) return start;
  NumberHash numbers(start);
  numbers.add(state_.beat, state_.tempo, state_.correction);
  numbers.add(state_.synced_at, state_.tapped_at, playing);
  return numbers.value();
}

void BeatClock::apply_tempo() {
  if (setting(clock_properties().tempo) == state_.tempo) return;
  state_.anchor_beat = state_.beat;
  state_.anchor_time = world_.time();
  state_.tempo = setting(clock_properties().tempo);
  state_.changed = 1;
}

// The next tick reaches this beat if it is a full one.
void BeatClock::jump(double beat) {
  state_.beat = state_.anchor_beat = beat;
  state_.previous = beat - 2 * kTolerance;
  state_.anchor_time = world_.time();
  state_.correction = 0;
  state_.changed = 1;
}

Result<void> BeatClock::act_start(std::span<const double>) {
  jump(0);
  set(clock_properties().playing, 1);
  publish();
  return {};
}

Result<void> BeatClock::act_sync(std::span<const double> args) {
  if (!(std::abs(args[0]) <= kMaxBeat))
    return Error{fmt::format("the beat must be -1e9 to 1e9, got {}", number_text(args[0]))};
  if (!(args[1] >= kMinTempo && args[1] <= kMaxTempo))
    return Error{
        fmt::format("the tempo must be {} to {} beats per minute, got {}", kMinTempo, kMaxTempo, number_text(args[1]))};
  const double difference = args[0] - state_.beat;
  if (std::abs(difference) > kJump || state_.synced_at < 0) {
    jump(args[0]);
  } else {
    state_.anchor_beat = state_.beat;
    state_.anchor_time = world_.time();
    state_.correction = difference;
    state_.changed = 1;
  }
  state_.tempo = args[1];
  state_.synced_at = world_.time();
  publish();
  return {};
}

// The mean of all intervals of a series is that from its first to its last tap.
Result<void> BeatClock::act_tap(std::span<const double>) {
  const double time = world_.time();
  const double interval = time - state_.tapped_at;
  if (state_.tapped_at < 0 || interval > kMaxTapInterval) {
    state_.first_tap = time;
    state_.tapped_beats = 0;
  } else if (interval >= 60 / kMaxTempo) {
    state_.tapped_beats++;
    const double tempo = 60 * state_.tapped_beats / (time - state_.first_tap);
    state_.tempo = std::clamp(tempo, kMinTempo, kMaxTempo);
    set(clock_properties().tempo, state_.tempo);
  }
  state_.tapped_at = time;
  state_.anchor_beat = state_.beat;
  state_.anchor_time = time;
  state_.correction = std::round(state_.beat) - state_.beat;
  state_.changed = 1;
  publish();
  return {};
}

}  // namespace limber::sim

// BeatClock: musical time, at /clock. Beats pass with simulated time at the tempo; another program, a MIDI clock or
// taps can lead it. [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/id.h"
#include "base/memory/archive.h"
#include "base/result.h"
#include "properties/property_table.h"
#include "sim/clock/clock_reading.h"

namespace limber::sim {

class World;

class BeatClock {
 public:
  static const PropertyTable& table();
  explicit BeatClock(World& world);

  NodeId id() const { return id_; }
  /// Beats since the start of the scene, or the beat of the program that leads the clock.
  double beat() const { return state_.beat; }
  double beats_per_bar() const;
  ClockReading reading() const;
  /// The newest multiple of `every` (beats, above 0) that was reached in the last tick, as its number; nothing if none
  /// was. The first tick reaches beat 0.
  std::optional<double> reached(double every) const;

  /// Advances to the present time of the world; once per tick.
  void step();
  /// Publishes the readouts.
  void publish();

  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }
  std::uint64_t state_hash(std::uint64_t start) const;

  // Callbacks of the properties.
  void apply_tempo();
  Result<void> act_start(std::span<const double> args);
  Result<void> act_sync(std::span<const double> args);
  Result<void> act_tap(std::span<const double> args);

 private:
  double setting(const Property& property) const;
  void set(const Property& property, double value);
  void jump(double beat);

  World& world_;
  NodeId id_;
  // What persists from tick to tick. The beat is `anchor_beat` plus the beats since `anchor_time`: a product, since a
  // sum over ticks would drift from it.
  struct State {
    double beat = 0, previous = -1;  // now, and before the last tick
    double anchor_beat = 0, anchor_time = 0;
    double tempo = 120;     // beats per minute
    double correction = 0;  // beats that are still to be added to agree with the program that leads the clock
    double synced_at = -1;  // s; negative: not synchronized since the start
    double tapped_at = -1, tapped_beats = 0, first_tap = 0;  // s; taps of the present series
    double playing = 1;                                      // the setting in the last tick
    double changed = 0;                                      // 0: it has run as at the start
  } state_;
};

}  // namespace limber::sim

// Transport and telemetry: the nodes /transport (play, pause, step, rewind, reset, panic) and /osc (what came in and
// was lost). [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/command.h"
#include "engine/health.h"
#include "sim/world.h"

namespace limber {

class Transport {
 public:
  static const Table& table();

  Transport(World& world, const Health& health);

  bool paused() const;
  /// Ticks that `step` asked for and that were not taken yet; taking one counts it.
  bool take_step();
  /// How many they are; a rewind, which repeats messages, leaves them as they are.
  int steps() const { return steps_; }
  void keep_steps(int steps) { steps_ = steps; }
  /// How far back a message asked to go since the last call, if one did.
  struct Back {
    double seconds = 0;
    std::uint64_t ticks = 0;  ///< Where that is not 0, so many ticks instead.
    bool stands = false;      ///< Time stands still there.
  };
  std::optional<Back> take_back() { return std::exchange(back_, std::nullopt); }
  /// Time stands still from now on.
  void stand_still();
  /// Tells `speed_reached`, the seconds that can be rewound, the megabytes that they take, and the seconds that stalls
  /// have cost.
  void tell(double speed_reached, double rewindable, double history_memory, double lost_time);

 private:
  Result<void> act_play(std::span<const double> args);
  Result<void> act_pause(std::span<const double> args);
  Result<void> act_step(std::span<const double> args);
  Result<void> act_reset(std::span<const double> args);
  Result<void> act_panic(std::span<const double> args);
  Result<void> act_panic_end(std::span<const double> args);
  Result<void> act_rewind(std::span<const double> args);
  Result<void> act_rewind_ticks(std::span<const double> args);
  void set_paused(bool paused);
  std::string_view say_health() const;

  World& world_;
  const Health& health_;
  NodeId id_;
  int steps_ = 0;
  std::optional<Back> back_;
  mutable std::string health_text_;
};

/// The counters as readouts.
class CounterNode {
 public:
  static const Table& table();

  CounterNode(Store& store, const Counters& counters);
  void tell();

 private:
  Store& store_;
  const Counters& counters_;
  NodeId id_;
};

}  // namespace limber

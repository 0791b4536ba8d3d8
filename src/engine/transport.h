// Transport: the node /transport (play, pause, step, rewind, reset, panic). [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/commands/command.h"
#include "engine/output/health.h"
#include "sim/world/world.h"

namespace limber::engine {

class Transport {
 public:
  static const PropertyTable& table();

  /// `lockstep`: time advances only by `step`, so that it counts as paused.
  Transport(sim::World& world, const Health& health, bool lockstep);

  bool paused() const;
  /// Consumes one of the ticks requested by `step`. False if none is left.
  bool consume_step();
  /// Number of requested ticks left. A rewind executes recorded messages again, and restores the number afterwards.
  int steps() const { return steps_; }
  void set_steps(int steps) { steps_ = steps; }
  /// A request to rewind.
  struct RewindRequest {
    double seconds = 0;
    std::uint64_t ticks = 0;  ///< If not 0: number of ticks, instead of `seconds`.
    bool pause = false;       ///< Pause after the rewind.
  };
  /// Returns the latest request to rewind since the last call, if there was one.
  std::optional<RewindRequest> consume_rewind() { return std::exchange(rewind_, std::nullopt); }
  /// Pauses and cancels requested ticks.
  void pause();
  /// Publishes the readouts: speed factor, rewindable seconds, megabytes of history, seconds lost in stalls.
  void publish(double speed_reached, double rewindable, double history_memory, double lost_time);

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
  std::string_view read_health() const;

  sim::World& world_;
  const Health& health_;
  bool lockstep_;
  NodeId id_;
  int steps_ = 0;
  std::optional<RewindRequest> rewind_;
  mutable std::string health_text_;
};

}  // namespace limber::engine

// Transport and telemetry: the nodes /transport (play, pause, step, reset, panic) and /osc (what came in and was lost).
// [sim]
#pragma once

#include <utility>

#include "engine/command.h"
#include "sim/world.h"

namespace limber {

class Transport {
 public:
  static const Table& table();

  explicit Transport(World& world);

  bool paused() const;
  /// Ticks that `step` asked for and that were not taken yet; taking one counts it.
  bool take_step();
  /// Tells `speed_reached`.
  void tell(double speed_reached);

 private:
  Result<void> act_play(std::span<const double> args);
  Result<void> act_pause(std::span<const double> args);
  Result<void> act_step(std::span<const double> args);
  Result<void> act_reset(std::span<const double> args);
  Result<void> act_panic(std::span<const double> args);
  void set_paused(bool paused);

  World& world_;
  NodeId id_;
  int steps_ = 0;
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

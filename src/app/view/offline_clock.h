// OfflineClock: ticks an engine offline up to given simulated times and holds the two snapshots around each.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/engine.h"

namespace limber::app {

/// The engine must be started and not running elsewhere: it ticks on this thread. [main]
class OfflineClock {
 public:
  /// `cancel` is called before each tick and returns true to stop.
  OfflineClock(engine::Engine& engine, engine::EngineLink& link, const std::function<bool()>& cancel);

  /// Reason why advance_to() has returned.
  enum class Outcome : std::uint8_t { reached, stuck, ended, canceled };
  /// Ticks until `seconds` is reached. `stuck`: the simulation is paused; `ended`: the replayed take has ended.
  Outcome advance_to(double seconds);
  /// Sets callbacks that run before and after each tick.
  void on_before_tick(std::function<void()> before) { before_tick_ = std::move(before); }
  void on_after_tick(std::function<void()> after) { after_tick_ = std::move(after); }

  const engine::Snapshot& before() const { return *before_; }
  const engine::Snapshot& now() const { return *now_; }
  /// Returns the interpolation factor of `seconds` between before() and now(): 0 .. 1.
  double mix(double seconds) const;
  /// Simulated time at now(), s; a reset doesn't set it back.
  double elapsed() const { return elapsed_; }

 private:
  engine::Engine& engine_;
  engine::EngineLink& link_;
  const std::function<bool()>& cancel_;
  std::function<void()> before_tick_ = [] {};
  std::function<void()> after_tick_ = [] {};
  std::shared_ptr<const engine::Snapshot> before_, now_;
  double elapsed_ = 0;
  double elapsed_before_ = 0;
  double last_step_ = 0;                     // s; step of the last tick that advanced time
  std::vector<engine::Outgoing> discarded_;  // output that is discarded: there is no listener
};

}  // namespace limber::app

// Moments: drives an engine offline from one simulated time to the next, and knows the two snapshots around it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/engine.h"

namespace limber {

/// The engine has started and nobody else runs it: it ticks on this thread. [main]
class Moments {
 public:
  /// `cancel` is asked before each tick.
  Moments(Engine& engine, EngineLink& link, const std::function<bool()>& cancel);

  enum class Went : std::uint8_t { there, stuck, ended, cancelled };
  /// Ticks until there. `stuck`: time stands still; `ended`: the take that is replayed goes no further.
  Went go_to(double seconds);
  /// Called before each tick, and after it.
  void on_tick(std::function<void()> before) { before_tick_ = std::move(before); }
  void after_tick(std::function<void()> after) { after_tick_ = std::move(after); }

  const Snapshot& before() const { return *before_; }
  const Snapshot& now() const { return *now_; }
  /// How far that time is from before() to now(): 0 .. 1.
  double mix(double seconds) const;
  /// Of now(), s; a reset does not set it back.
  double elapsed() const { return elapsed_; }

 private:
  Engine& engine_;
  EngineLink& link_;
  const std::function<bool()>& cancel_;
  std::function<void()> before_tick_ = [] {};
  std::function<void()> after_tick_ = [] {};
  std::shared_ptr<const Snapshot> before_, now_;
  double elapsed_ = 0;
  double elapsed_before_ = 0;
  double last_step_ = 0;        // s, of a tick that went on
  std::vector<Outgoing> gone_;  // nobody listens
};

}  // namespace limber

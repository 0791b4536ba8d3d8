// Pacer: paces the ticks of Engine::run() in real time, counts the time lost in stalls, and ends the loop.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "engine/clock.h"
#include "engine/session.h"
#include "engine/sim_thread_executor.h"

namespace limber::engine {

class Pacer {
 public:
  /// Starts the schedule: the first tick is due now. `wakes_for_commands`: wait_for_tick() ends when one arrives. [sim]
  void start(bool wakes_for_commands) {
    clock_.restart(Clock::Time::clock::now());
    wakes_for_commands_ = wakes_for_commands;
  }
  /// Waits until the next tick is due. False if it is not due yet, but requests or commands may wait for a pass. [sim]
  bool wait_for_tick(const SimThreadExecutor& requests);
  /// Starts a tick that was waited for, and reports a machine that can't keep up. [sim]
  void begin_tick(const Session& session);
  /// Starts a tick that doesn't wait for its time. [sim]
  void begin_unpaced_tick(double timestep) { clock_.measure_speed(Clock::Time::clock::now(), timestep); }
  /// The next delay is caused by a requested reset or rewind and is not counted as a stall. [sim]
  void excuse_stall() { stall_excused_ = true; }

  /// Ends the loop. [any]
  void stop();
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  /// Wakes wait_for_tick() to serve a request. [any]
  void wake();
  /// Notes that commands wait for a pass. [any]
  void notify_commands() { commands_waiting_.store(true, std::memory_order_relaxed); }
  /// True if commands were noted since the last call. [sim]
  bool consume_commands() { return commands_waiting_.exchange(false, std::memory_order_relaxed); }

  /// Simulated seconds per real second.
  double speed_reached() const { return clock_.speed_reached(); }
  /// Number of times that lost time was dropped.
  std::uint64_t stalls() const { return clock_.stalls(); }
  /// Seconds lost in stalls.
  double lost_time() const { return lost_time_; }

 private:
  void count_stall(bool paused);

  bool wakes_for_commands_ = false;
  Clock clock_;
  double lost_time_ = 0;         // s
  bool stall_reported_ = false;  // the stall warning was logged
  bool stall_excused_ = true;
  std::atomic<bool> stopped_{false};
  std::atomic<bool> commands_waiting_{false};
  std::mutex wake_mutex_;
  std::condition_variable wake_;
};

}  // namespace limber::engine

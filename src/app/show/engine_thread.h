// EngineThread: runs the engine on its own thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <semaphore>
#include <thread>

#include "app/exit_code.h"
#include "base/result.h"

namespace limber::engine {
class Engine;
}  // namespace limber::engine

namespace limber::app {

/// Wakes the main thread (system::wake_thread) when the scene has run, and when the show is over.
class EngineThread {
 public:
  /// [main]
  explicit EngineThread(engine::Engine& engine);
  ~EngineThread() { end(); }
  EngineThread(const EngineThread&) = delete;
  EngineThread& operator=(const EngineThread&) = delete;

  bool started() const { return state_.load() >= State::started; }
  bool over() const { return state_.load() == State::over; }
  /// Result of running the scene; valid once started() is true.
  const Result<void>& result() const { return result_; }
  /// Exit code if it failed: kInputError or kMachineError.
  int exit_code() const { return exit_code_; }
  /// Allows the first tick. `even_if_failed`: also if the scene failed; then the world stays empty until a reload
  /// succeeds.
  void allow_ticks(bool even_if_failed);
  /// Stops the engine and joins its thread. Idempotent.
  void end();

 private:
  enum class State : std::uint8_t { starting, started, over };

  void play();
  Result<void> start();
  void change(State state);

  engine::Engine& engine_;
  Result<void> result_;
  int exit_code_ = kInputError;
  std::atomic<State> state_{State::starting};
  std::atomic<bool> even_if_failed_{false};
  std::counting_semaphore<2> start_semaphore_{0};
  std::uint64_t main_thread_;
  std::thread thread_;  // must be the last member: it uses the others
};

}  // namespace limber::app

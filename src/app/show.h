// Show: the engine on a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <semaphore>
#include <thread>

#include "app/exit_code.h"
#include "base/result.h"

namespace limber {

class Engine;

/// It calls the main thread (system::call_thread) when the scene has run, and when the show is over.
class Show {
 public:
  /// [main]
  explicit Show(Engine& engine);
  ~Show() { end(); }
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  bool started() const { return state_.load() >= State::started; }
  bool over() const { return state_.load() == State::over; }
  /// What the scene's run gave; once it has started.
  const Result<void>& result() const { return result_; }
  /// Whose fault that is: kInput or kMachine.
  int fault() const { return fault_; }
  /// The first tick may come. `anyway`: after a fault of the scene's, too; the world is empty and waits for a good run.
  void go(bool anyway);
  void end();

 private:
  enum class State : std::uint8_t { starting, started, over };

  void play();
  Result<void> start();
  void change(State state);

  Engine& engine_;
  Result<void> result_;
  int fault_ = kInput;
  std::atomic<State> state_{State::starting};
  std::atomic<bool> anyway_{false};
  std::counting_semaphore<2> go_{0};
  std::uint64_t main_;
  std::thread thread_;  // last: it starts when all else is there
};

}  // namespace limber

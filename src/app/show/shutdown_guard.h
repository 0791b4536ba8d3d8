// ShutdownGuard: limits the duration of the shutdown. After another signal the program ends within a quarter of a
// second; once all files are written, the rest of the shutdown may take half a second.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace limber::app {

/// Watches the shutdown from its constructor to its destructor.
class ShutdownGuard {
 public:
  /// Signals must be blocked (system::block_signals) in every thread. `on_timeout` must end the program; it is called
  /// on the guard's thread. [main]
  explicit ShutdownGuard(std::function<void()> on_timeout);
  ~ShutdownGuard();
  ShutdownGuard(const ShutdownGuard&) = delete;
  ShutdownGuard& operator=(const ShutdownGuard&) = delete;

  /// Starts the time limit of half a second, after which `on_timeout` is called unless the guard was destroyed
  /// before. [main]
  void files_written() { files_written_.store(true); }

 private:
  void watch();

  std::function<void()> on_timeout_;
  std::atomic<bool> files_written_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace limber::app

// SimThreadExecutor: lets other threads run work on the simulation thread between two ticks and wait for its end. The
// simulation thread never waits.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace limber::engine {

class SimThreadExecutor {
 public:
  /// Runs `work` on the simulation thread and blocks until it is done. Calls `wake` once the work is visible to that
  /// thread. Returns false if the simulation has ended; the work is then not done. [any but sim]
  bool run_and_wait(const std::function<void()>& work, const std::function<void()>& wake);
  /// True if a thread is waiting.
  bool waiting() const { return waiting_.load(std::memory_order_acquire); }
  /// Runs the waiting work, if any. [sim]
  void serve();
  /// Accepts requests again after close(). [sim]
  void open();
  /// Rejects requests from now on and releases the waiting threads. [sim]
  void close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> waiting_{false};
  const std::function<void()>* work_ = nullptr;
  bool closed_ = false;
};

}  // namespace limber::engine

// Requests: work that another thread has the simulation do between two ticks, and whose end it waits for. The
// simulation waits for nobody.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace limber {

class Requests {
 public:
  /// Has `work` done on the simulation's thread and waits for its end; false: the simulation has ended, nothing was
  /// done. `wake` is called once the work can be seen. [any but sim]
  bool ask(const std::function<void()>& work, const std::function<void()>& wake);
  /// Whether somebody waits.
  bool waiting() const { return waiting_.load(std::memory_order_acquire); }
  /// Does what is asked for. [sim]
  void serve();
  /// From here on somebody is served: who asks before waits for it. [sim]
  void open();
  /// Nobody is served any more: who waits is let go. [sim]
  void close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> waiting_{false};
  const std::function<void()>* work_ = nullptr;
  bool closed_ = false;
};

}  // namespace limber

// DisplayWatchdog: lets the program react to signals while the display server doesn't respond.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

namespace limber::app {

/// A call into the display server may block the main thread, which handles the signals. A watchdog thread takes over if
/// a signal is pending for longer than a second during such a call.
class DisplayWatchdog {
 public:
  DisplayWatchdog() { main_thread_mutex_.lock(); }
  ~DisplayWatchdog();
  DisplayWatchdog(const DisplayWatchdog&) = delete;
  DisplayWatchdog& operator=(const DisplayWatchdog&) = delete;

  /// From now on, `end` is called on the watchdog thread if call() has blocked for a second while a signal was pending
  /// (after ending(): in any case). It must end the program. If no thread can be started, there is no watchdog. [main]
  void start(std::function<void()> end);
  /// Runs `call`, which may block on the display. Never returns once `end` was called. [main]
  template <class Call>
  decltype(auto) call(Call&& call) {
    const ReleaseScope release(main_thread_mutex_);
    return call();
  }
  /// The program is about to end: from now on call() may take at most a second. [main]
  void ending() { ending_.store(true); }

 private:
  // Unlocks the mutex during call(); otherwise the main thread holds it.
  struct ReleaseScope {
    explicit ReleaseScope(std::mutex& mutex) : released(mutex) { released.unlock(); }
    ~ReleaseScope() { released.lock(); }
    ReleaseScope(const ReleaseScope&) = delete;
    ReleaseScope& operator=(const ReleaseScope&) = delete;
    std::mutex& released;
  };
  void watch();

  std::function<void()> end_;
  std::mutex main_thread_mutex_;
  std::atomic<bool> ending_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace limber::app

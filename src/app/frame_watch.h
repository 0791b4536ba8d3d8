// FrameWatch: a program whose display server does not answer still ends at a signal.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

namespace limber {

/// While the main thread is in a call of the display's, nothing else hears signals. A thread of its own looks for one
/// that waits there for longer than a second.
class FrameWatch {
 public:
  FrameWatch() { turn_.lock(); }
  ~FrameWatch();
  FrameWatch(const FrameWatch&) = delete;
  FrameWatch& operator=(const FrameWatch&) = delete;

  /// From here on, `end` is called in the main thread's place when a signal (or, after ending(), nothing) has waited
  /// for a second inside of call(). It must end the program. Without a thread left, there is no such watch. [main]
  void start(std::function<void()> end);
  /// Calls it; what may wait for the display belongs in there. Never returns once `end` was called. [main]
  template <class Call>
  decltype(auto) call(Call&& call) {
    const Turn turn(turn_);
    return call();
  }
  /// The program is about to end: from here on, call() may take a second. [main]
  void ending() { ending_.store(true); }

 private:
  // the main thread has turn_, except in call()
  struct Turn {
    explicit Turn(std::mutex& mutex) : turn(mutex) { turn.unlock(); }
    ~Turn() { turn.lock(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    std::mutex& turn;
  };
  void watch();

  std::function<void()> end_;
  std::mutex turn_;
  std::atomic<bool> ending_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace limber

// Polls for pending signals every 5 ms, because macOS has no sigtimedwait().
#include <algorithm>
#include <mutex>
#include <thread>

#include "base/system/blocked_signals.h"

namespace limber::system {

namespace {

constexpr std::chrono::nanoseconds kPollInterval = std::chrono::milliseconds(5);

std::mutex mutex;  // prevents another thread from consuming the pending signal

Signal pending_signal() {
  const std::scoped_lock lock(mutex);
  const sigset_t set = blocked_signals();
  sigset_t pending;
  if (sigpending(&pending) != 0) return Signal::none;
  for (const int candidate : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    if (sigismember(&pending, candidate) != 1) continue;
    int received = 0;
    return sigwait(&set, &received) == 0 ? signal_from_number(received) : Signal::none;
  }
  return Signal::none;
}

}  // namespace

Signal wait_for_signal(std::chrono::nanoseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (true) {
    if (const Signal received = pending_signal(); received != Signal::none) return received;
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= std::chrono::nanoseconds(0)) return Signal::none;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(kPollInterval, left));
  }
}

}  // namespace limber::system

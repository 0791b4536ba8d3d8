// macOS has no sigtimedwait: pending signals are looked for every few milliseconds.
#include <algorithm>
#include <mutex>
#include <thread>

#include "base/system/blocked_signals.h"

namespace limber::system {

namespace {

constexpr std::chrono::nanoseconds kLook = std::chrono::milliseconds(5);

std::mutex mutex;  // so that no other thread fetches the signal that was seen

Signal pending_signal() {
  const std::scoped_lock lock(mutex);
  const sigset_t set = blocked_signals();
  sigset_t pending;
  if (sigpending(&pending) != 0) return Signal::none;
  for (const int candidate : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    if (sigismember(&pending, candidate) != 1) continue;
    int came = 0;
    return sigwait(&set, &came) == 0 ? kind_of(came) : Signal::none;
  }
  return Signal::none;
}

}  // namespace

Signal wait_for_signal(std::chrono::nanoseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (true) {
    if (const Signal came = pending_signal(); came != Signal::none) return came;
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= std::chrono::nanoseconds(0)) return Signal::none;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(kLook, left));
  }
}

}  // namespace limber::system

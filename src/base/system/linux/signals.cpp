// Waits for signals with sigtimedwait().
#include <algorithm>
#include <ctime>

#include "base/system/blocked_signals.h"

namespace limber::system {

Signal wait_for_signal(std::chrono::nanoseconds limit) {
  const sigset_t set = blocked_signals();
  const std::int64_t ns = std::max<std::int64_t>(0, limit.count());
  const timespec time = {ns / 1'000'000'000, ns % 1'000'000'000};
  return signal_from_number(sigtimedwait(&set, nullptr, &time));
}

}  // namespace limber::system

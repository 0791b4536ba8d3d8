// Searches the at most 256 entries linearly; this happens only when a message was rejected.
#include "net/osc/error_rate_limit.h"

#include <algorithm>
#include <utility>

namespace limber::osc {

bool ErrorRateLimit::allow(const Endpoint& sender, std::int64_t now) {
  auto window = std::ranges::find(windows_, sender, &Window::sender);
  if (window == windows_.end()) {
    // replace the entry that has been idle longest
    if (windows_.size() >= kMaxSenders) windows_.erase(std::ranges::min_element(windows_, {}, &Window::begin));
    windows_.push_back({sender, now, 0, 0, false});
    window = windows_.end() - 1;
  }
  if (now < window->silent_until) return false;
  if (now - window->begin >= kSecond) {
    window->begin = now;
    window->count = 0;
  }
  if (window->count >= kMaxPerSecond) return false;
  window->count++;
  return true;
}

bool ErrorRateLimit::record_answer(const Endpoint& sender, std::int64_t now) {
  const auto window = std::ranges::find(windows_, sender, &Window::sender);
  if (window == windows_.end()) return false;
  // The limit is ten errors a second, so the window of the last error began less than two seconds ago.
  if (now >= window->silent_until && now - window->begin >= 2 * kSecond) return false;
  window->silent_until = now + kAnswerPause;
  return !std::exchange(window->answers_errors, true);
}

}  // namespace limber::osc

// A linear search over 256 short entries; it runs only when something was refused.
#include "osc/error_limit.h"

#include <algorithm>
#include <utility>

namespace limber {

bool ErrorLimit::allow(const Endpoint& sender, std::int64_t now) {
  auto window = std::ranges::find(windows_, sender, &Window::sender);
  if (window == windows_.end()) {
    // the one that was quiet for longest makes room
    if (windows_.size() >= kSenders) windows_.erase(std::ranges::min_element(windows_, {}, &Window::begin));
    windows_.push_back({sender, now, 0, 0, false});
    window = windows_.end() - 1;
  }
  if (now < window->silent_until) return false;
  if (now - window->begin >= kSecond) {
    window->begin = now;
    window->count = 0;
  }
  if (window->count >= kMost) return false;
  window->count++;
  return true;
}

bool ErrorLimit::note_echo(const Endpoint& sender, std::int64_t now) {
  const auto window = std::ranges::find(windows_, sender, &Window::sender);
  if (window == windows_.end()) return false;
  // ten errors a second: the window of the last one has begun less than two seconds ago
  if (now >= window->silent_until && now - window->begin >= 2 * kSecond) return false;
  window->silent_until = now + kEchoPause;
  return !std::exchange(window->echoes, true);
}

}  // namespace limber

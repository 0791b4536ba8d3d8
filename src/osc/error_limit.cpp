// A linear search over 256 short entries; it runs only when something was refused.
#include "osc/error_limit.h"

#include <algorithm>

namespace limber {

bool ErrorLimit::allow(const Endpoint& sender, std::int64_t now) {
  auto window = std::ranges::find(windows_, sender, &Window::sender);
  if (window == windows_.end()) {
    // the one that was quiet for longest makes room
    if (windows_.size() >= kSenders) windows_.erase(std::ranges::min_element(windows_, {}, &Window::begin));
    windows_.push_back({sender, now, 0});
    window = windows_.end() - 1;
  }
  if (now - window->begin >= kSecond) *window = {sender, now, 0};
  if (window->count >= kMost) return false;
  window->count++;
  return true;
}

}  // namespace limber

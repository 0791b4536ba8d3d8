// Who sent a message, in words.
#include "base/message.h"

#include <array>

#include <fmt/format.h>

namespace limber {

std::string sender_text(const Origin& origin) {
  if (origin.ip != 0) {
    return fmt::format("{}.{}.{}.{}:{}", origin.ip >> 24 & 255u, origin.ip >> 16 & 255u, origin.ip >> 8 & 255u,
                       origin.ip & 255u, origin.port);
  }
  // in the order of Hand
  constexpr std::array<std::string_view, 6> kHands{"osc", "query", "command_line", "console", "panel", "script"};
  return std::string(kHands[static_cast<std::size_t>(origin.hand)]);
}

}  // namespace limber

// Formats the sender of a message.
#include "base/message.h"

#include <array>

#include <fmt/format.h>

namespace limber {

std::string sender_text(const CommandOrigin& origin) {
  if (origin.ip != 0) {
    return fmt::format("{}.{}.{}.{}:{}", origin.ip >> 24 & 255u, origin.ip >> 16 & 255u, origin.ip >> 8 & 255u,
                       origin.ip & 255u, origin.port);
  }
  // in the order of CommandSource
  constexpr std::array<std::string_view, 7> kSourceNames{"osc",   "query",  "command_line", "console",
                                                         "panel", "script", "midi"};
  return std::string(kSourceNames[static_cast<std::size_t>(origin.source)]);
}

}  // namespace limber

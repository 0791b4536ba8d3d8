// Formats the sender of a message.
#include "base/message.h"

#include <array>

namespace limber {

std::string sender_text(const CommandOrigin& origin) {
  if (!origin.ip.is_any()) return system::host_port_text(system::ip_text(origin.ip), origin.port);
  // in the order of CommandSource
  constexpr std::array<std::string_view, 7> kSourceNames{"osc",   "query",  "command_line", "console",
                                                         "panel", "script", "midi"};
  return std::string(kSourceNames[static_cast<std::size_t>(origin.source)]);
}

}  // namespace limber

// What the query room is handed by the app, since it doesn't see the OSC room.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"

namespace limber {

struct QueryDoors {
  /// A message as an OSC packet, its arguments written as the tags say (f i h T s, arrays in [ ]); without tags as OSC
  /// goes out elsewhere. [query]
  std::function<std::string(const Message& message, std::string_view tags)> encode;
  /// Bytes of a client, to be looked at and carried out as what comes by UDP is. [query]
  std::function<void(const Origin& origin, std::string packet)> take;
  /// Where OSC comes in by UDP, if it does. [query]
  std::function<std::optional<std::uint16_t>()> osc_port = [] { return std::nullopt; };
  /// Names by which browsers may ask for this machine, beside its own. [query]
  std::vector<std::string> names;
  /// Whether this address may connect (IPv4, host order). [query]
  std::function<bool(std::uint32_t ip)> allowed = [](std::uint32_t) { return true; };
};

}  // namespace limber

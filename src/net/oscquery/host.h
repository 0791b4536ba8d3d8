// Functions and settings that the application provides to the query server, which does not depend on the OSC module.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"

namespace limber::oscquery {

/// The application's side of the query server.
struct QueryHost {
  /// Encodes a message as an OSC packet with the given type tags (f i h T s, arrays in [ ]); without tags as
  /// encode_message() does. [query]
  std::function<std::string(const Message& message, std::string_view tags)> encode;
  /// Processes a client's OSC packet like one that arrived by UDP. [query]
  std::function<void(const CommandOrigin& origin, std::string packet)> process;
  /// Returns the UDP port for incoming OSC, if one is open. [query]
  std::function<std::optional<std::uint16_t>()> osc_port = [] { return std::nullopt; };
  /// Additional host names by which browsers may address this machine. [query]
  std::vector<std::string> names;
  /// True if this address may connect. [query]
  std::function<bool(const system::IpAddress& ip)> is_allowed = [](const system::IpAddress&) { return true; };
};

}  // namespace limber::oscquery

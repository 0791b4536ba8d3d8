// From a validated datagram to messages. Every numeric tag becomes a number: clients differ in what they send for one
// slider.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"
#include "base/result.h"

namespace limber {

/// A message that was whole, but holds what no address takes.
struct RefusedMessage {
  std::string address;
  std::string text;  ///< What was wrong with it.
};

/// What one datagram holds. Bundles are flattened in order, those inside others too.
struct Decoded {
  std::vector<Message> messages;
  std::vector<RefusedMessage> refused;
  std::uint64_t time_tag = 1;  ///< The outermost bundle's, NTP (seconds since 1900 in the upper half); 1: now.
};

/// Decodes what packet_fault() has passed, and nothing else. i h f d become numbers, T F I booleans, s S c text, N nil;
/// an array's elements stand in the message like others; t m r b and arrays in arrays are refused. NaN and
/// infinity pass. [any]
Result<Decoded> decode_packet(const char* data, std::size_t size);

}  // namespace limber

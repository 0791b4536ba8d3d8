// Decodes a datagram to messages. All numeric tags become numbers, because clients send different types for
// the same slider.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"
#include "base/result.h"

namespace limber::osc {

/// A well-formed message with arguments that no address accepts.
struct RejectedMessage {
  std::string address;
  std::string reason;  ///< Reason of the rejection.
};

/// Consecutive messages of a nested bundle that is due later than the outermost one.
struct LaterMessages {
  std::size_t first = 0, count = 0;  ///< In Decoded::messages.
  std::uint64_t time_tag = 1;
};

/// The contents of a datagram. Bundles, including nested ones, are flattened in order.
struct Decoded {
  std::vector<Message> messages;
  std::vector<RejectedMessage> rejected;
  std::uint64_t time_tag = 1;  ///< Of the outermost bundle; NTP (seconds since 1900 in the upper half); 1: now.
  std::vector<LaterMessages> later = {};  ///< In order.
};

/// Decodes a packet; returns the error of packet_fault() if it is malformed. i h f d become numbers, T F I booleans,
/// s S c text, N nil; array elements become ordinary arguments; messages with t m r b or nested arrays are rejected.
/// NaN and infinity pass. [any]
Result<Decoded> decode_packet(const char* data, std::size_t size);

}  // namespace limber::osc

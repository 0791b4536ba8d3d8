// The validator: checks that a datagram is a complete OSC packet within our limits, never reading past its end.
// Malformed packets are dropped before anything is allocated for them.
#pragma once

#include <cstddef>

namespace limber::osc {

/// Limits for incoming packets. Sizes in bytes.
struct OscLimits {
  static constexpr std::size_t kString = 1024;       ///< Addresses and strings, without padding.
  static constexpr int kDepth = 8;                   ///< Nested bundles; a bare message has depth 0.
  static constexpr int kMessageArguments = 4096;     ///< Type tags of one message.
  static constexpr int kPacketArguments = 4 * 4096;  ///< Type tags of one datagram; bounds its decoded size.
};

/// Returns a constant error text, or null if the datagram may be decoded. [any]
const char* packet_fault(const char* data, std::size_t size);

}  // namespace limber::osc

// The validator: reports whether a datagram is a complete OSC packet within our limits, and never reads past its end.
// oscpack gets no packet that has not passed here: it crashes on some and hangs on others.
#pragma once

#include <cstddef>

namespace limber {

/// Limits on what is let in. Sizes in bytes.
struct OscLimits {
  static constexpr std::size_t kString = 1024;       ///< Addresses and strings, without their padding.
  static constexpr int kDepth = 8;                   ///< Bundles inside each other; a bare message has depth 0.
  static constexpr int kMessageArguments = 4096;     ///< Type tags of one message.
  static constexpr int kPacketArguments = 4 * 4096;  ///< Type tags of one datagram: bounds what it grows to in memory.
};

/// What is wrong with a datagram, or null when it may be decoded. The text is constant. [any]
const char* packet_fault(const char* data, std::size_t size);

}  // namespace limber

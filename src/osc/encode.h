// From messages to datagrams, by oscpack. Strict in sending: f, i and s only, as the seed has it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/message.h"
#include "osc/wire.h"

namespace limber {

/// Room for one datagram, and a little more, because oscpack asks for more than it writes.
struct PacketBuffer {
  alignas(8) std::array<char, kLargestPacket + 64> bytes;
};

/// Writes a message: numbers as f (clamped to float's range), booleans as i 0 or 1, nothing as i 0, text as s up to
/// its first NUL. Empty when it is larger than a datagram. The span lies in `buffer`. [any]
std::span<const char> encode_message(const Message& message, PacketBuffer& buffer);

/// `/pong <tick i> <time f>`; ticks beyond 31 bits begin again at 0. [any]
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);

}  // namespace limber

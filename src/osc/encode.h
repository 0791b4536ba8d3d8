// From messages to datagrams. Limber itself sends f, i and s only, as ofxDabPhysics does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

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

/// Writes the arguments as the tags say: i h f d (numbers, clamped), T or F (a boolean, as T or F), s, S, c (text), N,
/// I (an argument without a value), r m t b (hexadecimal digits as text); arrays in [ ]. Each tag but [ ] has an
/// argument that fits it. Empty when it is larger than a datagram. [any]
std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer);

/// `/pong <tick i> <time f>`; ticks beyond 31 bits begin again at 0. [any]
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);

}  // namespace limber

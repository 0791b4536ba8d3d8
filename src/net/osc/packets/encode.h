// Encodes messages as datagrams. Limber itself sends only the types f, i and s, as ofxDabPhysics does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/message.h"
#include "net/osc/packets/wire.h"

namespace limber::osc {

/// Buffer for one datagram.
struct PacketBuffer {
  alignas(8) std::array<char, kMaxPacketSize> bytes;
};

/// Encodes a message: numbers as f (clamped to float's range), booleans as i 0 or 1, nil as i 0, text as s up to its
/// first NUL. Returns an empty span if the message is larger than a datagram; otherwise the span points into `buffer`.
/// [any]
std::span<const char> encode_message(const Message& message, PacketBuffer& buffer);

/// Encodes the arguments with the given type tags: i h f d (numbers, clamped), T or F (booleans), s, S, c (text), N, I
/// (an argument without a value), r m t b (text with hexadecimal digits); arrays in [ ]. Each tag except [ ] needs one
/// argument of a matching kind. Returns an empty span if the message is larger than a datagram. [any]
std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer);

/// Encodes `/pong <tick i> <time f>`; ticks wrap to 0 after 31 bits. [any]
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);

}  // namespace limber::osc

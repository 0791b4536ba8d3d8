// The two OSC codecs: oscpack's, and our own for systems where oscpack is wrong (it takes the 64-bit `long` of arm64
// for int32). CMake decides which of them decode_packet() and the functions of osc/encode.h use; tests compare both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "osc/decode.h"
#include "osc/encode.h"

namespace limber {

/// Our own: PacketWalk and PacketWriter. Never reads beyond the end, whether the packet was validated or not.
namespace own_codec {
Result<Decoded> decode(const char* data, std::size_t size);
std::span<const char> encode(const Message& message, PacketBuffer& buffer);
std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer);
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);
}  // namespace own_codec

/// oscpack's; decodes only what packet_fault() has passed. Not defined where LIMBER_OSCPACK is 0.
namespace oscpack_codec {
Result<Decoded> decode(const char* data, std::size_t size);
std::span<const char> encode(const Message& message, PacketBuffer& buffer);
std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer);
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);
}  // namespace oscpack_codec

}  // namespace limber

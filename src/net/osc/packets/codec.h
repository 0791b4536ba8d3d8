// The two OSC codecs: oscpack's, and our own for systems where oscpack is wrong (it treats the 64-bit `long` of arm64
// as int32). CMake selects the one that decode_packet() and the functions of net/osc/packets/encode.h use; tests
// compare both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "net/osc/packets/decode.h"
#include "net/osc/packets/encode.h"

namespace limber {

/// Our own codec (PacketParser and PacketWriter). It never reads past the end, even if the packet was not validated.
namespace own_codec {
Result<Decoded> decode(const char* data, std::size_t size);
std::span<const char> encode(const Message& message, PacketBuffer& buffer);
std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer);
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);
}  // namespace own_codec

/// oscpack's codec; decodes only packets that packet_fault() has accepted. Not defined if LIMBER_OSCPACK is 0.
namespace oscpack_codec {
Result<Decoded> decode(const char* data, std::size_t size);
std::span<const char> encode(const Message& message, PacketBuffer& buffer);
std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer);
std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer);
}  // namespace oscpack_codec

}  // namespace limber

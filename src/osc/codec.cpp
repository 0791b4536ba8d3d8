// The codec that this program uses. LIMBER_OWN_OSC comes from CMakeLists.txt.
#include "osc/codec.h"

namespace limber {

#if LIMBER_OWN_OSC
namespace chosen_codec = own_codec;
#else
namespace chosen_codec = oscpack_codec;
#endif

Result<Decoded> decode_packet(const char* data, std::size_t size) { return chosen_codec::decode(data, size); }

std::span<const char> encode_message(const Message& message, PacketBuffer& buffer) {
  return chosen_codec::encode(message, buffer);
}

std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
  return chosen_codec::encode_tagged(message, tags, buffer);
}

std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
  return chosen_codec::encode_pong(tick, time, buffer);
}

}  // namespace limber

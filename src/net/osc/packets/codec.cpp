// Selects the codec of this build. LIMBER_OWN_OSC is defined by CMakeLists.txt.
#include "net/osc/packets/codec.h"

namespace limber {

#if LIMBER_OWN_OSC
namespace selected_codec = own_codec;
#else
namespace selected_codec = oscpack_codec;
#endif

Result<Decoded> decode_packet(const char* data, std::size_t size) { return selected_codec::decode(data, size); }

std::span<const char> encode_message(const Message& message, PacketBuffer& buffer) {
  return selected_codec::encode(message, buffer);
}

std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
  return selected_codec::encode_tagged(message, tags, buffer);
}

std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
  return selected_codec::encode_pong(tick, time, buffer);
}

}  // namespace limber

// What was encoded is decoded again: a frame of the streams exists as bytes only.
#include "osc/tap.h"

#include "osc/decode.h"

namespace limber {

void note_sent(Traffic& traffic, const Endpoint& to, std::span<const char> packet) {
  const Result<Decoded> decoded = decode_packet(packet.data(), packet.size());
  if (!decoded) return;
  for (const Message& message : decoded->messages) traffic.note(false, endpoint_text(to), message);
}

}  // namespace limber

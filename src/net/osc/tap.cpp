// Decodes the encoded packets again, because stream frames exist only as bytes.
#include "net/osc/tap.h"

#include "net/osc/packets/decode.h"

namespace limber {

void log_sent(MessageLog& message_log, const Endpoint& to, std::span<const char> packet) {
  const Result<Decoded> decoded = decode_packet(packet.data(), packet.size());
  if (!decoded) return;
  for (const Message& message : decoded->messages) message_log.add(false, endpoint_text(to), message);
}

}  // namespace limber

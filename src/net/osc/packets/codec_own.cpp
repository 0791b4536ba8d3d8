// Our own codec: a visitor of PacketParser that builds messages, and PacketWriter.
#include <bit>
#include <cstring>
#include <optional>

#include "net/osc/packets/codec.h"
#include "net/osc/packets/message_builder.h"
#include "net/osc/packets/message_encoder.h"
#include "net/osc/packets/packet_parser.h"
#include "net/osc/packets/packet_writer.h"

namespace limber::own_codec {

namespace {

constexpr std::uint64_t kImmediately = 1;

Arg argument_of(char tag, const char* data) {
  switch (tag) {
    case 'i':
      return Arg::of(static_cast<double>(std::bit_cast<std::int32_t>(load_u32(data))));
    case 'h':
      return Arg::of(static_cast<double>(std::bit_cast<std::int64_t>(load_u64(data))));
    case 'f':
      return Arg::of(static_cast<double>(std::bit_cast<float>(load_u32(data))));
    case 'd':
      return Arg::of(std::bit_cast<double>(load_u64(data)));
    case 'T':
    case 'I':
      return Arg::of(true);
    case 'F':
      return Arg::of(false);
    case 's':
    case 'S':
      return Arg::of(data);
    case 'c':
      return Arg::of(std::string_view(data + 3, 1));
    default:
      return {};
  }
}

class DecodingVisitor {
 public:
  explicit DecodingVisitor(Decoded& out) : out_(out) {}

  void bundle(int depth, std::uint64_t time_tag) {
    // time tag 0 is undefined; it is treated as now, like 1
    if (depth == 1) out_.time_tag = time_tag == 0 ? kImmediately : time_tag;
  }
  void message(const char* address, const char* tags) { message_.emplace(out_, address, std::strlen(tags)); }
  void argument(char tag, const char* data) {
    if (!message_) return;
    if (tag == '[' || tag == ']') {
      if (!message_->bracket(tag)) message_.reset();
    } else if (message_->accept(tag)) {
      message_->add(argument_of(tag, data));
    } else {
      message_.reset();
    }
  }
  void end_message() {
    if (message_) message_->finish();
  }

 private:
  Decoded& out_;
  std::optional<MessageBuilder> message_;  // empty: the message was rejected
};

}  // namespace

Result<Decoded> decode(const char* data, std::size_t size) {
  Decoded decoded;
  DecodingVisitor visitor(decoded);
  if (const char* const fault = PacketParser<DecodingVisitor>(visitor).packet(data, size)) return Error{fault};
  return decoded;
}

std::span<const char> encode(const Message& message, PacketBuffer& buffer) {
  return MessageEncoder<PacketWriter>::message(message, buffer);
}

std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
  return MessageEncoder<PacketWriter>::tagged(message, tags, buffer);
}

std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
  return MessageEncoder<PacketWriter>::pong(tick, time, buffer);
}

}  // namespace limber::own_codec

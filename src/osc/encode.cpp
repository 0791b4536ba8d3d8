// oscpack's writing side. It throws when the buffer is too small and then leaves half a message, so sizes come first.
#include "osc/encode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>

#include <oscpack/osc/OscOutboundPacketStream.h>

#include "base/check.h"

namespace limber {

namespace {

std::size_t message_size(const Message& message) {
  std::size_t size = padded(std::strlen(message.address.c_str())) + padded(1 + message.args.size());
  for (const Arg& arg : message.args) size += arg.is_text() ? padded(std::strlen(arg.text.c_str())) : 4;
  return size;
}

float as_float(double value) {
  constexpr double kMost = std::numeric_limits<float>::max();
  // a NaN stays one; so do infinities
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -kMost, kMost) : value);
}

void write_argument(const Arg& arg, osc::OutboundPacketStream& out) {
  switch (arg.kind) {
    case Arg::Kind::number:
      out << as_float(arg.number);
      return;
    case Arg::Kind::boolean:
      out << static_cast<osc::int32>(arg.number != 0);
      return;
    case Arg::Kind::text:
      out << arg.text.c_str();
      return;
    case Arg::Kind::nil:
      out << osc::int32{0};
      return;
  }
}

template <class Int>
Int as_integer(double value) {
  constexpr auto kLow = static_cast<double>(std::numeric_limits<Int>::min());
  // 2^63 is no int64; the next double below it is
  constexpr double kHigh = sizeof(Int) == 8 ? 9223372036854774784.0 : std::numeric_limits<std::int32_t>::max();
  return std::isfinite(value) ? static_cast<Int>(std::clamp(std::round(value), kLow, kHigh)) : Int{0};
}

void write_tagged(char tag, const Arg& arg, osc::OutboundPacketStream& out) {
  switch (tag) {
    case 'i':
      out << as_integer<osc::int32>(arg.number);
      return;
    case 'h':
      out << as_integer<osc::int64>(arg.number);
      return;
    case 'f':
      out << as_float(arg.number);
      return;
    case 'T':
      out << (arg.number != 0);
      return;
    case 's':
      out << arg.text.c_str();
      return;
    case '[':
      out << osc::BeginArray;
      return;
    case ']':
      out << osc::EndArray;
      return;
    default:
      out << osc::OscNil;
      return;
  }
}

// runs oscpack's calls; none throws where the size was computed
template <class Write>
std::span<const char> write_packet(PacketBuffer& buffer, const Write& write) {
  try {
    osc::OutboundPacketStream out(buffer.bytes.data(), buffer.bytes.size());
    write(out);
    return {out.Data(), out.Size()};
  } catch (const std::exception&) {
    const bool oscpack_found_the_buffer_too_small = true;
    LIMBER_CHECK(!oscpack_found_the_buffer_too_small);
    return {};
  }
}

}  // namespace

std::span<const char> encode_message(const Message& message, PacketBuffer& buffer) {
  if (message_size(message) > kLargestPacket) return {};
  return write_packet(buffer, [&](osc::OutboundPacketStream& out) {
    out << osc::BeginMessage(message.address.c_str());
    for (const Arg& arg : message.args) write_argument(arg, out);
    out << osc::EndMessage;
  });
}

std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
  const auto takes_one = [](char tag) { return tag != '[' && tag != ']'; };
  LIMBER_CHECK(static_cast<std::size_t>(std::ranges::count_if(tags, takes_one)) == message.args.size());
  std::size_t size = padded(std::strlen(message.address.c_str())) + padded(1 + tags.size());
  for (const Arg& arg : message.args) size += arg.is_text() ? padded(std::strlen(arg.text.c_str())) : 8;
  if (size > kLargestPacket) return {};
  return write_packet(buffer, [&](osc::OutboundPacketStream& out) {
    out << osc::BeginMessage(message.address.c_str());
    auto arg = message.args.begin();
    for (const char tag : tags) {
      if (takes_one(tag) && arg == message.args.end()) break;
      write_tagged(tag, takes_one(tag) ? *arg++ : Arg{}, out);
    }
    out << osc::EndMessage;
  });
}

std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
  return write_packet(buffer, [&](osc::OutboundPacketStream& out) {
    out << osc::BeginMessage("/pong") << static_cast<osc::int32>(tick & 0x7fffffffu) << as_float(time)
        << osc::EndMessage;
  });
}

}  // namespace limber

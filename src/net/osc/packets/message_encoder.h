// MessageEncoder: converts a Message to a packet: sizes, rounding, clamping. Both codecs use it, each with its own
// writer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "base/check.h"
#include "net/osc/packets/encode.h"
#include "net/osc/packets/hex.h"

namespace limber {

/// Encodes with a Writer, which is constructed from a buffer and its size and has the functions of PacketWriter. [any]
template <class Writer>
class MessageEncoder {
 public:
  /// As encode_message().
  static std::span<const char> message(const Message& message, PacketBuffer& buffer) {
    std::size_t size = padded(std::strlen(message.address.c_str())) + padded(1 + message.args.size());
    for (const Arg& arg : message.args) size += arg.is_text() ? padded(std::strlen(arg.text.c_str())) : 4;
    if (size > kMaxPacketSize) return {};
    Writer out(buffer.bytes.data(), buffer.bytes.size());
    out.begin_message(message.address.c_str(), message.args.size());
    for (const Arg& arg : message.args) write(arg, out);
    out.end_message();
    return finished(out);
  }

  /// As encode_tagged().
  static std::span<const char> tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
    const auto has_value = [](char tag) { return tag != '[' && tag != ']'; };
    LIMBER_CHECK(static_cast<std::size_t>(std::ranges::count_if(tags, has_value)) == message.args.size());
    std::size_t size = padded(std::strlen(message.address.c_str())) + padded(1 + tags.size());
    for (const Arg& arg : message.args) size += std::max<std::size_t>(8, padded(std::strlen(arg.text.c_str())));
    if (size > kMaxPacketSize) return {};
    Writer out(buffer.bytes.data(), buffer.bytes.size());
    out.begin_message(message.address.c_str(), tags.size());
    auto arg = message.args.begin();
    for (const char tag : tags) {
      if (has_value(tag) && arg == message.args.end()) break;
      write_tagged(tag, has_value(tag) ? *arg++ : Arg{}, out);
    }
    out.end_message();
    return finished(out);
  }

  /// As encode_pong().
  static std::span<const char> pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
    Writer out(buffer.bytes.data(), buffer.bytes.size());
    out.begin_message("/pong", 2);
    out.int32(static_cast<std::int32_t>(tick & 0x7fffffffu));
    out.float32(as_float(time));
    out.end_message();
    return finished(out);
  }

 private:
  // Sizes are checked before writing, so a writer can't run out of its buffer.
  static std::span<const char> finished(const Writer& out) {
    const std::span<const char> packet = out.packet();
    LIMBER_CHECK(!packet.empty());
    return packet;
  }

  static float as_float(double value) {
    constexpr double kMax = std::numeric_limits<float>::max();
    // NaN and infinities are sent unchanged.
    return static_cast<float>(std::isfinite(value) ? std::clamp(value, -kMax, kMax) : value);
  }

  template <class Int>
  static Int as_integer(double value) {
    constexpr auto kMin = static_cast<double>(std::numeric_limits<Int>::min());
    // 2^63 does not fit an int64; this is the next smaller double.
    constexpr double kMax = sizeof(Int) == 8 ? 9223372036854774784.0 : std::numeric_limits<std::int32_t>::max();
    return std::isfinite(value) ? static_cast<Int>(std::clamp(std::round(value), kMin, kMax)) : Int{0};
  }

  static void write(const Arg& arg, Writer& out) {
    switch (arg.kind) {
      case Arg::Kind::number:
        out.float32(as_float(arg.number));
        return;
      case Arg::Kind::boolean:
        out.int32(arg.number != 0 ? 1 : 0);
        return;
      case Arg::Kind::text:
        out.string(arg.text.c_str());
        return;
      case Arg::Kind::nil:
        out.int32(0);
        return;
    }
  }

  static void write_tagged(char tag, const Arg& arg, Writer& out) {
    switch (tag) {
      case 'i':
        out.int32(as_integer<std::int32_t>(arg.number));
        return;
      case 'h':
        out.int64(as_integer<std::int64_t>(arg.number));
        return;
      case 'f':
        out.float32(as_float(arg.number));
        return;
      case 'd':
        out.float64(arg.number);
        return;
      case 'T':
      case 'F':
        out.boolean(arg.number != 0);
        return;
      case 'I':
        out.infinitum();
        return;
      case 's':
        out.string(arg.text.c_str());
        return;
      case '[':
        out.begin_array();
        return;
      case ']':
        out.end_array();
        return;
      default:
        write_rare(tag, arg, out);
    }
  }

  // Types that Limber itself never sends.
  static void write_rare(char tag, const Arg& arg, Writer& out) {
    switch (tag) {
      case 'S':
        out.symbol(arg.text.c_str());
        return;
      case 'c':
        out.character(arg.text.empty() ? '\0' : arg.text[0]);
        return;
      case 'r':
        out.color(static_cast<std::uint32_t>(hex_number(arg.text)));
        return;
      case 'm':
        out.midi(static_cast<std::uint32_t>(hex_number(arg.text)));
        return;
      case 't':
        out.time_tag(hex_number(arg.text));
        return;
      case 'b':
        out.blob(hex_bytes(arg.text));
        return;
      default:
        out.nil();
        return;
    }
  }
};

}  // namespace limber

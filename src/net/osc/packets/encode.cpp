// Encodes messages with PacketWriter: sizes, rounding, clamping.
#include "net/osc/packets/encode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "base/check.h"
#include "net/osc/packets/packet_writer.h"

namespace limber::osc {

namespace {

// Sizes are checked before writing, so the buffer is large enough.
std::span<const char> finished(const PacketWriter& out) {
  const std::span<const char> packet = out.packet();
  LIMBER_CHECK(!packet.empty());
  return packet;
}

float as_float(double value) {
  constexpr double kMax = std::numeric_limits<float>::max();
  // NaN and infinities are sent unchanged.
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -kMax, kMax) : value);
}

template <class Int>
Int as_integer(double value) {
  constexpr auto kMin = static_cast<double>(std::numeric_limits<Int>::min());
  // 2^63 does not fit an int64; this is the next smaller double.
  constexpr double kMax = sizeof(Int) == 8 ? 9223372036854774784.0 : std::numeric_limits<std::int32_t>::max();
  return std::isfinite(value) ? static_cast<Int>(std::clamp(std::round(value), kMin, kMax)) : Int{0};
}

/// Returns 0 .. 15, or -1 if `c` is no hexadecimal digit.
int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Returns the lowest 64 bits of the number up to the first non-digit.
std::uint64_t hex_number(std::string_view digits) {
  std::uint64_t number = 0;
  for (const char c : digits) {
    if (hex_digit(c) < 0) break;
    number = number << 4 | static_cast<std::uint64_t>(hex_digit(c));
  }
  return number;
}

/// Converts pairs of digits to bytes, up to the first pair that is not two digits.
std::string hex_bytes(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < digits.size() && hex_digit(digits[i]) >= 0 && hex_digit(digits[i + 1]) >= 0; i += 2) {
    bytes += static_cast<char>(hex_digit(digits[i]) * 16 + hex_digit(digits[i + 1]));
  }
  return bytes;
}

void write(const Arg& arg, PacketWriter& out) {
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

// Types that Limber itself never sends.
void write_rare(char tag, const Arg& arg, PacketWriter& out) {
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

void write_tagged(char tag, const Arg& arg, PacketWriter& out) {
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

}  // namespace

std::span<const char> encode_message(const Message& message, PacketBuffer& buffer) {
  std::size_t size = padded(std::strlen(message.address.c_str())) + padded(1 + message.args.size());
  for (const Arg& arg : message.args) size += arg.is_text() ? padded(std::strlen(arg.text.c_str())) : 4;
  if (size > kMaxPacketSize) return {};
  PacketWriter out(buffer.bytes.data(), buffer.bytes.size());
  out.begin_message(message.address.c_str(), message.args.size());
  for (const Arg& arg : message.args) write(arg, out);
  out.end_message();
  return finished(out);
}

std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
  const auto has_value = [](char tag) { return tag != '[' && tag != ']'; };
  LIMBER_CHECK(static_cast<std::size_t>(std::ranges::count_if(tags, has_value)) == message.args.size());
  std::size_t size = padded(std::strlen(message.address.c_str())) + padded(1 + tags.size());
  for (const Arg& arg : message.args) size += std::max<std::size_t>(8, padded(std::strlen(arg.text.c_str())));
  if (size > kMaxPacketSize) return {};
  PacketWriter out(buffer.bytes.data(), buffer.bytes.size());
  out.begin_message(message.address.c_str(), tags.size());
  auto arg = message.args.begin();
  for (const char tag : tags) {
    if (has_value(tag) && arg == message.args.end()) break;
    write_tagged(tag, has_value(tag) ? *arg++ : Arg{}, out);
  }
  out.end_message();
  return finished(out);
}

std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
  PacketWriter out(buffer.bytes.data(), buffer.bytes.size());
  out.begin_message("/pong", 2);
  out.int32(static_cast<std::int32_t>(tick & 0x7fffffffu));
  out.float32(as_float(time));
  out.end_message();
  return finished(out);
}

}  // namespace limber::osc

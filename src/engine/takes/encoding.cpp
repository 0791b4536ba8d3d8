// Encoding of numbers, strings, messages and frames.
#include "engine/takes/encoding.h"

#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"

namespace limber::engine {

namespace {

// Type code of an argument: n nil, s text, T and F boolean, i integer, f float, d double.
char type_of(const Arg& arg) {
  if (arg.kind == Arg::Kind::nil) return 'n';
  if (arg.kind == Arg::Kind::text) return 's';
  if (arg.kind == Arg::Kind::boolean) return arg.number != 0 ? 'T' : 'F';
  const double v = arg.number;
  const auto bits = std::bit_cast<std::uint64_t>(v);
  if (std::abs(v) < 1e9 && std::bit_cast<std::uint64_t>(static_cast<double>(static_cast<std::int64_t>(v))) == bits)
    return 'i';
  const bool fits = std::abs(v) < 3e38 && std::bit_cast<std::uint64_t>(double{static_cast<float>(v)}) == bits;
  return fits ? 'f' : 'd';
}

void write_arg(TakeEncoder& out, char type, const Arg& arg) {
  if (type == 's') out.string(arg.text);
  if (type == 'f') out.fixed_int(std::bit_cast<std::uint32_t>(static_cast<float>(arg.number)), 4);
  if (type == 'd') out.real(arg.number);
  if (type != 'i') return;
  const auto v = static_cast<std::int64_t>(arg.number);
  out.varint((static_cast<std::uint64_t>(v) << 1u) ^ static_cast<std::uint64_t>(v >> 63));
}

Arg read_arg(TakeDecoder& in, char type) {
  if (type == 'T' || type == 'F') return Arg::of(type == 'T');
  if (type == 's') return Arg::of(in.string());
  if (type == 'f') return Arg::of(double{std::bit_cast<float>(static_cast<std::uint32_t>(in.fixed_int(4)))});
  if (type == 'd') return Arg::of(in.real());
  if (type == 'i') {
    const std::uint64_t z = in.varint();
    return Arg::of(static_cast<double>(static_cast<std::int64_t>(z >> 1u) ^ -static_cast<std::int64_t>(z & 1u)));
  }
  if (type != 'n') in.fail();
  return {};
}

// bytes before the types in a header: controller, ip, port, types, 0, address
constexpr std::size_t kTypesOffset = 7;
// added to the controller of a sender with an IPv6 address, whose 16 bytes and zone replace the 4 bytes
constexpr std::uint8_t kIpv6 = 0x80;
constexpr std::size_t kIpv6Bytes = 16;  // more than for IPv4

}  // namespace

void TakeEncoder::varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7u) byte(static_cast<std::uint8_t>(value | 0x80u));
  byte(static_cast<std::uint8_t>(value));
}

void TakeEncoder::fixed_int(std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; i++) byte(static_cast<std::uint8_t>(value >> (8 * i)));
}

void TakeEncoder::real(double value) { fixed_int(std::bit_cast<std::uint64_t>(value), 8); }

void TakeEncoder::string(std::string_view value) {
  varint(value.size());
  out_.append(value);
}

std::string_view TakeDecoder::read_bytes(std::size_t bytes) {
  if (bytes > bytes_.size()) {
    failed_ = true;
    bytes_ = {};
    return {};
  }
  const std::string_view data = bytes_.substr(0, bytes);
  bytes_.remove_prefix(bytes);
  return data;
}

std::uint8_t TakeDecoder::byte() {
  const std::string_view data = read_bytes(1);
  return data.empty() ? 0 : static_cast<std::uint8_t>(data[0]);
}

std::uint64_t TakeDecoder::varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint8_t next = byte();
    value |= std::uint64_t{next & 0x7fu} << shift;
    if ((next & 0x80u) == 0) return value;
  }
  failed_ = true;
  return 0;
}

std::uint64_t TakeDecoder::fixed_int(int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; i++) value |= std::uint64_t{byte()} << (8 * i);
  return value;
}

double TakeDecoder::real() { return std::bit_cast<double>(fixed_int(8)); }

std::string_view TakeDecoder::string() { return read_bytes(count()); }

std::size_t TakeDecoder::count() {
  const std::uint64_t value = varint();
  if (value <= bytes_.size()) return static_cast<std::size_t>(value);
  failed_ = true;
  bytes_ = {};
  return 0;
}

void InputCodec::encode(TakeEncoder& out, const Message& message, const CommandOrigin& origin) {
  key_.clear();
  TakeEncoder key(key_);
  key.byte(static_cast<std::uint8_t>(origin.source));
  if (origin.ip.is_v6) key_.back() = static_cast<char>(key_.back() | kIpv6);
  if (origin.ip.is_v6) {
    key.fixed_int(origin.ip.high, 8);
    key.fixed_int(origin.ip.low, 8);
    key.fixed_int(origin.ip.zone, 4);
  } else {
    key.fixed_int(origin.ip.low, 4);
  }
  key.fixed_int(origin.port, 2);
  const std::size_t types = key_.size();
  for (const Arg& arg : message.args) key_.push_back(type_of(arg));
  key_.push_back('\0');
  key_.append(message.address);
  const auto entry = header_numbers_.find(key_);
  if (entry != header_numbers_.end()) {
    out.varint(entry->second);
  } else {
    // 1: a new header, added to the table; 0: a new header that is not added because the table is full
    const bool add_to_table = header_numbers_.size() < max_headers_;
    if (add_to_table) header_numbers_.emplace(key_, static_cast<std::uint32_t>(header_numbers_.size() + 2));
    out.varint(add_to_table ? 1 : 0);
    out.string(key_);
  }
  for (std::size_t i = 0; i < message.args.size(); i++) write_arg(out, key_[types + i], message.args[i]);
}

std::optional<InputCodec::Header> InputCodec::parse_header(std::string_view key) {
  TakeDecoder in(key);
  const std::uint8_t first = in.byte();
  const bool is_v6 = (first & kIpv6) != 0;
  const auto source = static_cast<std::uint8_t>(first & ~kIpv6);
  const std::size_t types = is_v6 ? kTypesOffset + kIpv6Bytes : kTypesOffset;
  const std::size_t end = key.size() > types ? key.find('\0', types) : key.npos;
  if (end == key.npos) return {};
  if (source > static_cast<std::uint8_t>(CommandSource::midi)) return {};
  Header header;
  header.origin.source = static_cast<CommandSource>(source);
  if (is_v6) {
    const std::uint64_t high = in.fixed_int(8);
    const std::uint64_t low = in.fixed_int(8);
    header.origin.ip = system::IpAddress(high, low, static_cast<std::uint32_t>(in.fixed_int(4)));
  } else {
    header.origin.ip = static_cast<std::uint32_t>(in.fixed_int(4));
  }
  header.origin.port = static_cast<std::uint16_t>(in.fixed_int(2));
  header.types = key.substr(types, end - types);
  header.address = key.substr(end + 1);
  return header;
}

bool InputCodec::decode(TakeDecoder& in, InputRecord& message) {
  const std::uint64_t number = in.varint();
  std::optional<Header> new_header;
  if (number < 2) {
    new_header = parse_header(in.string());
    if (!new_header) return false;
  } else if (number - 2 >= headers_.size()) {
    return false;
  }
  const Header& header = new_header ? *new_header : headers_[number - 2];
  message.origin = header.origin;
  message.message.address = header.address;
  std::vector<Arg>& args = message.message.args;
  args.resize(header.types.size());
  for (std::size_t i = 0; i < args.size() && !in.failed(); i++) args[i] = read_arg(in, header.types[i]);
  if (number == 1) headers_.push_back(std::move(*new_header));
  return !in.failed();
}

std::uint32_t frame_checksum(TakeFrame kind, std::string_view payload) {
  const std::uint64_t hash = hash_bytes(payload, hash_bytes({reinterpret_cast<const char*>(&kind), 1}));
  return static_cast<std::uint32_t>(hash ^ (hash >> 32u));
}

void append_frame(std::string& out, TakeFrame kind, std::string_view payload) {
  TakeEncoder bytes(out);
  bytes.byte(static_cast<std::uint8_t>(kind));
  bytes.string(payload);
  bytes.fixed_int(frame_checksum(kind, payload), 4);
}

}  // namespace limber::engine

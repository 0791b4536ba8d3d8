// PacketParser: parses OSC packets within our limits and calls a visitor. The validator and the decoder are visitors.
// Each length is checked against the remaining bytes before anything after it is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "net/osc/packets/validate.h"
#include "net/osc/packets/wire.h"

namespace limber::osc {

/// Visits the elements of a packet in order. A visitor has the functions
///   void bundle(int depth, std::uint64_t time_tag)         a bundle begins; the outermost has depth 1
///   void end_bundle(int depth)                             optional
///   void message(const char* address, const char* tags)    both are NUL-terminated
///   void argument(char tag, const char* data)              its bounds are checked; also called for array brackets
///   void end_message()
/// and must discard its results if `packet()` returns an error. [any]
template <class Visitor>
class PacketParser {
 public:
  explicit PacketParser(Visitor& visitor) : visitor_(visitor) {}

  /// Returns a constant error text, or null if the packet is valid.
  const char* packet(const char* data, std::size_t size) {
    if (size > kMaxPacketSize) return "larger than 65504 bytes";
    return element(data, size, 0);
  }

 private:
  /// Returns the padded size of the string at `p`, or 0 if it does not end within `left` bytes. The last padding byte
  /// must be 0, as OSC requires: parsers that look for the end only there agree on where a string ends.
  static std::size_t string_size(const char* p, std::size_t left) {
    const void* end = std::memchr(p, 0, left);
    if (end == nullptr) return 0;
    const std::size_t size = padded(static_cast<std::size_t>(static_cast<const char*>(end) - p));
    if (size > left || p[size - 1] != 0) return 0;
    return size;
  }

  const char* element(const char* data, std::size_t size, int depth) {
    if (size < 4 || size % 4 != 0) return "a size that is not a multiple of 4";
    if (data[0] == '/') return message(data, size);
    if (data[0] == '#') return bundle(data, size, depth + 1);
    return "it begins with neither '/' nor '#bundle'";
  }

  const char* bundle(const char* data, std::size_t size, int depth);
  const char* message(const char* data, std::size_t size);
  const char* arguments(const char* data, std::size_t size, const char* tags, std::size_t at);
  static const char* one_argument(char tag, const char* data, std::size_t size, std::size_t& at);

  Visitor& visitor_;
  int arguments_ = 0;  // number of type tags so far in the whole datagram
};

template <class Visitor>
const char* PacketParser<Visitor>::bundle(const char* data, std::size_t size, int depth) {
  if (size < kBundleHeader || std::memcmp(data, "#bundle", 8) != 0) return "a bundle without its header";
  if (depth > OscLimits::kDepth) return "bundles nested deeper than 8";
  visitor_.bundle(depth, load_u64(data + 8));
  std::size_t at = kBundleHeader;
  while (at < size) {
    if (size - at < 4) return "a bundle that is cut off";
    const std::size_t length = load_u32(data + at);
    at += 4;
    if (length > size - at) return "a bundle's element is larger than the bundle";
    if (const char* fault = element(data + at, length, depth)) return fault;
    at += length;
  }
  if constexpr (requires { visitor_.end_bundle(depth); }) visitor_.end_bundle(depth);
  return nullptr;
}

/// Returns the size of an argument if its type tag determines it.
inline std::optional<std::size_t> fixed_argument_size(char tag) {
  switch (tag) {
    case 'T':
    case 'F':
    case 'N':
    case 'I':
    case '[':
    case ']':
      return 0;
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm':
      return 4;
    case 'h':
    case 'd':
    case 't':
      return 8;
    default:
      return std::nullopt;
  }
}

/// Advances `at` past the argument.
template <class Visitor>
const char* PacketParser<Visitor>::one_argument(char tag, const char* data, std::size_t size, std::size_t& at) {
  const std::size_t left = size - at;
  std::size_t length = 0;
  if (const std::optional<std::size_t> fixed = fixed_argument_size(tag)) {
    length = *fixed;
  } else if (tag == 's' || tag == 'S') {
    length = string_size(data + at, left);
    if (length == 0) return "a string that does not end";
    if (length > OscLimits::kString + 4) return "a string longer than 1024 bytes";
  } else if (tag == 'b') {
    if (left < 4) return "a blob without its size";
    const std::uint32_t blob = load_u32(data + at);
    if (blob > left - 4) return "a blob larger than its message";
    length = 4 + (std::size_t{blob} + 3) / 4 * 4;
  } else {
    return "an unknown type tag";
  }
  if (length > left) return "fewer arguments than type tags";
  at += length;
  return nullptr;
}

template <class Visitor>
const char* PacketParser<Visitor>::arguments(const char* data, std::size_t size, const char* tags, std::size_t at) {
  int level = 0;
  int count = 0;
  for (const char* tag = tags; *tag != 0; tag++) {
    if (++count > OscLimits::kMessageArguments) return "more than 4096 arguments";
    const std::size_t value = at;
    if (const char* fault = one_argument(*tag, data, size, at)) return fault;
    level += *tag == '[' ? 1 : *tag == ']' ? -1 : 0;
    if (level < 0) return "unbalanced arrays";
    visitor_.argument(*tag, data + value);
  }
  if (level != 0) return "unbalanced arrays";
  arguments_ += count;
  if (arguments_ > OscLimits::kPacketArguments) return "more than 16384 arguments in one datagram";
  return nullptr;
}

template <class Visitor>
const char* PacketParser<Visitor>::message(const char* data, std::size_t size) {
  const std::size_t address = string_size(data, size);
  if (address == 0) return "an address that does not end";
  if (address > OscLimits::kString + 4) return "an address longer than 1024 bytes";
  for (const char* c = data; *c != 0; c++) {
    if (*c < 0x20 || *c > 0x7e) return "an address that is not printable ASCII";
  }
  // old clients leave out the type tags of a message without arguments
  const char* tags = "";
  std::size_t at = address;
  if (address != size) {
    if (data[address] != ',') return "arguments without type tags";
    const std::size_t tags_size = string_size(data + address, size - address);
    if (tags_size == 0) return "type tags that do not end";
    tags = data + address + 1;
    at += tags_size;
  }
  visitor_.message(data, tags);
  if (const char* fault = arguments(data, size, tags, at)) return fault;
  visitor_.end_message();
  return nullptr;
}

}  // namespace limber::osc

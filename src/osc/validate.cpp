// Every length is compared with what is left before anything behind it is read.
#include "osc/validate.h"

#include <cstdint>
#include <cstring>

#include "osc/wire.h"

namespace limber {

namespace {

std::uint32_t read_u32(const char* p) {
  const auto* b = reinterpret_cast<const unsigned char*>(p);
  return std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
}

struct Walk {
  int arguments = 0;  // type tags seen in the whole datagram

  const char* element(const char* data, std::size_t size, int depth);
  const char* bundle(const char* data, std::size_t size, int depth);
  const char* message(const char* data, std::size_t size);
  const char* one_argument(char tag, const char* data, std::size_t size, std::size_t& at) const;
};

// gives the padded size of the string at `p`, 0 when it does not end within `left`. The last byte of the padding has
// to be 0: oscpack looks there alone for the end, so that one place is the end for both of us.
std::size_t string_size(const char* p, std::size_t left) {
  const void* end = std::memchr(p, 0, left);
  if (end == nullptr) return 0;
  const std::size_t size = padded(static_cast<std::size_t>(static_cast<const char*>(end) - p));
  if (size > left || p[size - 1] != 0) return 0;
  return size;
}

const char* Walk::element(const char* data, std::size_t size, int depth) {
  if (size < 4 || size % 4 != 0) return "a size that is not a multiple of 4";
  if (data[0] == '#') return bundle(data, size, depth + 1);
  if (data[0] == '/') return message(data, size);
  return "it begins with neither '/' nor '#bundle'";
}

const char* Walk::bundle(const char* data, std::size_t size, int depth) {
  if (size < kBundleHeader || std::memcmp(data, "#bundle", 8) != 0) return "a bundle without its header";
  if (depth > OscLimits::kDepth) return "bundles nested deeper than 8";
  std::size_t at = kBundleHeader;
  while (at < size) {
    if (size - at < 4) return "a bundle that is cut off";
    const std::size_t length = read_u32(data + at);
    at += 4;
    if (length > size - at) return "a bundle's element is larger than the bundle";
    if (const char* fault = element(data + at, length, depth)) return fault;
    at += length;
  }
  return nullptr;
}

// moves `at` behind the argument
const char* Walk::one_argument(char tag, const char* data, std::size_t size, std::size_t& at) const {
  const std::size_t left = size - at;
  std::size_t length = 0;
  switch (tag) {
    case 'T':
    case 'F':
    case 'N':
    case 'I':
    case '[':
    case ']':
      return nullptr;
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm':
      length = 4;
      break;
    case 'h':
    case 'd':
    case 't':
      length = 8;
      break;
    case 's':
    case 'S':
      length = string_size(data + at, left);
      if (length == 0) return "a string that does not end";
      if (length > OscLimits::kString + 4) return "a string longer than 1024 bytes";
      break;
    case 'b': {
      if (left < 4) return "a blob without its size";
      const std::uint32_t blob = read_u32(data + at);
      if (blob > left - 4) return "a blob larger than its message";
      length = 4 + (std::size_t{blob} + 3) / 4 * 4;
      break;
    }
    default:
      return "an unknown type tag";
  }
  if (length > left) return "fewer arguments than type tags";
  at += length;
  return nullptr;
}

const char* Walk::message(const char* data, std::size_t size) {
  const std::size_t address = string_size(data, size);
  if (address == 0) return "an address that does not end";
  if (address > OscLimits::kString + 4) return "an address longer than 1024 bytes";
  for (const char* c = data; *c != 0; c++) {
    if (*c < 0x20 || *c > 0x7e) return "an address that is not printable ASCII";
  }
  // an old client's message without arguments may leave its type tags out
  if (address == size) return nullptr;
  if (data[address] != ',') return "arguments without type tags";
  const std::size_t tags_size = string_size(data + address, size - address);
  if (tags_size == 0) return "type tags that do not end";
  std::size_t at = address + tags_size;
  int level = 0;
  int count = 0;
  for (const char* tag = data + address + 1; *tag != 0; tag++) {
    if (++count > OscLimits::kMessageArguments) return "more than 4096 arguments";
    if (const char* fault = one_argument(*tag, data, size, at)) return fault;
    level += *tag == '[' ? 1 : *tag == ']' ? -1 : 0;
    if (level < 0) return "unbalanced arrays";
  }
  if (level != 0) return "unbalanced arrays";
  arguments += count;
  if (arguments > OscLimits::kPacketArguments) return "more than 16384 arguments in one datagram";
  return nullptr;
}

}  // namespace

const char* packet_fault(const char* data, std::size_t size) {
  if (size > kLargestPacket) return "larger than 65504 bytes";
  Walk walk;
  return walk.element(data, size, 0);
}

}  // namespace limber

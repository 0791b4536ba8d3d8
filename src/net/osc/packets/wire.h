// Sizes and byte order of OSC packets, shared by parsers and writers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace limber::osc {

inline constexpr std::size_t kMaxPacketSize = 65504;  ///< Bytes: the largest UDP payload that is a multiple of 4.
inline constexpr std::size_t kBundleHeader = 16;      ///< "#bundle", its NUL, eight bytes of time tag.

/// Size of a string of that length with its one to four terminating NULs, a multiple of 4.
constexpr std::size_t padded(std::size_t length) { return (length / 4 + 1) * 4; }

/// Load and store big-endian numbers at any alignment.
inline std::uint32_t load_u32(const char* from) {
  std::uint32_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return std::endian::native == std::endian::little ? __builtin_bswap32(value) : value;
}
inline std::uint64_t load_u64(const char* from) {
  std::uint64_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return std::endian::native == std::endian::little ? __builtin_bswap64(value) : value;
}
inline void store_u32(char* to, std::uint32_t value) {
  if constexpr (std::endian::native == std::endian::little) value = __builtin_bswap32(value);
  std::memcpy(to, &value, sizeof value);
}
inline void store_u64(char* to, std::uint64_t value) {
  if constexpr (std::endian::native == std::endian::little) value = __builtin_bswap64(value);
  std::memcpy(to, &value, sizeof value);
}

}  // namespace limber::osc

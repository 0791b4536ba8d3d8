// The sizes of OSC on the wire that those who read and those who write it share.
#pragma once

#include <cstddef>

namespace limber {

inline constexpr std::size_t kLargestPacket = 65504;  ///< Bytes: the largest UDP payload that is a multiple of 4.
inline constexpr std::size_t kBundleHeader = 16;      ///< "#bundle", its NUL, eight bytes of time tag.

/// Bytes of a text of that length with its NULs up to a multiple of 4: one to four of them.
constexpr std::size_t padded(std::size_t length) { return (length / 4 + 1) * 4; }

}  // namespace limber

// Software prefetch, which loads memory into the cache before it is used.
#pragma once

#include <cstddef>

namespace limber {

/// Prefetches all cache lines of the memory; null is allowed. An invalid address is harmless, since nothing is read.
[[gnu::always_inline]] inline void prefetch(const void* begin, std::size_t bytes) {
  if (begin == nullptr || bytes == 0) return;
  constexpr std::size_t kLine = 64;
  const auto* const from = static_cast<const char*>(begin);
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(from + at);
  __builtin_prefetch(from + bytes - 1);
}

}  // namespace limber

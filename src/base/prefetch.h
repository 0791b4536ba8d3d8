// Asking for memory before it is its turn: what lies far off after a tick of physics comes while other things are done.
#pragma once

#include <cstddef>

namespace limber {

/// Asks for all lines of so many bytes; for none where there is nothing. Reads nothing, so a wrong place does no harm.
[[gnu::always_inline]] inline void prefetch(const void* begin, std::size_t bytes) {
  if (begin == nullptr || bytes == 0) return;
  constexpr std::size_t kLine = 64;
  const auto* const from = static_cast<const char*>(begin);
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(from + at);
  __builtin_prefetch(from + bytes - 1);
}

}  // namespace limber

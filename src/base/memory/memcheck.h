// Requests to valgrind's memcheck. Without its header, or outside of valgrind, they do nothing. [any]
#pragma once

#include <cstddef>

#if __has_include(<valgrind/memcheck.h>)
#include <valgrind/memcheck.h>
#endif

namespace limber {

/// Marks memory as uninitialized, so that memcheck reports a read of it before a write. An allocator calls it with each
/// block: it takes memory from the system in zeroed pages, which count as initialized, and reuses blocks.
inline void mark_uninitialized([[maybe_unused]] void* block, [[maybe_unused]] std::size_t size) {
#ifdef VALGRIND_MAKE_MEM_UNDEFINED
  (void)VALGRIND_MAKE_MEM_UNDEFINED(block, size);
#endif
}

}  // namespace limber

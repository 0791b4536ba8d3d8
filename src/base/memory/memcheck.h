// Requests to valgrind's memcheck. Without its header, or outside of valgrind, they do nothing. [any]
#pragma once

#include <cstddef>

namespace limber {

/// Marks memory as uninitialized, so that memcheck reports a read of it before a write. An allocator calls it with each
/// block: it takes memory from the system in zeroed pages, which count as initialized, and reuses blocks.
void mark_uninitialized(void* block, std::size_t size);

}  // namespace limber

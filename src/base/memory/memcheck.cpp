// Requests to valgrind's memcheck.
#include "base/memory/memcheck.h"

#if __has_include(<valgrind/memcheck.h>)
#include <valgrind/memcheck.h>
#endif

namespace limber {

void mark_uninitialized([[maybe_unused]] void* block, [[maybe_unused]] std::size_t size) {
#ifdef VALGRIND_MAKE_MEM_UNDEFINED
  (void)VALGRIND_MAKE_MEM_UNDEFINED(block, size);
#endif
}

}  // namespace limber

// Virtual memory with mmap().
#include "base/system/virtual_memory.h"

#include <sys/mman.h>
#include <unistd.h>

namespace limber::system {

std::size_t page_size() {
  static const auto bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return bytes;
}

std::byte* reserve_memory(std::size_t bytes, std::uintptr_t hint) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): no object has this address yet
  auto* const place = reinterpret_cast<void*>(hint);
  void* const mapped = mmap(place, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return mapped == MAP_FAILED ? nullptr : static_cast<std::byte*>(mapped);
}

bool commit_memory(std::byte* begin, std::size_t bytes) {
  return mprotect(static_cast<void*>(begin), bytes, PROT_READ | PROT_WRITE) == 0;
}

void release_memory(std::byte* begin, std::size_t bytes) { munmap(static_cast<void*>(begin), bytes); }

void prefer_large_pages([[maybe_unused]] std::byte* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(MADV_HUGEPAGE)
  (void)madvise(static_cast<void*>(begin), bytes, MADV_HUGEPAGE);
#endif
}

}  // namespace limber::system

// Arena: a memory allocator in one address range that never moves. Its bookkeeping is in the same range, so that the
// whole arena can be captured (base/memory/page_store.h) and restored in place. Not thread-safe: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/memory/address_space.h"
#include "base/memory/page_store.h"

namespace limber {

/// Reserves its addresses at construction and commits memory as needed; committed memory is returned by the destructor
/// only.
class Arena {
 public:
  static constexpr std::size_t kReserve = std::size_t{2}
                                          << 30;  ///< Reserved addresses, bytes; memory is committed as needed.

  explicit Arena(AddressSpace& space = AddressSpace::of_system());
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// False if the addresses could not be reserved; all allocations fail then.
  bool exists() const { return head_ != nullptr; }
  /// Returns a block aligned to 16 bytes, or null if the arena is full.
  void* allocate(std::size_t size);
  /// Frees a block of this arena, not null.
  void free(void* block);
  /// Resizes a block like realloc(), which may move it: null allocates, size 0 frees. `before` is its current size. On
  /// failure returns null and leaves the block unchanged.
  void* resize(void* block, std::size_t before, std::size_t after);

  /// Copies all used memory to `out`. Pages that are equal to those of `before` are shared with it (null: none).
  void capture(PageStore& pages, const PageStore::PageList* before, PageStore::PageList& out) const;
  /// Restores the arena to its state at the capture; `copy` comes from capture() of this arena.
  void restore(const PageStore& pages, const PageStore::PageList& copy);

 private:
  struct Chunk;
  struct Head;
  void* allocate_run(std::size_t size);
  std::uint32_t allocate_chunks(std::uint32_t count);
  void free_chunks(std::uint32_t first, std::uint32_t count);
  bool open_chunk(std::uint32_t kind);
  void link(std::uint32_t chunk);
  void unlink(std::uint32_t chunk);
  std::byte* data_of(std::uint32_t chunk) const;
  std::uint32_t chunk_of(const void* block) const;

  AddressSpace& space_;
  Head* head_ = nullptr;
  Chunk* chunks_ = nullptr;
  std::byte* data_ = nullptr;
};

}  // namespace limber

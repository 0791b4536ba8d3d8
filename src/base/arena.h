// Arena: memory that lies in one stretch whose address never changes, with all that it knows about itself inside, so
// that it can be copied whole (base/page_store.h) and brought back in place. One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/address_space.h"
#include "base/page_store.h"

namespace limber {

class Arena {
 public:
  static constexpr std::size_t kReserve = std::size_t{2} << 30;  ///< Of addresses; memory is taken as it is used.

  explicit Arena(AddressSpace& space = AddressSpace::of_system());
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// False: the system gave no stretch of addresses; then there is no memory in it.
  bool exists() const { return head_ != nullptr; }
  /// Aligned to 16 bytes. Null: there is no more.
  void* allocate(std::size_t size);
  void free(void* block);
  /// As realloc() does; `before`: its size now.
  void* resize(void* block, std::size_t before, std::size_t after);

  /// All that is in use, in pages that are shared with `before` where they are the same; null: with nobody.
  void copy(PageStore& pages, const PageStore::Image* before, PageStore::Image& out) const;
  /// Everything is as it was when the image was taken of it.
  void bring_back(const PageStore& pages, const PageStore::Image& image);

 private:
  struct Chunk;
  struct Head;
  void* allocate_run(std::size_t size);
  std::uint32_t take_chunks(std::uint32_t count);
  void give_chunks(std::uint32_t first, std::uint32_t count);
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

// PageStore: copies of memory in pages of 4 KiB, whatever the size of the system's pages. Copies of the same memory
// share the pages that did not change between them, so that thirty of them take little more than what moves. Its room
// is used again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limber {

class PageStore {
 public:
  static constexpr std::size_t kPage = 4096;
  /// The pages of a copy, in order.
  using Image = std::vector<std::uint32_t>;

  /// Adds a copy of the memory, the last page of it perhaps a part of one. Pages that stand at the same place of
  /// `before` and are the same are shared with it.
  void append(Image& out, std::span<const std::byte> memory, const Image* before);
  /// Adds pages that copy_back leaves as they are.
  void append_none(Image& out, std::size_t bytes) const;
  /// Writes the pages from `at` on back over as much memory; the answer: where the next begin.
  std::size_t copy_back(const Image& image, std::size_t at, std::span<std::byte> memory) const;
  /// The image is no longer needed; it is empty then.
  void release(Image& image);

  /// Bytes of all pages that any image has.
  std::size_t bytes() const { return used_ * kPage; }
  /// Gives the room back to the system; no image may be left.
  void clear();

 private:
  static constexpr std::uint32_t kNone = 0;  // numbers of pages begin with 2
  static constexpr std::uint32_t kZeros = 1;
  static constexpr std::uint32_t kFirst = 2;
  static constexpr std::uint32_t kSlab = 256;  // pages that are taken from the system at a time

  std::byte* page(std::uint32_t number) const {
    return slabs_[(number - kFirst) / kSlab].get() + std::size_t{(number - kFirst) % kSlab} * kPage;
  }
  std::uint32_t take();

  std::vector<std::unique_ptr<std::byte[]>> slabs_;
  std::vector<std::uint32_t> shares_;  // of each page: images that have it
  std::vector<std::uint32_t> spare_;
  std::size_t used_ = 0;
};

}  // namespace limber

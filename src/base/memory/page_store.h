// PageStore: stores copies of memory in pages of 4 KiB (independent of the system's page size). Successive copies of
// the same memory share the pages that did not change, so that dozens of them need little more memory than the changes.
// Freed pages are reused.
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
  /// A copy: the numbers of its pages, in order.
  using PageList = std::vector<std::uint32_t>;

  /// Appends a copy of the memory to the list; the last page may be partial. Pages that are equal to those at the same
  /// positions of `before` are shared with it.
  void append(PageList& out, std::span<const std::byte> memory, const PageList* before);
  /// Appends placeholders for this many bytes; restore() leaves their memory unchanged.
  void append_placeholders(PageList& out, std::size_t bytes) const;
  /// Copies the pages from index `at` on to the memory. Returns the index of the next page.
  std::size_t restore(const PageList& copy, std::size_t at, std::span<std::byte> memory) const;
  /// Frees a copy and clears its list.
  void release(PageList& copy);

  /// Bytes of all pages in use.
  std::size_t bytes() const { return used_ * kPage; }
  /// Returns all memory to the system. All copies must have been released.
  void clear();

 private:
  static constexpr std::uint32_t kNone = 0;  // stored pages are numbered from 2
  static constexpr std::uint32_t kZeros = 1;
  static constexpr std::uint32_t kFirst = 2;
  static constexpr std::uint32_t kSlab = 256;  // pages per allocation

  std::byte* page(std::uint32_t number) const {
    return slabs_[(number - kFirst) / kSlab].get() + std::size_t{(number - kFirst) % kSlab} * kPage;
  }
  std::uint32_t allocate_page();

  std::vector<std::unique_ptr<std::byte[]>> slabs_;
  std::vector<std::uint32_t> reference_counts_;  // of each page: number of copies that share it
  std::vector<std::uint32_t> free_pages_;
  std::size_t used_ = 0;
};

}  // namespace limber

// Compares, shares and copies pages.
#include "base/memory/page_store.h"

#include <algorithm>
#include <cstring>

namespace limber {

namespace {
constexpr std::byte kZeroPage[PageStore::kPage] = {};
}

std::uint32_t PageStore::allocate_page() {
  if (free_pages_.empty()) {
    const auto first = static_cast<std::uint32_t>(slabs_.size()) * kSlab + kFirst;
    slabs_.push_back(std::make_unique_for_overwrite<std::byte[]>(kSlab * kPage));
    reference_counts_.resize(slabs_.size() * kSlab);
    free_pages_.reserve(reference_counts_.size());
    for (std::uint32_t i = kSlab; i-- > 0;) free_pages_.push_back(first + i);
  }
  const std::uint32_t number = free_pages_.back();
  free_pages_.pop_back();
  reference_counts_[number - kFirst] = 1;
  used_++;
  return number;
}

void PageStore::append(PageList& out, std::span<const std::byte> memory, const PageList* before) {
  for (std::size_t at = 0; at < memory.size(); at += kPage) {
    const std::byte* const from = memory.data() + at;
    const std::size_t size = std::min(kPage, memory.size() - at);
    const std::size_t position = out.size();
    const std::uint32_t shared = before != nullptr && position < before->size() ? (*before)[position] : kNone;
    if (shared >= kFirst && std::memcmp(page(shared), from, size) == 0) {
      reference_counts_[shared - kFirst]++;
      out.push_back(shared);
    } else if (from[0] == std::byte{0} && std::memcmp(kZeroPage, from, size) == 0) {
      out.push_back(kZeros);
    } else {
      const std::uint32_t copied = allocate_page();
      std::memcpy(page(copied), from, size);
      out.push_back(copied);
    }
  }
}

void PageStore::append_placeholders(PageList& out, std::size_t bytes) const {
  out.insert(out.end(), (bytes + kPage - 1) / kPage, kNone);
}

std::size_t PageStore::restore(const PageList& copy, std::size_t at, std::span<std::byte> memory) const {
  for (std::size_t to = 0; to < memory.size(); to += kPage, at++) {
    const std::uint32_t number = copy[at];
    if (number == kNone) continue;
    std::memcpy(memory.data() + to, number == kZeros ? kZeroPage : page(number), std::min(kPage, memory.size() - to));
  }
  return at;
}

void PageStore::release(PageList& copy) {
  for (const std::uint32_t number : copy) {
    if (number < kFirst || --reference_counts_[number - kFirst] > 0) continue;
    free_pages_.push_back(number);
    used_--;
  }
  copy.clear();
}

void PageStore::clear() {
  slabs_.clear();
  reference_counts_.clear();
  free_pages_.clear();
  used_ = 0;
}

}  // namespace limber

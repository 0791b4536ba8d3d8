// Pages: compared, shared, copied.
#include "base/page_store.h"

#include <algorithm>
#include <cstring>

namespace limber {

namespace {
constexpr std::byte kZeroPage[PageStore::kPage] = {};
}

std::uint32_t PageStore::take() {
  if (spare_.empty()) {
    const auto first = static_cast<std::uint32_t>(slabs_.size()) * kSlab + kFirst;
    slabs_.push_back(std::make_unique_for_overwrite<std::byte[]>(kSlab * kPage));
    shares_.resize(slabs_.size() * kSlab);
    spare_.reserve(shares_.size());
    for (std::uint32_t i = kSlab; i-- > 0;) spare_.push_back(first + i);
  }
  const std::uint32_t number = spare_.back();
  spare_.pop_back();
  shares_[number - kFirst] = 1;
  used_++;
  return number;
}

void PageStore::append(Image& out, std::span<const std::byte> memory, const Image* before) {
  for (std::size_t at = 0; at < memory.size(); at += kPage) {
    const std::byte* const from = memory.data() + at;
    const std::size_t size = std::min(kPage, memory.size() - at);
    const std::size_t place = out.size();
    const std::uint32_t known = before != nullptr && place < before->size() ? (*before)[place] : kNone;
    if (known >= kFirst && std::memcmp(page(known), from, size) == 0) {
      shares_[known - kFirst]++;
      out.push_back(known);
    } else if (from[0] == std::byte{0} && std::memcmp(kZeroPage, from, size) == 0) {
      out.push_back(kZeros);
    } else {
      const std::uint32_t fresh = take();
      std::memcpy(page(fresh), from, size);
      out.push_back(fresh);
    }
  }
}

void PageStore::append_none(Image& out, std::size_t bytes) const {
  out.insert(out.end(), (bytes + kPage - 1) / kPage, kNone);
}

std::size_t PageStore::copy_back(const Image& image, std::size_t at, std::span<std::byte> memory) const {
  for (std::size_t to = 0; to < memory.size(); to += kPage, at++) {
    const std::uint32_t number = image[at];
    if (number == kNone) continue;
    std::memcpy(memory.data() + to, number == kZeros ? kZeroPage : page(number), std::min(kPage, memory.size() - to));
  }
  return at;
}

void PageStore::release(Image& image) {
  for (const std::uint32_t number : image) {
    if (number < kFirst || --shares_[number - kFirst] > 0) continue;
    spare_.push_back(number);
    used_--;
  }
  image.clear();
}

void PageStore::clear() {
  slabs_.clear();
  shares_.clear();
  spare_.clear();
  used_ = 0;
}

}  // namespace limber

// PageStore: contents, sharing, and memory use of copies.
#include "base/memory/page_store.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"

namespace limber {
namespace {

constexpr std::size_t kPage = PageStore::kPage;

std::vector<std::byte> noise(std::size_t size, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::byte> memory(size);
  for (std::byte& b : memory) b = static_cast<std::byte>(random.next());
  return memory;
}

TEST(PageStore, RestoresExactly) {
  PageStore pages;
  for (const std::size_t size : {std::size_t{1}, kPage - 1, kPage, kPage + 1, 10 * kPage + 17}) {
    const std::vector<std::byte> memory = noise(size, size);
    PageStore::PageList image;
    pages.append(image, memory, nullptr);
    std::vector<std::byte> back(size);
    EXPECT_EQ(pages.restore(image, 0, back), (size + kPage - 1) / kPage);
    EXPECT_EQ(back, memory);
    pages.release(image);
  }
  EXPECT_EQ(pages.bytes(), 0u);
}

TEST(PageStore, SharesEqualPages) {
  PageStore pages;
  std::vector<std::byte> memory = noise(100 * kPage, 3);
  PageStore::PageList first, second;
  pages.append(first, memory, nullptr);
  EXPECT_EQ(pages.bytes(), 100 * kPage);
  memory[50 * kPage] ^= std::byte{1};
  memory[71 * kPage - 1] ^= std::byte{1};
  pages.append(second, memory, &first);
  EXPECT_EQ(pages.bytes(), 102 * kPage);
  // The copies can be released in any order.
  pages.release(first);
  EXPECT_EQ(pages.bytes(), 100 * kPage);
  std::vector<std::byte> back(memory.size());
  pages.restore(second, 0, back);
  EXPECT_EQ(back, memory);
}

TEST(PageStore, ZeroPagesNeedNoMemory) {
  PageStore pages;
  const std::vector<std::byte> zeros(20 * kPage);
  PageStore::PageList image;
  pages.append(image, zeros, nullptr);
  EXPECT_EQ(pages.bytes(), 0u);
  std::vector<std::byte> back = noise(20 * kPage, 4);
  pages.restore(image, 0, back);
  EXPECT_EQ(back, zeros);
}

TEST(PageStore, LeavesPlaceholdersUnchanged) {
  PageStore pages;
  const std::vector<std::byte> memory = noise(3 * kPage, 5);
  PageStore::PageList image;
  pages.append_placeholders(image, 2 * kPage);
  pages.append(image, std::span(memory).last(kPage), nullptr);
  std::vector<std::byte> back = noise(3 * kPage, 6);
  std::vector<std::byte> expected = back;
  std::copy(memory.end() - kPage, memory.end(), expected.end() - kPage);
  pages.restore(image, 0, back);
  EXPECT_EQ(back, expected);
}

}  // namespace
}  // namespace limber

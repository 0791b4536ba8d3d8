// The arena as an allocator, against a plain model of what was asked for; and its images, against copies.
#include "base/arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <vector>

#include "base/random.h"
#include "base/sanitized.h"

#ifdef LIMBER_WATCHES_ADDRESSES
#include <sanitizer/lsan_interface.h>
#endif

namespace limber {
namespace {

struct LivingBlock {
  std::size_t size = 0;
  unsigned char fill = 0;
};
using LivingBlocks = std::map<unsigned char*, LivingBlock>;

void expect_whole(const LivingBlocks& blocks) {
  unsigned char* end = nullptr;
  for (const auto& [at, block] : blocks) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(at) % 16, 0u);
    EXPECT_GE(at, end) << "two blocks overlap";
    end = at + block.size;
    for (std::size_t i = 0; i < block.size; i++) ASSERT_EQ(at[i], block.fill);
  }
}

// blocks of all sizes come, go and change theirs
void live_on(Arena& arena, LivingBlocks& blocks, Random& random, int steps) {
  const auto some = [&](double n) { return static_cast<std::size_t>(random.uniform() * n); };
  for (int i = 0; i < steps; i++) {
    const std::size_t size = 1 + some(some(4) == 0 ? (some(8) == 0 ? 300000 : 60000) : some(3) == 0 ? 5000 : 300);
    const auto fill = static_cast<unsigned char>(some(256));
    if (blocks.empty() || some(5) < 2) {
      auto* const got = static_cast<unsigned char*>(arena.allocate(size));
      ASSERT_NE(got, nullptr);
      std::memset(got, fill, size);
      blocks[got] = {size, fill};
      continue;
    }
    const auto at = std::next(blocks.begin(), static_cast<std::ptrdiff_t>(some(static_cast<double>(blocks.size()))));
    const auto [block, was] = *at;
    blocks.erase(at);
    if (some(2) == 0) {
      arena.free(block);
      continue;
    }
    auto* const got = static_cast<unsigned char*>(arena.resize(block, was.size, size));
    ASSERT_NE(got, nullptr);
    for (std::size_t k = 0; k < std::min(size, was.size); k++) ASSERT_EQ(got[k], was.fill);
    std::memset(got, fill, size);
    blocks[got] = {size, fill};
  }
}

TEST(Arena, KeepsBlocksApartAndWhole) {
  Arena arena;
  ASSERT_TRUE(arena.exists());
  LivingBlocks blocks;
  Random random(1, "arena");
  for (int round = 0; round < 5; round++) {
    live_on(arena, blocks, random, 500);
    expect_whole(blocks);
  }
}

// sizes that come one after another use the same memory
TEST(Arena, WhatIsEmptyIsUsedForOtherSizes) {
  Arena arena;
  unsigned char* least = nullptr;
  unsigned char* most = nullptr;
  for (std::size_t size = 16; size <= 4096; size += 48) {
    std::vector<void*> blocks;
    for (std::size_t taken = 0; taken < std::size_t{1} << 20; taken += size) blocks.push_back(arena.allocate(size));
    for (void* block : blocks) {
      auto* const at = static_cast<unsigned char*>(block);
      least = least == nullptr ? at : std::min(least, at);
      most = std::max(most, at);
      arena.free(block);
    }
  }
  EXPECT_LT(most - least, std::ptrdiff_t{3} << 20) << "86 sizes of 1 MiB each, one after the other";
}

TEST(Arena, EndsWithoutMore) {
  Arena arena;
  EXPECT_EQ(arena.allocate(Arena::kReserve + 1), nullptr);
  EXPECT_EQ(arena.allocate(Arena::kReserve), nullptr);
  void* const some = arena.allocate(Arena::kReserve / 2);
  EXPECT_NE(some, nullptr);
  EXPECT_EQ(arena.allocate(Arena::kReserve / 2), nullptr);
  arena.free(some);
  EXPECT_NE(arena.allocate(Arena::kReserve / 2), nullptr);
}

// the system's memory, with pages of another size: what begins in the middle of one is rejected, as the system does
class OtherPages : public AddressSpace {
 public:
  explicit OtherPages(std::size_t page) : page_(page) {}
  std::size_t page() const override { return page_; }
  bool open(std::byte* begin, std::size_t size) override {
    opened++;
    if (reinterpret_cast<std::uintptr_t>(begin) % page_ != 0) return false;
    // all of the last page
    return AddressSpace::open(begin, (size + page_ - 1) / page_ * page_);
  }
  void release(std::byte* begin, std::size_t size) override { AddressSpace::release(begin - offset_, size + page_); }
  int opened = 0;

 protected:
  std::byte* map(std::uintptr_t wish, std::size_t size) override {
    std::byte* const got = AddressSpace::map(wish, size + page_);
    offset_ = static_cast<std::size_t>(next_page(got, page_) - got);
    return got + offset_;
  }

 private:
  std::size_t page_;
  std::size_t offset_ = 0;
};

class PageSizes : public testing::TestWithParam<std::size_t> {};

TEST_P(PageSizes, ArenasWorkAndBringBackTheirImages) {
  OtherPages space(GetParam());
  Arena arena(space);
  ASSERT_TRUE(arena.exists());
  LivingBlocks blocks;
  Random random(3, "arena");
  live_on(arena, blocks, random, 1000);
  PageStore pages;
  PageStore::Image image;
  arena.copy(pages, nullptr, image);
  LivingBlocks later = blocks;
  live_on(arena, later, random, 1000);
  expect_whole(later);
  arena.bring_back(pages, image);
  expect_whole(blocks);
  // to the end of the arena, in steps that open more of it
  while (void* const block = arena.allocate(std::size_t{50} << 20)) std::memset(block, 1, 1);
  EXPECT_GT(space.opened, 30);
}

INSTANTIATE_TEST_SUITE_P(KiB, PageSizes, testing::Values(4096, 16384, 65536),
                         [](const auto& info) { return std::to_string(info.param / 1024); });

#ifdef LIMBER_WATCHES_ADDRESSES
// where nothing else knows of it, neither a register nor what is left on the stack
[[gnu::noinline]] void keep_something(int** at) { *at = new int[1000]; }
[[gnu::noinline]] int overwritten_stack() {
  volatile int numbers[4096] = {};
  return numbers[100];
}

TEST(Arena, WhatItsBlocksPointToIsNoLeak) {
  Arena arena;
  auto* const kept = static_cast<int**>(arena.allocate(sizeof(int*)));
  keep_something(kept);
  EXPECT_EQ(overwritten_stack(), 0);
  EXPECT_EQ(__lsan_do_recoverable_leak_check(), 0);
  delete[] * kept;
}
#endif

// what lives on after an image was taken does not matter: the image brings back all blocks, and all that comes after
// lies where it lay
TEST(Arena, ImagesBringBackAllAndTheFutureToo) {
  Arena arena;
  PageStore pages;
  Random random(2, "arena");
  LivingBlocks now;
  live_on(arena, now, random, 2000);
  PageStore::Image image;
  arena.copy(pages, nullptr, image);
  const LivingBlocks then = now;
  const Random random_then = random;
  live_on(arena, now, random, 1500);
  const LivingBlocks later = now;
  for (int round = 0; round < 3; round++) {
    live_on(arena, now, random, 700 * round);
    arena.bring_back(pages, image);
    expect_whole(then);
    now = then;
    random = random_then;
    live_on(arena, now, random, 1500);
    expect_whole(now);
    ASSERT_EQ(now.size(), later.size());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    EXPECT_TRUE(std::equal(now.begin(), now.end(), later.begin(), same));
  }
}

}  // namespace
}  // namespace limber

// The arena as an allocator, compared with a simple model of its blocks; and its captures, compared with copies.
#include "base/memory/arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <vector>

#include "base/random.h"
#include "base/sanitized.h"
#include "support/skip.h"

#ifdef LIMBER_ADDRESS_SANITIZER
#include <sanitizer/lsan_interface.h>
#endif

namespace limber {
namespace {

struct TestBlock {
  std::size_t size = 0;
  unsigned char fill = 0;
};
using TestBlocks = std::map<unsigned char*, TestBlock>;

void expect_intact(const TestBlocks& blocks) {
  unsigned char* end = nullptr;
  for (const auto& [at, block] : blocks) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(at) % 16, 0u);
    EXPECT_GE(at, end) << "two blocks overlap";
    end = at + block.size;
    for (std::size_t i = 0; i < block.size; i++) ASSERT_EQ(at[i], block.fill);
  }
}

// Allocates, frees and resizes blocks of all sizes.
void run_random_operations(Arena& arena, TestBlocks& blocks, Random& random, int steps) {
  const auto random_below = [&](double n) { return static_cast<std::size_t>(random.uniform() * n); };
  for (int i = 0; i < steps; i++) {
    const std::size_t size = 1 + random_below(random_below(4) == 0   ? (random_below(8) == 0 ? 300000 : 60000)
                                              : random_below(3) == 0 ? 5000
                                                                     : 300);
    const auto fill = static_cast<unsigned char>(random_below(256));
    if (blocks.empty() || random_below(5) < 2) {
      auto* const allocated = static_cast<unsigned char*>(arena.allocate(size));
      ASSERT_NE(allocated, nullptr);
      std::memset(allocated, fill, size);
      blocks[allocated] = {size, fill};
      continue;
    }
    const auto at =
        std::next(blocks.begin(), static_cast<std::ptrdiff_t>(random_below(static_cast<double>(blocks.size()))));
    const auto [block, previous] = *at;
    blocks.erase(at);
    if (random_below(2) == 0) {
      arena.free(block);
      continue;
    }
    auto* const allocated = static_cast<unsigned char*>(arena.resize(block, previous.size, size));
    ASSERT_NE(allocated, nullptr);
    for (std::size_t k = 0; k < std::min(size, previous.size); k++) ASSERT_EQ(allocated[k], previous.fill);
    std::memset(allocated, fill, size);
    blocks[allocated] = {size, fill};
  }
}

TEST(Arena, BlocksDoNotOverlap) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  Arena arena;
  ASSERT_TRUE(arena.exists());
  TestBlocks blocks;
  Random random(1, "arena");
  for (int round = 0; round < 5; round++) {
    run_random_operations(arena, blocks, random, 500);
    expect_intact(blocks);
  }
}

// Different sizes, used one after the other, reuse the same memory.
TEST(Arena, EmptyChunksAreReusedForOtherSizes) {
  Arena arena;
  unsigned char* lowest = nullptr;
  unsigned char* highest = nullptr;
  for (std::size_t size = 16; size <= 4096; size += 48) {
    std::vector<void*> blocks;
    for (std::size_t allocated = 0; allocated < std::size_t{1} << 20; allocated += size)
      blocks.push_back(arena.allocate(size));
    for (void* block : blocks) {
      auto* const at = static_cast<unsigned char*>(block);
      lowest = lowest == nullptr ? at : std::min(lowest, at);
      highest = std::max(highest, at);
      arena.free(block);
    }
  }
  EXPECT_LT(highest - lowest, std::ptrdiff_t{3} << 20) << "86 sizes of 1 MiB each";
}

TEST(Arena, ReturnsNullWhenFull) {
  Arena arena;
  EXPECT_EQ(arena.allocate(Arena::kReserve + 1), nullptr);
  EXPECT_EQ(arena.allocate(Arena::kReserve), nullptr);
  void* const some = arena.allocate(Arena::kReserve / 2);
  EXPECT_NE(some, nullptr);
  EXPECT_EQ(arena.allocate(Arena::kReserve / 2), nullptr);
  arena.free(some);
  EXPECT_NE(arena.allocate(Arena::kReserve / 2), nullptr);
}

// Simulates another page size: rejects calls that are not page-aligned, as the system does.
class OtherPages : public AddressSpace {
 public:
  explicit OtherPages(std::size_t page) : page_(page) {}
  std::size_t page_size() const override { return page_; }
  bool commit(std::byte* begin, std::size_t size) override {
    commits++;
    if (reinterpret_cast<std::uintptr_t>(begin) % page_ != 0) return false;
    // the end of the last page
    return AddressSpace::commit(begin, (size + page_ - 1) / page_ * page_);
  }
  void release(std::byte* begin, std::size_t size) override { AddressSpace::release(begin - offset_, size + page_); }
  int commits = 0;

 protected:
  std::byte* map(std::uintptr_t hint, std::size_t size) override {
    std::byte* const mapped = AddressSpace::map(hint, size + page_);
    offset_ = static_cast<std::size_t>(align_up(mapped, page_) - mapped);
    return mapped + offset_;
  }

 private:
  std::size_t page_;
  std::size_t offset_ = 0;
};

class PageSizes : public testing::TestWithParam<std::size_t> {};

TEST_P(PageSizes, AllocateCaptureAndRestore) {
  OtherPages space(GetParam());
  Arena arena(space);
  ASSERT_TRUE(arena.exists());
  TestBlocks blocks;
  Random random(3, "arena");
  run_random_operations(arena, blocks, random, 1000);
  PageStore pages;
  PageStore::PageList image;
  arena.capture(pages, nullptr, image);
  TestBlocks later = blocks;
  run_random_operations(arena, later, random, 1000);
  expect_intact(later);
  arena.restore(pages, image);
  expect_intact(blocks);
  // Fills the arena in steps that commit more of it.
  while (void* const block = arena.allocate(std::size_t{50} << 20)) std::memset(block, 1, 1);
  EXPECT_GT(space.commits, 30);
}

INSTANTIATE_TEST_SUITE_P(KiB, PageSizes, testing::Values(4096, 16384, 65536),
                         [](const auto& info) { return std::to_string(info.param / 1024); });

#ifdef LIMBER_ADDRESS_SANITIZER
// No register and no leftover on the stack has a copy of the pointer.
[[gnu::noinline]] void store_new_array(int** at) { *at = new int[1000]; }
[[gnu::noinline]] int overwritten_stack() {
  volatile int numbers[4096] = {};
  return numbers[100];
}

TEST(Arena, PointersInBlocksPreventLeakReports) {
  Arena arena;
  auto* const pointer = static_cast<int**>(arena.allocate(sizeof(int*)));
  store_new_array(pointer);
  EXPECT_EQ(overwritten_stack(), 0);
  EXPECT_EQ(__lsan_do_recoverable_leak_check(), 0);
  delete[] * pointer;
}
#endif

// After a restore, all blocks are those of the capture, and later allocations get the same addresses as before.
TEST(Arena, RestoreReproducesBlocksAndLaterAllocations) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  Arena arena;
  PageStore pages;
  Random random(2, "arena");
  TestBlocks now;
  run_random_operations(arena, now, random, 2000);
  PageStore::PageList image;
  arena.capture(pages, nullptr, image);
  const TestBlocks then = now;
  const Random random_then = random;
  run_random_operations(arena, now, random, 1500);
  const TestBlocks later = now;
  for (int round = 0; round < 3; round++) {
    run_random_operations(arena, now, random, 700 * round);
    arena.restore(pages, image);
    expect_intact(then);
    now = then;
    random = random_then;
    run_random_operations(arena, now, random, 1500);
    expect_intact(now);
    ASSERT_EQ(now.size(), later.size());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    EXPECT_TRUE(std::equal(now.begin(), now.end(), later.begin(), same));
  }
}

}  // namespace
}  // namespace limber

// AddressSpace: addresses of reserved ranges, also on a system that prefers addresses beyond LuaJIT's 47 bits.
#include "base/memory/address_space.h"

#include <gtest/gtest.h>

#include <vector>

namespace limber {
namespace {

std::uintptr_t number_of(const std::byte* place) { return reinterpret_cast<std::uintptr_t>(place); }

TEST(AddressSpace, ReservedRangesAreUsable) {
  AddressSpace& system = AddressSpace::of_system();
  const std::size_t page = system.page_size();
  EXPECT_TRUE(page == 4096 || page == 16384 || page == 65536) << page;
  std::byte* const begin = system.reserve(1 << 20);
  ASSERT_NE(begin, nullptr);
  EXPECT_EQ(number_of(begin) % page, 0u);
  EXPECT_LE(number_of(begin) + (1 << 20), AddressSpace::kEnd);
  ASSERT_TRUE(system.commit(begin + page, page));
  begin[page] = std::byte{1};
  begin[2 * page - 1] = std::byte{2};
  EXPECT_FALSE(system.commit(begin + page / 2, page)) << "not page-aligned";
  system.release(begin, 1 << 20);
}

// Simulates a system with 48-bit addresses: allocates from the top, or at the hint if it is free. Has no memory.
class HighAddresses : public AddressSpace {
 public:
  std::uintptr_t lowest_used = kEnd;  // all addresses from here on are taken
  std::vector<std::uintptr_t> mapped;

  void release(std::byte* begin, std::size_t) override { std::erase(mapped, number_of(begin)); }

 protected:
  std::byte* map(std::uintptr_t hint, std::size_t size) override {
    const bool is_free = hint != 0 && hint + size <= lowest_used;
    const std::uintptr_t at = is_free ? hint : (kEnd << 1) - (mapped.size() + 1) * size;
    mapped.push_back(at);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): never dereferenced
    return reinterpret_cast<std::byte*>(at);
  }
};

TEST(AddressSpace, RequestsLowAddresses) {
  constexpr std::size_t kSize = std::size_t{2} << 30;
  for (const std::uintptr_t lowest_used : {AddressSpace::kEnd, AddressSpace::kEnd / 2, std::uintptr_t{3} << 40}) {
    HighAddresses space;
    space.lowest_used = lowest_used;
    std::byte* const begin = space.reserve(kSize);
    ASSERT_NE(begin, nullptr);
    EXPECT_LE(number_of(begin) + kSize, lowest_used);
    EXPECT_EQ(space.mapped, std::vector<std::uintptr_t>{number_of(begin)}) << "ranges that are too high are released";
  }
}

TEST(AddressSpace, FailsWithoutLowAddresses) {
  HighAddresses space;
  space.lowest_used = 0;
  EXPECT_EQ(space.reserve(std::size_t{2} << 30), nullptr);
  EXPECT_TRUE(space.mapped.empty());
}

TEST(AddressSpace, AlignsToPages) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): never dereferenced
  auto* const base = reinterpret_cast<std::byte*>(std::uintptr_t{65536} * 4096);
  EXPECT_EQ(align_up(base + 0, 65536), base);
  EXPECT_EQ(align_up(base + 1, 65536), base + 65536);
  EXPECT_EQ(align_up(base + 65535, 65536), base + 65536);
  EXPECT_EQ(align_up(base + 65536, 65536), base + 65536);
}

}  // namespace
}  // namespace limber

// AddressSpace: where stretches of addresses begin, also on a system that prefers addresses beyond LuaJIT's 47 bits.
#include "base/address_space.h"

#include <gtest/gtest.h>

#include <vector>

namespace limber {
namespace {

std::uintptr_t number_of(const std::byte* place) { return reinterpret_cast<std::uintptr_t>(place); }

TEST(AddressSpace, TheSystemsStretchesAreUsable) {
  AddressSpace& system = AddressSpace::of_system();
  const std::size_t page = system.page();
  EXPECT_TRUE(page == 4096 || page == 16384 || page == 65536) << page;
  std::byte* const begin = system.reserve(1 << 20);
  ASSERT_NE(begin, nullptr);
  EXPECT_EQ(number_of(begin) % page, 0u);
  EXPECT_LE(number_of(begin) + (1 << 20), AddressSpace::kEnd);
  ASSERT_TRUE(system.open(begin + page, page));
  begin[page] = std::byte{1};
  begin[2 * page - 1] = std::byte{2};
  EXPECT_FALSE(system.open(begin + page / 2, page)) << "in the middle of a page";
  system.release(begin, 1 << 20);
}

// addresses alone, as a system with 48 bits of them gives them: from the top, unless the wish is free
class HighAddresses : public AddressSpace {
 public:
  std::uintptr_t lowest_taken = kEnd;  // all from here on is taken
  std::vector<std::uintptr_t> mapped;

  void release(std::byte* begin, std::size_t) override { std::erase(mapped, number_of(begin)); }

 protected:
  std::byte* map(std::uintptr_t wish, std::size_t size) override {
    const bool is_free = wish != 0 && wish + size <= lowest_taken;
    const std::uintptr_t at = is_free ? wish : (kEnd << 1) - (mapped.size() + 1) * size;
    mapped.push_back(at);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): never dereferenced
    return reinterpret_cast<std::byte*>(at);
  }
};

TEST(AddressSpace, AsksForLowerAddressesWhereTheSystemPrefersHigherOnes) {
  constexpr std::size_t kSize = std::size_t{2} << 30;
  for (const std::uintptr_t taken : {AddressSpace::kEnd, AddressSpace::kEnd / 2, std::uintptr_t{3} << 40}) {
    HighAddresses space;
    space.lowest_taken = taken;
    std::byte* const got = space.reserve(kSize);
    ASSERT_NE(got, nullptr);
    EXPECT_LE(number_of(got) + kSize, taken);
    EXPECT_EQ(space.mapped, std::vector<std::uintptr_t>{number_of(got)}) << "what is too high is given back";
  }
}

TEST(AddressSpace, ReportsThatThereAreNoLowerAddresses) {
  HighAddresses space;
  space.lowest_taken = 0;
  EXPECT_EQ(space.reserve(std::size_t{2} << 30), nullptr);
  EXPECT_TRUE(space.mapped.empty());
}

TEST(AddressSpace, TheNextPage) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): never dereferenced
  auto* const base = reinterpret_cast<std::byte*>(std::uintptr_t{65536} * 4096);
  EXPECT_EQ(next_page(base + 0, 65536), base);
  EXPECT_EQ(next_page(base + 1, 65536), base + 65536);
  EXPECT_EQ(next_page(base + 65535, 65536), base + 65536);
  EXPECT_EQ(next_page(base + 65536, 65536), base + 65536);
}

}  // namespace
}  // namespace limber

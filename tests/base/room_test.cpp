// Growth of reserved capacity.
#include "base/capacity.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Reserve, SlowGrowthDoesNotAllocateEachTime) {
  std::vector<double> numbers;
  int moves = 0;
  for (std::size_t count = 1; count <= 1000; ++count) {
    const std::size_t before = numbers.capacity();
    reserve(numbers, count);
    EXPECT_GE(numbers.capacity(), count);
    moves += numbers.capacity() != before ? 1 : 0;
  }
  EXPECT_LE(moves, 11);
  clear_and_reserve(numbers, 5000);
  EXPECT_GE(numbers.capacity(), 5000u);
  EXPECT_TRUE(numbers.empty());
}

}  // namespace
}  // namespace limber

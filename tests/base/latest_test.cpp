// Latest: readers see complete values, and memory is reused. Intended for the thread sanitizer too.
#include "base/threads/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <set>
#include <thread>

namespace limber {
namespace {

// All numbers of a published value are equal.
using Block = std::array<int, 64>;

TEST(Latest, IsNullBeforeTheFirstAndTheNewestAfter) {
  Latest<Block> latest;
  EXPECT_EQ(latest.read(), nullptr);
  for (int i = 0; i < 3; i++) {
    const auto block = latest.acquire_buffer();
    block->fill(i);
    latest.publish(block);
    EXPECT_EQ((*latest.read())[63], i);
  }
}

TEST(Latest, ValuesOfReadersAreNotReused) {
  Latest<Block> latest;
  auto block = latest.acquire_buffer();
  block->fill(1);
  latest.publish(std::move(block));
  const auto value = latest.read();
  for (int i = 2; i < 10; i++) {
    auto next = latest.acquire_buffer();
    EXPECT_NE(next.get(), value.get());
    EXPECT_NE(next.get(), latest.read().get());
    next->fill(i);
    latest.publish(std::move(next));
  }
  EXPECT_EQ((*value)[0], 1);
}

TEST(Latest, AllocatesTwoValuesMoreThanReadersKeep) {
  Latest<Block> latest;
  std::set<const Block*> seen;
  for (int i = 0; i < 100; i++) {
    auto block = latest.acquire_buffer();
    seen.insert(block.get());
    latest.publish(std::move(block));
  }
  EXPECT_EQ(seen.size(), 2u);
}

TEST(Latest, ConcurrentReadersSeeWholeValuesInOrder) {
  constexpr int kValues = 20000;
  Latest<Block> latest;
  std::atomic<bool> ended{false};
  std::atomic<int> torn{0};
  std::atomic<int> backwards{0};
  std::vector<std::thread> readers;
  for (int r = 0; r < 3; r++) {
    readers.emplace_back([&, r] {
      int last = 0;
      std::shared_ptr<const Block> retained;
      while (!ended.load()) {
        const std::shared_ptr<const Block> block = latest.read();
        if (block == nullptr) continue;
        for (const int v : *block) torn += v == block->front() ? 0 : 1;
        backwards += block->front() < last ? 1 : 0;
        last = block->front();
        if (r == 0) retained = block;  // one reader keeps its value
      }
      if (retained != nullptr) torn += retained->front() == retained->back() ? 0 : 1;
    });
  }
  for (int i = 1; i <= kValues; i++) {
    auto block = latest.acquire_buffer();
    block->fill(i);
    latest.publish(std::move(block));
  }
  ended = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn.load(), 0);
  EXPECT_EQ(backwards.load(), 0);
  EXPECT_EQ((*latest.read())[0], kValues);
}

}  // namespace
}  // namespace limber

// BoundedQueue: many writers, one reader, limits, counted drops. Intended for the thread sanitizer too.
#include "base/threads/bounded_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace limber {
namespace {

struct SizedItem {
  std::size_t bytes = 0;
};
std::size_t weight_of(const SizedItem& parcel) { return parcel.bytes; }

TEST(BoundedQueue, KeepsTheOrderAndCountsDrops) {
  BoundedQueue<int> queue(3);
  for (int i = 0; i < 5; i++) EXPECT_EQ(queue.push(i), i < 3);
  EXPECT_EQ(queue.dropped(), 2u);
  std::vector<int> out = {9};
  queue.drain(out);
  EXPECT_EQ(out, (std::vector<int>{0, 1, 2}));
  queue.drain(out);
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(queue.push(7));
  queue.drain(out);
  EXPECT_EQ(out, (std::vector<int>{7}));
  EXPECT_EQ(queue.dropped(), 2u);
}

TEST(BoundedQueue, LimitsBytes) {
  BoundedQueue<SizedItem> queue(100, 1000);
  EXPECT_TRUE(queue.push({600}));
  EXPECT_FALSE(queue.push({401}));
  EXPECT_TRUE(queue.push({400}));
  EXPECT_FALSE(queue.push({1}));
  EXPECT_EQ(queue.dropped(), 2u);
  std::vector<SizedItem> out;
  queue.drain(out);
  EXPECT_EQ(out.size(), 2u);
  EXPECT_TRUE(queue.push({1000})) << "drained items no longer count";
  EXPECT_FALSE(queue.push({SIZE_MAX}));
  // Without weight_of(), the size of an item is that of its type.
  BoundedQueue<int> numbers(100, 3 * sizeof(int));
  for (int i = 0; i < 5; i++) EXPECT_EQ(numbers.push(i), i < 3);
}

TEST(BoundedQueue, ReusesTheReadersMemory) {
  BoundedQueue<int> queue(100);
  std::vector<int> out;
  for (int round = 0; round < 4; round++) {
    for (int i = 0; i < 100; i++) queue.push(i);
    queue.drain(out);
  }
  const int* memory[2] = {nullptr, nullptr};
  for (int round = 0; round < 6; round++) {
    for (int i = 0; i < 100; i++) queue.push(i);
    queue.drain(out);
    if (round < 2) memory[round] = out.data();
    EXPECT_EQ(out.data(), memory[round % 2]);
  }
}

TEST(BoundedQueue, FourWritersLoseNoAcceptedItem) {
  constexpr int kEach = 20000;
  BoundedQueue<int> queue(500);
  std::atomic<int> running{4};
  std::vector<std::thread> writers;
  std::atomic<std::uint64_t> accepted{0};
  for (int w = 0; w < 4; w++) {
    writers.emplace_back([&, w] {
      for (int i = 0; i < kEach; i++) {
        if (queue.push(w * kEach + i)) accepted.fetch_add(1);
      }
      running.fetch_sub(1);
    });
  }
  std::vector<int> out;
  int last[4] = {-1, -1, -1, -1};
  std::uint64_t read = 0;
  bool ended = false;
  while (!ended) {
    ended = running.load() == 0;
    queue.drain(out);
    ASSERT_LE(out.size(), 500u);
    read += out.size();
    for (const int item : out) {
      ASSERT_GT(item % kEach, last[item / kEach]);  // the items of each writer are in order
      last[item / kEach] = item % kEach;
    }
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(read, accepted.load());
  EXPECT_EQ(read + queue.dropped(), 4u * kEach);
}

}  // namespace
}  // namespace limber

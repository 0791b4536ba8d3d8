// Inbox: many writers, one reader, bounded; what does not fit is counted. Meant for the thread sanitizer too.
#include "base/inbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace limber {
namespace {

struct Parcel {
  std::size_t bytes = 0;
};
std::size_t weight_of(const Parcel& parcel) { return parcel.bytes; }

TEST(Inbox, KeepsTheOrderAndCountsWhatDoesNotFit) {
  Inbox<int> inbox(3);
  for (int i = 0; i < 5; i++) EXPECT_EQ(inbox.push(i), i < 3);
  EXPECT_EQ(inbox.dropped(), 2u);
  std::vector<int> out = {9};
  inbox.drain(out);
  EXPECT_EQ(out, (std::vector<int>{0, 1, 2}));
  inbox.drain(out);
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(inbox.push(7));
  inbox.drain(out);
  EXPECT_EQ(out, (std::vector<int>{7}));
  EXPECT_EQ(inbox.dropped(), 2u);
}

TEST(Inbox, BytesAreBoundedToo) {
  Inbox<Parcel> inbox(100, 1000);
  EXPECT_TRUE(inbox.push({600}));
  EXPECT_FALSE(inbox.push({401}));
  EXPECT_TRUE(inbox.push({400}));
  EXPECT_FALSE(inbox.push({1}));
  EXPECT_EQ(inbox.dropped(), 2u);
  std::vector<Parcel> out;
  inbox.drain(out);
  EXPECT_EQ(out.size(), 2u);
  EXPECT_TRUE(inbox.push({1000})) << "what was taken out weighs no more";
  EXPECT_FALSE(inbox.push({SIZE_MAX}));
  // without a function of its own an item weighs what its type does
  Inbox<int> numbers(100, 3 * sizeof(int));
  for (int i = 0; i < 5; i++) EXPECT_EQ(numbers.push(i), i < 3);
}

TEST(Inbox, ReusesTheReadersMemory) {
  Inbox<int> inbox(100);
  std::vector<int> out;
  for (int round = 0; round < 4; round++) {
    for (int i = 0; i < 100; i++) inbox.push(i);
    inbox.drain(out);
  }
  const int* memory[2] = {nullptr, nullptr};
  for (int round = 0; round < 6; round++) {
    for (int i = 0; i < 100; i++) inbox.push(i);
    inbox.drain(out);
    if (round < 2) memory[round] = out.data();
    EXPECT_EQ(out.data(), memory[round % 2]);
  }
}

TEST(Inbox, FourWritersLoseNothingThatWasTaken) {
  constexpr int kEach = 20000;
  Inbox<int> inbox(500);
  std::atomic<int> running{4};
  std::vector<std::thread> writers;
  std::atomic<std::uint64_t> taken{0};
  for (int w = 0; w < 4; w++) {
    writers.emplace_back([&, w] {
      for (int i = 0; i < kEach; i++) {
        if (inbox.push(w * kEach + i)) taken.fetch_add(1);
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
    inbox.drain(out);
    ASSERT_LE(out.size(), 500u);
    read += out.size();
    for (const int item : out) {
      ASSERT_GT(item % kEach, last[item / kEach]);  // each writer's items in its order
      last[item / kEach] = item % kEach;
    }
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(read, taken.load());
  EXPECT_EQ(read + inbox.dropped(), 4u * kEach);
}

}  // namespace
}  // namespace limber

// ThreadPool: each task runs once, in every round. Intended for the thread sanitizer too.
#include "base/threads/thread_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cfenv>
#include <thread>
#include <vector>

#include "base/math/fixed_math.h"

namespace limber {
namespace {

TEST(ThreadPool, RunsEachTaskOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.thread_count(), threads);
    // Not atomic: writes of the workers must be visible when run() returns.
    std::vector<int> done(100), last_thread(100, -1);
    for (int round = 1; round <= 2000; round++) {
      const int tasks = round % 101;
      pool.run(tasks, [&](int task, int thread) {
        done[static_cast<std::size_t>(task)]++;
        last_thread[static_cast<std::size_t>(task)] = thread;
      });
    }
    for (int task = 0; task < 100; task++) {
      int rounds = 0;
      for (int round = 1; round <= 2000; round++) rounds += round % 101 > task ? 1 : 0;
      EXPECT_EQ(done[static_cast<std::size_t>(task)], rounds) << threads << " " << task;
      EXPECT_GE(last_thread[static_cast<std::size_t>(task)], 0);
      EXPECT_LT(last_thread[static_cast<std::size_t>(task)], threads);
    }
  }
}

TEST(ThreadPool, ThreadNumberSelectsSeparateData) {
  ThreadPool pool(4);
  std::vector<long> sum(4);
  for (int round = 0; round < 500; round++) {
    pool.run(50, [&](int task, int thread) { sum[static_cast<std::size_t>(thread)] += task; });
  }
  EXPECT_EQ(sum[0] + sum[1] + sum[2] + sum[3], 500L * 50 * 49 / 2);
}

TEST(ThreadPool, StopsWithoutWork) {
  for (int i = 0; i < 50; i++) ThreadPool(8).run(0, [](int, int) { ADD_FAILURE(); });
}

TEST(ThreadPool, WakeWithoutRunIsHarmless) {
  ThreadPool pool(3);
  int sum = 0;
  for (int round = 0; round < 500; round++) {
    pool.wake();
    std::atomic<int> done{0};
    if (round % 3 != 0) pool.run(5, [&](int task, int) { done += task; });
    sum += done;
  }
  EXPECT_EQ(sum, 333 * (0 + 1 + 2 + 3 + 4));
}

// Every task waits for those of the other threads, so all threads must run at once, each with its own range.
TEST(ThreadPool, ThreadsRunConcurrently) {
  constexpr int kThreads = 3;
  ThreadPool pool(kThreads);
  for (int round = 0; round < 20; round++) {
    std::atomic<int> running{0};
    pool.run(kThreads, [&](int task, int thread) {
      EXPECT_EQ(task, thread);
      running++;
      while (running < kThreads) std::this_thread::yield();
    });
    EXPECT_EQ(running, kThreads);
  }
}

// A library may change the rounding mode of a thread, which threads that it starts inherit.
TEST(ThreadPool, WorkersRoundToNearest) {
  constexpr int kThreads = 3;
  std::fesetround(FE_UPWARD);
  ThreadPool pool(kThreads);
  fixed::reset_arithmetic();
  std::atomic<int> running{0};
  std::array<bool, kThreads> exact{};
  pool.run(kThreads, [&](int task, int) {
    running++;
    while (running < kThreads) std::this_thread::yield();
    exact.at(static_cast<std::size_t>(task)) = fixed::is_arithmetic_exact();
  });
  EXPECT_EQ(exact, (std::array<bool, kThreads>{true, true, true}));
}

}  // namespace
}  // namespace limber

// SimThreadExecutor: work is executed by the simulation thread while the caller waits; callers are released when the
// simulation ends.
#include "engine/sim_thread_executor.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace limber::engine {
namespace {

TEST(SimThreadExecutor, RunsWorkOnTheServingThread) {
  SimThreadExecutor executor;
  executor.open();
  std::atomic<bool> done{false};
  std::thread::id served_by;
  std::thread sim([&] {
    while (!done.load()) executor.serve();
    executor.close();
  });
  EXPECT_TRUE(executor.run_and_wait([&] { served_by = std::this_thread::get_id(); }, [] {}));
  EXPECT_EQ(served_by, sim.get_id());
  EXPECT_FALSE(executor.waiting());
  done = true;
  sim.join();
  EXPECT_FALSE(executor.run_and_wait([] { FAIL() << "no thread is serving"; }, [] {}));
}

TEST(SimThreadExecutor, ServesManyCallersInTurn) {
  SimThreadExecutor executor;
  executor.open();
  std::atomic<int> callers_left{4};
  int count = 0;  // touched by the server alone
  std::vector<std::thread> callers;
  for (int i = 0; i < 4; i++) {
    callers.emplace_back([&] {
      for (int k = 0; k < 250; k++) EXPECT_TRUE(executor.run_and_wait([&] { count++; }, [] {}));
      callers_left--;
    });
  }
  while (callers_left.load() > 0) executor.serve();
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(count, 1000);
}

TEST(SimThreadExecutor, ReleasesWaitingCallersAtTheEnd) {
  SimThreadExecutor executor;
  executor.open();
  std::atomic<bool> called{false};
  bool done = true;
  std::thread caller([&] { done = executor.run_and_wait([] { FAIL() << "never served"; }, [&] { called = true; }); });
  while (!called.load()) std::this_thread::yield();
  executor.close();
  caller.join();
  EXPECT_FALSE(done);
}

}  // namespace
}  // namespace limber::engine

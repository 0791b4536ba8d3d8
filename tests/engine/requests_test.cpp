// Requests: done by the simulation's thread, waited for by the one that asks, let go when the simulation ends.
#include "engine/requests.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace limber {
namespace {

TEST(Requests, WorkIsDoneByWhoServes) {
  Requests requests;
  requests.open();
  std::atomic<bool> over{false};
  std::thread::id served_by;
  std::thread sim([&] {
    while (!over.load()) requests.serve();
    requests.close();
  });
  EXPECT_TRUE(requests.ask([&] { served_by = std::this_thread::get_id(); }, [] {}));
  EXPECT_EQ(served_by, sim.get_id());
  EXPECT_FALSE(requests.waiting());
  over = true;
  sim.join();
  EXPECT_FALSE(requests.ask([] { FAIL() << "nobody is there"; }, [] {}));
}

TEST(Requests, ManyAskersOneAfterTheOther) {
  Requests requests;
  requests.open();
  std::atomic<int> left{4};
  int count = 0;  // touched by the server alone
  std::vector<std::thread> askers;
  for (int i = 0; i < 4; i++) {
    askers.emplace_back([&] {
      for (int k = 0; k < 250; k++) EXPECT_TRUE(requests.ask([&] { count++; }, [] {}));
      left--;
    });
  }
  while (left.load() > 0) requests.serve();
  for (std::thread& asker : askers) asker.join();
  EXPECT_EQ(count, 1000);
}

TEST(Requests, WhoWaitsIsLetGoAtTheEnd) {
  Requests requests;
  requests.open();
  std::atomic<bool> asked{false};
  bool done = true;
  std::thread asker([&] { done = requests.ask([] { FAIL() << "never served"; }, [&] { asked = true; }); });
  while (!asked.load()) std::this_thread::yield();
  requests.close();
  asker.join();
  EXPECT_FALSE(done);
}

}  // namespace
}  // namespace limber

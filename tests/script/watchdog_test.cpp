// The watchdog: stops calls that compute too long, not those that wait, and late signals do no harm.
#include "script/vm/watchdog.h"

#include <gtest/gtest.h>

#include <csignal>
#include <ctime>
#include <thread>

namespace limber::script {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

std::int64_t cpu_now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// computes until `end` is set, at most for a second
template <class F>
bool compute_until(F&& end) {
  const std::int64_t begin = cpu_now();
  while (!end()) {
    if (cpu_now() - begin > 1000 * kMillisecond) return false;
  }
  return true;
}

struct WatchdogTest : testing::Test {
  void SetUp() override {
    watch.owner = this;
    watch.stop = [](Watch& w) {
      volatile int& stops = static_cast<WatchdogTest*>(w.owner)->stops;
      stops = stops + 1;
    };
    dog->add(watch, kMillisecond / 2);
  }
  void TearDown() override { dog->remove(watch); }
  bool stopped() const { return *static_cast<const volatile int*>(&stops) > 0; }
  std::shared_ptr<Watchdog> dog = Watchdog::instance();
  Watch watch;
  int stops = 0;
};

TEST_F(WatchdogTest, StopsCallsThatComputeTooLong) {
  const std::int64_t begin = cpu_now();
  watch.begin(3 * kMillisecond);
  EXPECT_FALSE(watch.stop_requested());
  EXPECT_TRUE(compute_until([&] { return stopped(); }));
  EXPECT_TRUE(watch.stop_requested());
  watch.end();
  EXPECT_FALSE(watch.stop_requested());
  EXPECT_GE(cpu_now() - begin, 3 * kMillisecond);  // never too early
}

TEST_F(WatchdogTest, RepeatsTheStopUntilTheCallReturns) {
  watch.begin(kMillisecond);
  EXPECT_TRUE(compute_until([&] { return *static_cast<volatile int*>(&stops) >= 3; }));
  watch.end();
}

TEST_F(WatchdogTest, EachCallHasItsOwnBudget) {
  // many short calls, each long enough to be noticed, that together exceed the budget of one
  for (int i = 0; i < 60; i++) {
    const std::int64_t begin = cpu_now();
    watch.begin(30 * kMillisecond);
    compute_until([&] { return cpu_now() - begin > 2 * kMillisecond; });
    watch.end();
  }
  EXPECT_EQ(stops, 0);
}

TEST_F(WatchdogTest, WaitingDoesNotCount) {
  // this thread waits while another one computes ten times the budget
  watch.begin(3 * kMillisecond);
  std::thread([] {
    const std::int64_t begin = cpu_now();
    while (cpu_now() - begin < 30 * kMillisecond) continue;
  }).join();
  EXPECT_FALSE(stopped());
  watch.end();
}

// A virtual machine's processor that is taken away continues to count as computing, but receives no signals.
TEST_F(WatchdogTest, ASuspendedProcessorIsNotStopped) {
  sigset_t signal, before;
  sigemptyset(&signal);
  sigaddset(&signal, SIGURG);
  pthread_sigmask(SIG_BLOCK, &signal, &before);
  const std::int64_t begin = cpu_now();
  watch.begin(100 * kMillisecond);
  compute_until([&] { return cpu_now() - begin > 300 * kMillisecond; });
  EXPECT_FALSE(watch.stop_requested());
  pthread_sigmask(SIG_SETMASK, &before, nullptr);  // available again: answers the ping
  EXPECT_FALSE(stopped());
  // stopped if it continues to compute for half of its budget
  const std::int64_t back = cpu_now();
  EXPECT_TRUE(compute_until([&] { return stopped(); }));
  EXPECT_GE(cpu_now() - back, 50 * kMillisecond);
  watch.end();
}

TEST_F(WatchdogTest, FollowsTheThreadOfTheCall) {
  std::thread other([&] {
    watch.begin(2 * kMillisecond);
    EXPECT_TRUE(compute_until([&] { return stopped(); }));
    watch.end();
  });
  other.join();
  // the thread has ended; the watch continues with the next one
  stops = 0;
  watch.begin(2 * kMillisecond);
  EXPECT_TRUE(compute_until([&] { return stopped(); }));
  watch.end();
}

TEST_F(WatchdogTest, TwoWatchesAreIndependent) {
  Watch second;
  second.owner = this;
  second.stop = [](Watch&) { ADD_FAILURE() << "the other one was stopped"; };
  dog->add(second, kMillisecond / 2);
  second.begin(1000 * kMillisecond);
  second.end();
  watch.begin(2 * kMillisecond);
  EXPECT_TRUE(compute_until([&] { return stopped(); }));
  watch.end();
  dog->remove(second);
}

TEST(Watchdog, ExistsOnceUntilItsLastReference) {
  auto one = Watchdog::instance();
  const auto two = Watchdog::instance();
  EXPECT_EQ(one, two);
  const std::weak_ptr<Watchdog> known = one;
  one.reset();
  EXPECT_FALSE(known.expired());
}

}  // namespace
}  // namespace limber::script

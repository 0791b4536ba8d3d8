// The process that contains the simulations: its signals, arithmetic, output, threads and children stay its own.
#include <gtest/gtest.h>

#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cfenv>
#include <csignal>
#include <thread>

#include "lib/scenes.h"

namespace limber::lib::test {
namespace {

constexpr const char* kEndless = "sim:on_step(function() while true do end end)";

void host_handler(int) {}

class HandlerScope {
 public:
  explicit HandlerScope(int signal) : signal_(signal) {
    struct sigaction action {};
    action.sa_handler = host_handler;
    sigaction(signal, &action, &before_);
  }
  ~HandlerScope() { sigaction(signal_, &before_, nullptr); }
  HandlerScope(const HandlerScope&) = delete;
  HandlerScope& operator=(const HandlerScope&) = delete;
  bool is_installed() const {
    struct sigaction action {};
    sigaction(signal_, nullptr, &action);
    return action.sa_handler == host_handler;
  }

 private:
  int signal_;
  struct sigaction before_ {};
};

std::uint64_t hash_after(std::uint64_t ticks) {
  const TestSim arm(kArm);
  arm.step(ticks);
  return arm.hash();
}

TEST(LimberProcess, EndlessLoopsAreStopped) {
  const TestSim endless(kEndless);
  endless.step(1);
  EXPECT_GE(limber_faults(endless.sim), 1u);
  EXPECT_NE(endless.log.all().find("stopped after"), std::string::npos) << endless.log.all();
}

TEST(LimberProcess, HandlersOfTheHostRemain) {
  const HandlerScope urgent(SIGURG);
  const HandlerScope profiler(SIGPROF);
  const HandlerScope pipe(SIGPIPE);
  const itimerval interval{{1000, 0}, {1000, 0}};
  setitimer(ITIMER_PROF, &interval, nullptr);
  {
    const TestSim endless(kEndless);
    endless.step(1);
    EXPECT_GE(limber_faults(endless.sim), 1u);
    EXPECT_TRUE(urgent.is_installed() && profiler.is_installed() && pipe.is_installed());
  }
  EXPECT_TRUE(urgent.is_installed() && profiler.is_installed() && pipe.is_installed());
  itimerval left{};
  getitimer(ITIMER_PROF, &left);
  EXPECT_EQ(left.it_interval.tv_sec, 1000);
  const itimerval never{};
  setitimer(ITIMER_PROF, &never, nullptr);
}

TEST(LimberProcess, RoundingStaysAndDoesNotMatter) {
  const std::uint64_t expected = hash_after(60);
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  const std::uint64_t rounded = hash_after(60);
  const int after = std::fegetround();
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(after, FE_UPWARD);
  EXPECT_EQ(rounded, expected);
}

TEST(LimberProcess, WritesNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  LogLines lines;
  {
    const TestSim noisy("print('hello') sim:on_step(function() print('tick') error('broken') end)");
    noisy.step(3);
    lines = noisy.log;
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(lines.all().find("hello"), std::string::npos);
  EXPECT_NE(lines.all().find("broken"), std::string::npos);
}

TEST(LimberProcess, SimulationsOnThreadsAreIndependent) {
  const std::uint64_t expected = hash_after(200);
  std::vector<std::uint64_t> hashes(4);
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes) threads.emplace_back([&hash] { hash = hash_after(200); });
  for (std::thread& thread : threads) thread.join();
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, expected);
}

TEST(LimberProcess, ASimulationMayChangeItsThread) {
  const TestSim arm(kArm);
  for (int i = 0; i < 5; i++) std::thread([&] { arm.step(40); }).join();
  EXPECT_EQ(arm.hash(), hash_after(200));
}

TEST(LimberProcess, CallsDuringACallAreBusy) {
  struct Nested {
    limber_sim* sim = nullptr;
    limber_status status = LIMBER_OK;
  } nested;
  limber_options options = LIMBER_OPTIONS;
  options.text = "sim:on_step(function() print('now') end)";
  options.log_context = &nested;
  options.log = [](void* context, limber_log_level, const char*) {
    auto& here = *static_cast<Nested*>(context);
    here.status = limber_step(here.sim, 1);
  };
  ASSERT_EQ(limber_create(&options, &nested.sim), LIMBER_OK);
  EXPECT_EQ(limber_step(nested.sim, 1), LIMBER_OK);
  EXPECT_EQ(nested.status, LIMBER_BUSY);
  EXPECT_EQ(limber_tick(nested.sim), 1u);
  limber_destroy(nested.sim);
}

TEST(LimberProcess, ChildrenCreateTheirOwnSimulations) {
  const std::uint64_t expected = hash_after(60);
  const TestSim parents(kArm);
  parents.step(1);
  const pid_t child = fork();
  if (child == 0) {
    int failures = 0;
    if (limber_step(parents.sim, 1) != LIMBER_WRONG_PROCESS) failures |= 1;
    if (hash_after(60) != expected) failures |= 2;
    limber_destroy(parents.sim);
    {
      const TestSim endless(kEndless);
      endless.step(1);
      if (limber_faults(endless.sim) == 0) failures |= 4;
    }
    _exit(failures);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  parents.step(1);
}

}  // namespace
}  // namespace limber::lib::test

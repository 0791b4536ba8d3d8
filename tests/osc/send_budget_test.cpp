// The budget of subscriptions with a simulated clock: limits, fair shares, reports.
#include "net/osc/send_budget.h"

#include <gtest/gtest.h>

#include <array>

namespace limber::osc::test {
namespace {

constexpr SendLimits kEachTest{10'000, 1000};
constexpr SendLimits kAllTest{30'000, 3000};
constexpr std::int64_t kMs = 1'000'000;

/// Simulates senders with a demand per millisecond and returns the amount that each has sent.
template <std::size_t N>
std::array<double, N> simulate(const std::array<int, N>& wants, double seconds, std::size_t bytes = 1) {
  SendBudget budget(kEachTest, kAllTest);
  std::array<SendBudget::Account*, N> accounts{};
  for (auto& account : accounts) account = budget.open_account();
  std::array<double, N> got{};
  std::int64_t now = 7;
  budget.refill(now);
  for (int ms = 0; ms < static_cast<int>(seconds * 1000); ms++) {
    now += kMs;
    budget.refill(now);
    for (std::size_t i = 0; i < N; i++) {
      for (int k = 0; k < wants[i]; k++) got[i] += accounts[i]->try_consume(bytes, 1) ? 1 : 0;
    }
  }
  return got;
}

TEST(SendBudget, LimitsSingleSender) {
  const auto got = simulate<1>({100}, 10);
  EXPECT_NEAR(got[0], kEachTest.values * (10 + SendBudget::kBurst), 2);
  const auto modest = simulate<1>({1}, 10);
  EXPECT_EQ(modest[0], 10'000) << "exactly its limit: nothing is withheld";
}

TEST(SendBudget, LimitsBytes) {
  const auto got = simulate<1>({100}, 10, 100);
  EXPECT_NEAR(got[0] * 100, kEachTest.bytes * (10 + SendBudget::kBurst), 200);
}

TEST(SendBudget, GreedySendersDoNotReduceModestOnes) {
  // five senders with unlimited demand, and one that wants less than a sixth of the total
  std::array<int, 6> wants{};
  wants.fill(50);
  SendBudget budget(kEachTest, kAllTest);
  std::array<SendBudget::Account*, 6> accounts{};
  for (auto& account : accounts) account = budget.open_account();
  std::array<double, 6> got{};
  std::int64_t now = 0;
  budget.refill(now);
  for (int ms = 0; ms < 10'000; ms++) {
    budget.refill(now += kMs);
    for (std::size_t i = 0; i + 1 < 6; i++) {
      for (int k = 0; k < 50; k++) got[i] += accounts[i]->try_consume(1, 1) ? 1 : 0;
    }
    if (ms % 5 == 0) got[5] += accounts[5]->try_consume(1, 1) ? 1 : 0;
  }
  EXPECT_EQ(got[5], 2000) << "200 a second, all of them";
  const double share = (kAllTest.values - 200) / 5;
  for (std::size_t i = 0; i + 1 < 6; i++) EXPECT_NEAR(got[i], share * 10 + kEachTest.values * 0.1, 10) << i;
}

TEST(SendBudget, EqualDemandsGetEqualShares) {
  std::array<int, 64> wants{};
  wants.fill(20);
  const auto got = simulate<64>(wants, 20);
  for (const double each : got) EXPECT_NEAR(each, kAllTest.values / 64 * 20 + 100, 5);
}

TEST(SendBudget, RepaysChargesAboveBurst) {
  SendBudget budget(kEachTest, kAllTest);
  SendBudget::Account* const account = budget.open_account();
  budget.refill(0);
  EXPECT_TRUE(account->try_consume(21'000, 1)) << "a frame of two seconds' bytes";
  int ms = 0;
  std::int64_t now = 0;
  do {
    budget.refill(now += kMs);
    ms++;
  } while (!account->try_consume(1, 1));
  EXPECT_NEAR(ms, 2000, 2) << "the burst of 0.1 s was there, the rest has to come";
}

TEST(SendBudget, PausesDoNotAccumulate) {
  SendBudget budget(kEachTest, kAllTest);
  SendBudget::Account* const account = budget.open_account();
  budget.refill(0);
  budget.refill(std::int64_t{3600} * 1000 * kMs);
  int got = 0;
  while (account->try_consume(1, 1)) got++;
  EXPECT_EQ(got, 100);
}

TEST(SendBudget, ReportsReductions) {
  SendBudget budget(kEachTest, kAllTest);
  SendBudget::Account* const greedy = budget.open_account();
  SendBudget::Account* const modest = budget.open_account();
  std::vector<std::pair<double, bool>> reports;  // seconds, reduced
  double values = 0;
  budget.refill(0);
  for (int ms = 1; ms <= 30'000; ms++) {
    budget.refill(ms * kMs);
    (void)modest->try_consume(1, 1);
    for (int k = 0; k < (ms < 20'000 ? 10 : 1); k++) (void)greedy->try_consume(1, 1);
    for (const SendBudget::Report& report : budget.reports(ms * kMs)) {
      EXPECT_EQ(report.account, greedy);
      reports.emplace_back(ms / 1000.0, report.throttled);
      if (reports.size() == 2) values = report.values;
    }
  }
  EXPECT_EQ(reports, (std::vector<std::pair<double, bool>>{{2, true}, {12, true}, {22, false}}));
  EXPECT_NEAR(values, kEachTest.values, 5);
  EXPECT_EQ(budget.throttled(), 0u);
}

}  // namespace
}  // namespace limber::osc::test

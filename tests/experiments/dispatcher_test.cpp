// Distribution of evaluations to workers that are slow, crash and hang.
#include "experiments/dispatcher.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "experiments/fake_workers.h"

namespace limber::experiments::test {
namespace {

using Fate = FakeWorkers::Fate;

struct Rig {
  explicit Rig(std::size_t count) : workers(count), dispatcher(workers, options()) {}

  Dispatcher::Options options() {
    Dispatcher::Options options;
    options.time_limit = 20;
    options.clock = [this] { return workers.now; };
    options.canceled = [this] { return cancel_at && workers.now >= *cancel_at; };
    return options;
  }
  Result<Dispatcher::End> run(std::uint64_t count) {
    next = 0;
    dispatcher.set_setup({"scene.lua", 10, {"rate"}});
    return dispatcher.run(
        [this, count]() -> std::optional<Evaluation> {
          if (next >= count) return {};
          const std::uint64_t number = next++;
          return Evaluation{number, 1, {static_cast<double>(number) / 8}};
        },
        [this](const Evaluation& evaluation, const Outcome& outcome) -> Result<void> {
          EXPECT_EQ(evaluation.number, outcome.number);
          outcomes.push_back(outcome);
          return {};
        });
  }

  FakeWorkers workers;
  std::optional<double> cancel_at;
  Dispatcher dispatcher;
  std::uint64_t next = 0;
  std::vector<Outcome> outcomes;
};

TEST(Dispatcher, CommitsInOrderForAnyNumberOfWorkers) {
  for (const std::size_t count : {1u, 2u, 3u, 8u, 64u}) {
    Rig rig(count);
    ASSERT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
    const auto end = rig.run(200);
    ASSERT_TRUE(end.ok()) << end.error();
    EXPECT_EQ(*end, Dispatcher::End::done);
    expect_all(rig.outcomes, 200);
    EXPECT_EQ(rig.workers.starts, static_cast<int>(count));
  }
}

TEST(Dispatcher, UsesAllWorkers) {
  const auto duration = [](std::size_t count) {
    Rig rig(count);
    EXPECT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
    const double begin = rig.workers.now;
    EXPECT_TRUE(rig.run(400).ok());
    return rig.workers.now - begin;
  };
  EXPECT_LT(duration(4), duration(1) / 3.5);
}

TEST(Dispatcher, RepeatsEvaluationsOfWorkersThatDieOrHang) {
  Rig rig(4);
  rig.workers.fate = [](std::uint64_t number, int tried) {
    if (tried == 0 && number % 7 == 0) return Fate::crash;
    if (tried < 2 && number % 11 == 0) return Fate::hang;
    return Fate::answer;
  };
  ASSERT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
  const auto end = rig.run(100);
  ASSERT_TRUE(end.ok()) << end.error();
  expect_all(rig.outcomes, 100);
}

TEST(Dispatcher, GivesUpAfterThreeTries) {
  Rig rig(2);
  rig.workers.fate = [](std::uint64_t number, int) {
    return number == 3 ? Fate::crash : number == 5 ? Fate::hang : Fate::answer;
  };
  ASSERT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
  ASSERT_TRUE(rig.run(10).ok());
  ASSERT_EQ(rig.outcomes.size(), 10u);
  EXPECT_EQ(rig.outcomes[3].error, "the simulation crashed, 3 times");
  EXPECT_EQ(rig.outcomes[5].error, "the simulation took longer than 20 s, 3 times");
  EXPECT_EQ(rig.outcomes[9].error, "");
  EXPECT_EQ((*rig.workers.tries)[3], Dispatcher::kTries);
  EXPECT_EQ((*rig.workers.tries)[5], Dispatcher::kTries);
  EXPECT_EQ((*rig.workers.tries)[4], 1);
}

TEST(Dispatcher, LimitsHowFarOthersAreAhead) {
  Rig rig(2);
  std::uint64_t farthest = 0;
  rig.workers.fate = [&](std::uint64_t number, int tried) {
    if (rig.outcomes.empty()) farthest = std::max(farthest, number);
    return number == 0 && tried < 2 ? Fate::hang : Fate::answer;
  };
  rig.workers.now = 0;
  ASSERT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
  ASSERT_TRUE(rig.run(5000).ok());
  EXPECT_LE(farthest, 2 * Dispatcher::kAhead);
  EXPECT_EQ(rig.outcomes.size(), 5000u);
}

TEST(Dispatcher, CancelKeepsWhatWasCommitted) {
  Rig rig(3);
  ASSERT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
  rig.cancel_at = rig.workers.now + 10;
  const auto end = rig.run(1000);
  ASSERT_TRUE(end.ok());
  EXPECT_EQ(*end, Dispatcher::End::canceled);
  EXPECT_GT(rig.outcomes.size(), 20u);
  EXPECT_LT(rig.outcomes.size(), 1000u);
  for (std::uint64_t i = 0; i < rig.outcomes.size(); i++) EXPECT_EQ(rig.outcomes[i].number, i);
}

TEST(Dispatcher, ReportsTheErrorOfTheScene) {
  Rig rig(2);
  rig.workers.fault = "scene.lua:3: there is no global 'x'";
  const Result<SceneInfo> scene = rig.dispatcher.describe({"scene.lua", 10, {}});
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error(), "scene.lua:3: there is no global 'x'");
}

TEST(Dispatcher, RejectsAnotherScene) {
  Rig rig(2);
  ASSERT_TRUE(rig.dispatcher.describe({"scene.lua", 10, {}}).ok());
  rig.workers.scene.hash++;
  const auto end = rig.run(10);
  ASSERT_FALSE(end.ok());
  EXPECT_NE(end.error().find("the scene is not the one that was read at the beginning"), std::string::npos);
  EXPECT_TRUE(rig.outcomes.empty());
}

TEST(Dispatcher, EndsIfWorkersNeverBegin) {
  Rig rig(2);
  rig.workers.crash_at_setup = true;
  const Result<SceneInfo> scene = rig.dispatcher.describe({"scene.lua", 10, {}});
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error(), "the simulation crashed 3 times before it could begin; check the scene with limber play");
}

TEST(Evaluation, LinesKeepAllBits) {
  const Evaluation evaluation{9007199254740993u, 18446744073709551615u, {0.1, 1.0 / 3, -0.0, 5e-324, 1.7e308}};
  const auto back = std::get<Evaluation>(*decode_request(encode(Request(evaluation))));
  EXPECT_EQ(back.number, evaluation.number);
  EXPECT_EQ(back.seed, evaluation.seed);
  ASSERT_EQ(back.values.size(), evaluation.values.size());
  for (std::size_t i = 0; i < back.values.size(); i++)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back.values[i]), std::bit_cast<std::uint64_t>(evaluation.values[i]));
  const Outcome outcome{7, {std::numeric_limits<double>::quiet_NaN(), 2.5, -1 / 0.0}, 0xfedcba9876543210u, "why\n\""};
  const auto same = std::get<Outcome>(*decode_answer(encode(Answer(outcome))));
  EXPECT_TRUE(std::isnan(same.results[0]));
  EXPECT_EQ(same.results[1], 2.5);
  EXPECT_EQ(same.results[2], -1 / 0.0);
  EXPECT_EQ(same.hash, outcome.hash);
  EXPECT_EQ(same.error, outcome.error);
}

TEST(Evaluation, RejectsOtherLines) {
  for (const char* wrong :
       {"", "{}", "[]", "{\"evaluate\":{}}", "{\"evaluate\":3}", "null", "{\"setup\":{\"scene\":1}}",
        R"({"setup":{"scene":"s","duration":true,"parameters":[]}})",
        R"({"setup":{"scene":"s","duration":"inf","parameters":[]}})",
        R"({"setup":{"scene":"s","duration":1,"parameters":"a"}})",
        R"({"evaluate":{"number":1.5,"seed":1,"values":[]}})", R"({"evaluate":{"number":1,"seed":-1,"values":[]}})",
        R"({"evaluate":{"number":1,"seed":18446744073709551616,"values":[]}})",
        R"({"evaluate":{"number":1,"seed":true,"values":[]}})", R"({"evaluate":{"number":1,"seed":1,"values":3}})",
        R"({"evaluate":{"number":1,"seed":1,"values":{"a":3}}})",
        R"({"evaluate":{"number":1,"seed":1,"values":["-infinity"]}})"})
    EXPECT_FALSE(decode_request(wrong).has_value()) << wrong;
  for (const char* wrong :
       {"", "{}", "{\"outcome\":{\"number\":1}}", "{\"scene\":{}}", "{\"fault\":1}",
        R"({"outcome":{"number":1,"results":[true],"hash":1,"error":""}})",
        R"({"outcome":{"number":1,"results":[],"hash":1e3,"error":""}})",
        R"({"scene":{"parameters":{},"results":[],"hash":1}})",
        R"({"scene":{"parameters":[],"results":[{"name":"r","min":0,"max":1,"cells":2147483648}],"hash":1}})",
        R"({"scene":{"parameters":[],"results":[{"name":"r","min":0,"max":1,"cells":-1}],"hash":1}})"})
    EXPECT_FALSE(decode_answer(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace limber::experiments::test

// `limber bench`: results as JSON and as text.
#include "app/commands/commands.h"

#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limber::app {
namespace {

using Json = nlohmann::ordered_json;

TEST(Bench, CountsArmsForEachSolverAndNumberOfThreads) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(bench_command({true, 2}), 0);
  const Json all = Json::parse(testing::internal::GetCapturedStdout());
  EXPECT_TRUE(all.contains("commit") && all.contains("cpu"));
  EXPECT_EQ(all["ticks"], 2);
  const std::size_t threads = std::thread::hardware_concurrency() > 1 ? 2 : 1;
  ASSERT_EQ(all["settings"].size(), 2 * threads);
  EXPECT_EQ(all["settings"][0]["solver"], "direct");
  EXPECT_EQ(all["settings"][threads]["solver"], "iterative");
  for (const Json& setting : all["settings"]) {
    const Json& measured = setting["measured"];
    ASSERT_FALSE(measured.empty());
    const int most = measured.back()["arms"];
    const int last_in_time = measured.size() > 1 ? measured[measured.size() - 2]["arms"].get<int>() : 0;
    EXPECT_GT(measured.back()["tick_ms"], 0);
    // rounded down to two digits
    EXPECT_GE(setting["arms_in_real_time"], last_in_time * 9 / 10);
    EXPECT_LE(setting["arms_in_real_time"], most);
  }
}

TEST(Bench, PrintsATable) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(bench_command({false, 1}), 0);
  const std::string text = testing::internal::GetCapturedStdout();
  for (const char* line : {"in real time, 60 ticks a second.\nProcessor: ", "\nsolver     threads    arms\n",
                           "\ndirect           1 ", "\niterative        1 "}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
  }
}

}  // namespace
}  // namespace limber::app

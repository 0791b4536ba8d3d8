// limber_measure: results, output, and that both sides simulate the same arms.
#include "bench/measure/measures.h"

#include <gtest/gtest.h>

#include <string>

#include "bench/measure/arms.h"
#include "sim/world/world.h"
#include "support/skip.h"

namespace limber {
namespace {

using Json = nlohmann::ordered_json;

Json figures_of(std::string_view name, const MeasureOptions& options) {
  for (const Measure& measure : measures()) {
    if (measure.name == name) return measure.run(options);
  }
  return {};
}

TEST(Measures, MeasuresAnArm) {
  MeasureOptions options;
  options.ticks = 6;
  options.compare_raw = true;
  const Json figures = figures_of("arms-1", options);
  EXPECT_EQ(figures["parts"], 18);  // 17 and the base
  EXPECT_EQ(figures["ticks"], 6);
  EXPECT_EQ(figures["settings"]["solver_iterations"], sim::World::table().at("solver_iterations").initial[0]);
  for (const Json& side : {figures, figures["raw"]}) {
    EXPECT_GT(side["tick_us"]["min"], 0);
    EXPECT_LE(side["tick_us"]["min"], side["tick_us"]["median"]);
    EXPECT_LE(side["tick_us"]["median"], side["tick_us"]["p99"]);
    EXPECT_GE(side["joint_gap_mm"], 0);
    EXPECT_LT(side["joint_gap_mm"], 100) << "an arm fell apart";
  }
  for (const char* phase : {"commands", "scripts", "effects", "physics", "readouts", "snapshot", "collector"}) {
    EXPECT_GE(figures["phases_us"][phase], 0) << phase;
  }
  for (const char* phase : {"broadphase", "narrowphase", "islands", "solver"}) {
    EXPECT_GT(figures["bullet_us"][phase], 0) << phase;
  }
  EXPECT_GT(figures["ratio"]["min"], 0);
  EXPECT_GT(figures["ratio"]["median"], 0);
}

TEST(Measures, HashIsIndependentOfTheComparison) {
  MeasureOptions options;
  options.ticks = 5;
  const Json alone = figures_of("arms-1", options);
  options.compare_raw = true;
  const Json beside = figures_of("arms-1", options);
  options.ticks = 6;
  const Json longer = figures_of("arms-1", options);
  EXPECT_EQ(alone["hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(alone["hash"], beside["hash"]);
  EXPECT_NE(alone["hash"], longer["hash"]);
}

TEST(Measures, DrawsSmallAndLarge) {
  MeasureOptions options;
  options.ticks = 2;
  const Json figures = figures_of("picture", options);
  for (const char* size : {"small", "large"}) {
    EXPECT_GT(figures[size]["frames_a_second"], 0) << figures.dump();
    EXPECT_EQ(figures[size]["frames"], 2);
    EXPECT_GT(figures[size]["processor_us"]["min"], 0);
  }
  EXPECT_EQ(figures["small"]["parts"], 16 * 17);
  EXPECT_EQ(figures["large"]["parts"], 17000);
}

TEST(Measures, RunsBothSolvers) {
  MeasureOptions options;
  options.ticks = 3;
  const Json figures = figures_of("solver", options);
  for (const char* scene : {"arm", "square wave, 5 N·m, 1/240 s", "tree, floating", "four legs walking", "100 arms"}) {
    const Json& direct = figures[scene]["direct"];
    EXPECT_GE(direct["island_steps"]["direct"], 3) << scene;
    EXPECT_EQ(direct["island_steps"]["fallbacks"], 0) << scene;
    EXPECT_LT(direct["residuals"]["unbounded"], 1e-4) << scene;
    EXPECT_GT(figures[scene]["time_ratio"]["median"], 0) << scene;
  }
  EXPECT_EQ(figures["random trees over a floor, 1/60 s"]["no_number"], 0);
}

TEST(Measures, TwoThreadsGiveTheSameState) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  MeasureOptions options;
  options.ticks = 1;
  const Json figures = figures_of("threads", options);
  for (const char* scene : {"100 arms, direct", "1000 arms, direct", "100 arms, iterative"}) {
    EXPECT_EQ(figures[scene]["same_state"], true) << scene;
    EXPECT_GT(figures[scene]["ratio"]["median"], 0) << scene;
  }
}

TEST(Measures, RecordsAndReplaysATake) {
  MeasureOptions options;
  options.ticks = 20;
  const Json figures = figures_of("take", options);
  EXPECT_EQ(figures["ticks"], 20);
  EXPECT_EQ(figures["messages_per_tick"], 17);
  EXPECT_GT(figures["mb_per_minute"], 0.1);
  EXPECT_GT(figures["recording_percent_of_tick"], 0);
  EXPECT_GT(figures["replayed_by_played"], 0);
}

TEST(Measures, EvaluatesPolicies) {
  MeasureOptions options;
  options.ticks = 5;
  const Json figures = figures_of("policy", options);
  EXPECT_EQ(figures["evaluations"], 5);
  EXPECT_GT(figures["mlp 48-256-256-12, tanh, us"]["min"], 0);
  EXPECT_GT(figures["gru 48-256, linear 256-12, us"]["min"], 0);
}

TEST(Measures, PrintsJson) {
  testing::internal::CaptureStdout();
  const int code = run_measures({{"arms-1", "arm-quality"}, false, true, 3});
  const Json all = Json::parse(testing::internal::GetCapturedStdout());
  EXPECT_EQ(code, 0);
  ASSERT_EQ(all["scenes"].size(), 2u);
  EXPECT_EQ(all["scenes"][0]["scene"], "arms-1");
  EXPECT_EQ(all["scenes"][1]["scene"], "arm-quality");
  EXPECT_EQ(all["scenes"][1]["settings"]["substeps"], 1);
  EXPECT_TRUE(all.contains("commit") && all.contains("cpu"));
}

TEST(Measures, PrintsText) {
  testing::internal::CaptureStdout();
  const int code = run_measures({{"ARMS-1"}, true, false, 3});
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(code, 0);
  for (const char* line : {"arms-1: one arm of 17 parts", "tick us ", "simulated seconds per second", "phases us ",
                           "joint gap mm", "servo error rad", "hash ", "raw tick us ", "ratio "}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
  }
}

TEST(Measures, UnknownSceneSuggestsTheNearest) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_measures({{"arms-10"}, false, false, 1}), 2);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("'arms-10'; did you mean 'arms-1"), std::string::npos) << text;
}

TEST(Measures, FormatsResults) {
  const Json figures = {{"parts", 18}, {"tick_us", {{"min", 1.5}, {"p99", 2}}}, {"raw", {{"tick_us", {{"min", 3}}}}}};
  EXPECT_EQ(text_of(figures),
            "  parts                           18\n"
            "  tick us                         min 1.5  p99 2\n"
            "  raw tick us                     min 3\n");
}

TEST(Measures, OscSceneHasNoRejectedMessages) {
  const Json figures = figures_of("osc-in", {});
  EXPECT_EQ(figures["refused"], 0);
  EXPECT_EQ(figures["burst_on_loopback"]["sent"], 10000);
  EXPECT_GE(figures["burst_on_loopback"]["arrived"], 2000);
}

// a single hanging link, which both sides can hold: the servo reaches its target and the joint stays closed
TEST(Measures, BothSidesSimulateTheSameArm) {
  ArmScene scene = arm_scene(1);
  scene.parts = 1;
  scene.hanging = true;
  EXPECT_DOUBLE_EQ(scene.center(0, 0).z + scene.to_joint().z, scene.center(0, -1).z - scene.size.z / 2);
  BenchArms ours(scene);
  RawLoop raw(scene);
  for (double time = 0; time < 0.75; time += 1.0 / 60) {
    ours.drive(time);
    raw.drive(time);
    ours.tick();
    raw.tick();
  }
  // the target moves at most 0.3·π rad/s; stock servos correct a fifth of their error per step: 5/240 s behind, plus
  // the tick's 1/60 s
  const double behind = 0.3 * kPi * (5.0 / 240 + 1.0 / 60) + 0.002;
  EXPECT_LT(ours.servo_error(0.75), behind);
  EXPECT_LT(raw.servo_error(0.75), behind);
  EXPECT_LT(ours.joint_gap(), 1e-4);
  EXPECT_LT(raw.joint_gap(), 1e-3);
}

}  // namespace
}  // namespace limber

// Policies in scripts: evaluation, errors that name the argument, hidden values in checkpoints.
#include <gtest/gtest.h>

#include "script/scene/scene_checkpoint.h"
#include "sim/state/world_checkpoint.h"
#include "stage.h"
#include "support/policy_files.h"

namespace limber::script {
namespace {

// y1 = x1 + 2 x2, y2 = x2
std::string two_by_two() { return limber::test::linear_policy({2, 2}, {1, 2, 0, 1}); }

// h' = (1 − ½) tanh(x) + ½ h, from weights of 0 but one
std::string averaging_gru() {
  limber::test::SafetensorsWriter writer;
  writer.add("weight_ih_l0", {{3, 1}, {0, 0, 1}});
  writer.add("weight_hh_l0", {{3, 1}, {0, 0, 0}});
  return writer.bytes();
}

std::string printed_with_policy(const std::string& text) {
  ScriptFixture fixture;
  fixture.write("scripts/walk.safetensors", two_by_two());
  fixture.write("scripts/memory.safetensors", averaging_gru());
  const std::string fault = fixture.run("local policy = sim:load_policy('walk.safetensors')\n" + text);
  if (!fault.empty()) return first_line(fault);
  return fixture.host.printed.empty() ? "" : fixture.host.printed.back();
}

TEST(PolicyScripts, Evaluate) {
  EXPECT_EQ(printed_with_policy("local a = policy:evaluate { 3, 0.5 }\n"
                                "print(policy, policy.inputs, policy.outputs, #a, a[1], a[2])"),
            "policy 'walk.safetensors'\t2\t2\t2\t4\t0.5");
  EXPECT_EQ(printed_with_policy("local kept = {}\nlocal a = policy:evaluate({ 3, 0.5 }, kept)\n"
                                "print(a == kept, kept[1])"),
            "true\t4");
}

TEST(PolicyScripts, ErrorsNameTheArgument) {
  const auto error_in = [](const std::string& line) {
    const std::string text = printed_with_policy(line);
    const std::string place = "scripts/scene.lua:2: ";
    EXPECT_TRUE(text.starts_with(place)) << text;
    return text.substr(std::min(place.size(), text.size()));
  };
  EXPECT_EQ(error_in("policy:evaluate(1)"), "policy:evaluate takes a list of observations, not 1");
  EXPECT_EQ(error_in("policy:evaluate { 1 }"), "policy:evaluate: observation 2 of 2 is a number, not nothing");
  EXPECT_EQ(error_in("policy:evaluate { 1, 2, 3 }"),
            "policy:evaluate: policy 'walk.safetensors' takes 2 observations, not 3");
  EXPECT_EQ(error_in("policy:evaluate { 0, 0 / 0 }"),
            "policy:evaluate: policy 'walk.safetensors': observation 2 is not finite, or larger than 3e38");
  EXPECT_EQ(error_in("policy:evaluate({ 1, 2 }, 3)"),
            "policy:evaluate: the second argument is a table for the actions, not 3");
  EXPECT_EQ(error_in("policy.evaluate({ 1, 2 })"), "policy.evaluate is a method: write policy:evaluate(…)");
  EXPECT_EQ(error_in("print(policy.input)"), "policy has no member 'input'; did you mean 'inputs'?");
  EXPECT_EQ(error_in("policy.inputs = 3"), "policy has nothing to set");
  EXPECT_EQ(error_in("sim:load_policy(3)"), "load_policy: the file takes text, not 3");
  EXPECT_EQ(error_in("sim:load_policy('run.safetensors')").substr(0, 58),
            "load_policy: there is no file 'run.safetensors'; looked fo");
}

TEST(PolicyScripts, ABrokenFileIsReported) {
  ScriptFixture fixture;
  fixture.write("scripts/walk.safetensors", "PK");
  const std::string fault = first_line(fixture.run("sim:load_policy('walk.safetensors')"));
  EXPECT_NE(fault.find("scripts/walk.safetensors: is not a safetensors file, or is damaged. Export it again."),
            std::string::npos)
      << fault;
}

TEST(PolicyScripts, LoadAtTheTopLevelOnly) {
  ScriptFixture fixture;
  fixture.write("scripts/walk.safetensors", two_by_two());
  EXPECT_EQ(fixture.play("sim:on_start(function() sim:load_policy('walk.safetensors') end)"), "");
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_NE(fixture.host.faults[0].text.find("sim:load_policy declares something about the scene"), std::string::npos)
      << fixture.host.faults[0].text;
}

constexpr const char* kMemoryScene = R"(
local a, b = sim:load_policy("memory.safetensors"), sim:load_policy("memory.safetensors")
local x, y = { 1 }, {}
sim:on_step(function()
  a:evaluate(x, y)
  print(string.format("%.9g", y[1]))
  if sim.time > 0.1 and sim.time < 0.12 then a:reset() end
end)
sim:on_start(function() print(b:evaluate { 0 }[1]) end)
)";

TEST(PolicyScripts, HiddenValuesAreRestoredWithACheckpoint) {
  ScriptFixture fixture;
  fixture.write("scripts/memory.safetensors", averaging_gru());
  EXPECT_EQ(fixture.play(kMemoryScene, 3), "");
  ASSERT_EQ(fixture.host.printed.size(), 4u);
  EXPECT_EQ(fixture.host.printed[0], "0") << "each policy has hidden values of its own";
  for (int i = 1; i <= 3; i++)
    EXPECT_NEAR(std::stod(fixture.host.printed[static_cast<std::size_t>(i)]), std::tanh(1) * (1 - std::pow(0.5, i)),
                1e-6);
  PageStore pages;
  Archive scratch;
  sim::WorldCheckpoint world;
  SceneCheckpoint scene;
  world.capture(fixture.world, pages, nullptr, scratch);
  scene.capture(fixture.scene, pages, nullptr, scratch);
  fixture.host.printed.clear();
  fixture.tick(8);
  const std::vector<std::string> first = fixture.host.printed;
  EXPECT_NEAR(std::stod(first.back()), std::tanh(1) * 0.75, 0.2) << "it was reset";
  world.restore(fixture.world, pages, scratch);
  scene.restore(fixture.scene, pages, scratch);
  fixture.host.printed.clear();
  fixture.tick(8);
  EXPECT_EQ(fixture.host.printed, first);
}

}  // namespace
}  // namespace limber::script

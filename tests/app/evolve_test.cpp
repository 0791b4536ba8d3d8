// limber evolve: objectives, archive, presets, kills.
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

#include "app/evolve_kills.h"
#include "app/push_scene.h"
#include "engine/presets/text.h"

namespace limber::app::test {
namespace {

// The largest distance has the largest push, the smallest mass, and the way forth.
TEST(Evolve, FindsTheBestValues) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const RunResult result =
      run({"evolve", "push.lua", "--maximize", "distance", "--duration", "1", "--generations", "40"}, folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  ASSERT_TRUE(result.out.starts_with("distance ")) << result.out;
  EXPECT_GT(std::stod(result.out.substr(9)), 0.95 * 4 / 0.5);
  EXPECT_NE(result.out.find("--param way=forth"), std::string::npos) << result.out;
}

TEST(Evolve, ArchiveIsTheSameAfterAnyInterruption) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const auto evolve = [&](const std::string& out, const char* generations, const char* jobs, bool resume) {
    std::vector<std::string> words{"evolve",     "push.lua", "--maximize", "noise", "--descriptor",  "distance",
                                   "--duration", "1",        "--seeds",    "1:2",   "--population",  "20",
                                   "--out",      out,        "--jobs",     jobs,    "--generations", generations};
    if (resume) words.emplace_back("--resume");
    const RunResult result = run(words, folder.path());
    EXPECT_EQ(result.code, 0) << result.err;
    return content(folder.path() + "/" + out + "/elites.csv");
  };
  const std::string whole = evolve("whole", "6", "2", false);
  EXPECT_GT(rows(whole).size(), 3u) << whole;
  (void)evolve("parts", "2", "1", false);
  (void)evolve("parts", "3", "3", true);
  EXPECT_EQ(evolve("parts", "6", "1", true), whole);
  EXPECT_EQ(content(folder.path() + "/parts/state.json"), content(folder.path() + "/whole/state.json"));
}

TEST(Evolve, SurvivesKills) {
  KilledSearch search(14);
  search.run_whole();
  search.run_with_killed_children(4);
  search.expect_same("children");
  search.run_with_killed_jobs(2);
  search.expect_same("jobs");
}

/// A ball that is thrown up and forward: the farther, the lower.
constexpr const char* kThrow = R"(
params { { "slope", 0.5, min = 0, max = 1 }, { "power", 0.5, min = 0, max = 1 } }
sim.gravity = vec3()
local part = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 1 })
sim:on_start(function() part:apply_impulse(vec3(1 - params.slope, 0, params.slope) * params.power) end)
result("far", function() return part.position.x end)
result("high", function() return part.position.z end)
)";

RunResult evolve_throw(const TempFolder& folder, const std::string& out, const char* jobs, const char* generations,
                       bool resume) {
  std::vector<std::string> words{"evolve",     "throw.lua", "--maximize", "far", "--maximize",    "high",
                                 "--duration", "1",         "--seeds",    "1",   "--population",  "8",
                                 "--out",      out,         "--jobs",     jobs,  "--generations", generations};
  if (resume) words.emplace_back("--resume");
  return run(words, folder.path());
}

// far + high = power, at most 1: the front is the line on which the sum is 1.
TEST(Evolve, SeveralObjectivesGiveTheParetoFront) {
  const TempFolder folder;
  folder.file("throw.lua", kThrow);
  const RunResult result = evolve_throw(folder, "whole", "2", "6", false);
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string csv = content(folder.path() + "/whole/elites.csv");
  const std::vector<Row> table = rows(csv);
  ASSERT_GT(table.size(), 10u) << csv;
  EXPECT_EQ(table[0],
            (Row{"number", "preset", "generation", "individual", "far", "high", "slope", "power", "hash", "command"}));
  for (std::size_t i = 1; i < table.size(); i++) {
    EXPECT_EQ(table[i][0], std::to_string(i));
    EXPECT_EQ(table[i][1], "front_" + std::to_string(i));
    EXPECT_NEAR(std::stod(table[i][4]) + std::stod(table[i][5]), 1, 0.15);
    if (i == 1) continue;
    EXPECT_LT(std::stod(table[i][4]), std::stod(table[i - 1][4]));
    EXPECT_GT(std::stod(table[i][5]), std::stod(table[i - 1][5]));
  }
  EXPECT_GT(std::stod(table[1][4]), 0.8);
  EXPECT_GT(std::stod(table.back()[5]), 0.8);
  // it is the same for any number of jobs, and after interruptions
  ASSERT_EQ(evolve_throw(folder, "parts", "1", "2", false).code, 0);
  ASSERT_EQ(evolve_throw(folder, "parts", "3", "6", true).code, 0);
  EXPECT_EQ(content(folder.path() + "/parts/elites.csv"), csv);
  EXPECT_EQ(content(folder.path() + "/parts/state.json"), content(folder.path() + "/whole/state.json"));
}

TEST(Evolve, ElitesArePresetsOfTheScene) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const std::vector<std::string> words{"evolve",       "push.lua", "--maximize",   "noise", "--descriptor", "distance",
                                       "--out",        "a",        "--duration",   "1",     "--seeds",      "1",
                                       "--population", "8",        "--generations"};
  const auto evolve = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more);
    return run(all, folder.path()).code;
  };
  ASSERT_EQ(evolve({"3"}), 0);
  const std::string file = folder.path() + "/a/elites.presets.json";
  Result<engine::ParsedPresets> parsed = engine::parse_presets(content(file));
  ASSERT_TRUE(parsed.ok()) << parsed.error();
  EXPECT_TRUE(parsed->problems.empty());
  std::vector<Row> table = rows(content(folder.path() + "/a/elites.csv"));
  ASSERT_EQ(parsed->presets.size() + 1, table.size());
  for (std::size_t i = 1; i < table.size(); i++) {
    const engine::Preset& preset = *parsed->presets[i - 1];
    EXPECT_EQ(preset.name, table[i][1]);
    EXPECT_EQ(preset.name, fmt::format("cell_{}", static_cast<int>(std::floor(std::stod(table[i][5]) + 10)) + 1));
    ASSERT_EQ(preset.values.size(), 3u);
    EXPECT_EQ(preset.values[0], std::stod(table[i][6]));
    EXPECT_EQ(preset.values[1], std::stod(table[i][7]));
    EXPECT_EQ(preset.schema->layouts()[0]->properties[2].labels[static_cast<std::size_t>(preset.values[2])],
              table[i][8]);
  }
  // a show adds a preset of its own, which a continued search keeps
  const std::string name = table.back()[1];
  folder.file("keep.lua", std::string(kPush) + "sim:on_start(function() presets:recall('" + name +
                              "') presets:store('mine', { rows = '/scene/push' }) end)");
  const RunResult played = run({"keep.lua", "--fast", "--duration", "0.1", "--presets", file}, folder.path());
  ASSERT_EQ(played.code, 0) << played.err;
  ASSERT_EQ(evolve({"6", "--resume"}), 0);
  parsed = engine::parse_presets(content(file));
  ASSERT_TRUE(parsed.ok()) << parsed.error();
  EXPECT_EQ(parsed->presets.back()->name, "mine");
  EXPECT_EQ(parsed->presets.back()->values[0], std::stod(table.back()[6]));
  EXPECT_EQ(parsed->presets.size(), rows(content(folder.path() + "/a/elites.csv")).size());
  EXPECT_EQ(content(folder.path() + "/push.presets.json"), "");  // the scene's own presets are not touched
}

TEST(Evolve, PlaysElites) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  ASSERT_EQ(run({"evolve", "push.lua", "--maximize", "distance", "--duration", "1", "--generations", "8", "--seeds",
                 "5", "--out", "a"},
                folder.path())
                .code,
            0);
  const std::vector<Row> table = rows(content(folder.path() + "/a/elites.csv"));
  ASSERT_GT(table.size(), 3u);
  const auto hash_of = [&](std::vector<std::string> words, const std::string& from) {
    words.insert(words.begin(), "evolve");
    for (const char* option : {"--fast", "--duration", "1", "--hash"}) words.emplace_back(option);
    const RunResult result = run(std::move(words), from);
    EXPECT_EQ(result.code, 0) << result.err;
    const std::size_t at = result.out.find("hash ");
    return at == std::string::npos ? result.err : result.out.substr(at + 5, 16);
  };
  const std::size_t hash = table[0].size() - 2;
  ASSERT_EQ(table[0][hash], "hash");
  EXPECT_EQ(hash_of({"--play", "a"}, folder.path()), table.back()[hash]);
  EXPECT_EQ(hash_of({"--play", "a", "2"}, folder.path()), table[2][hash]);
  EXPECT_EQ(hash_of({"--play", "a", "best_1"}, folder.path()), table[1][hash]);
  EXPECT_EQ(hash_of({"--play", folder.path() + "/a", "best_1"}, "/"), table[1][hash]);  // from another folder
  const auto expect_fault = [&](std::vector<std::string> words, int code, const std::string& message) {
    const RunResult result = run(std::move(words), folder.path());
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  expect_fault({"evolve", "--play", "a", "99"}, 2, "there is no elite '99'");
  expect_fault({"evolve", "--play", "b"}, 1, "b/state.json");
  expect_fault({"evolve", "--play", "a", "2", "--fest"}, 2, "did you mean '--fast'?");
  folder.file("b/state.json", content(folder.path() + "/a/state.json").substr(0, 300));
  expect_fault({"evolve", "--play", "b"}, 1, "b/state.json: the file is damaged");
}

TEST(Evolve, WrongObjectivesAreExplained) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const auto expect_fault = [&](std::vector<std::string> words, const std::string& message) {
    words.insert(words.begin(), {"evolve", "push.lua"});
    const RunResult result = run(std::move(words), folder.path());
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  expect_fault({"--maximize", "distance", "--minimize", "distance"}, "the result distance is an objective twice");
  expect_fault({"--maximize", "distance", "--minimize", "noise", "--descriptor", "distance"},
               "a search for variety has one objective");
  expect_fault({"--maximize", "distance", "--minimize", "noise", "--algorithm", "cma-es"},
               "use nsga2, maco or nspso for several");
  expect_fault({"--maximize", "distance", "--minimize", "noise", "--algorithm", "pso"}, "it has one objective only");
  expect_fault({"--maximize", "distance", "--algorithm", "nspso"}, "it needs several objectives");
  expect_fault({"--maximize", "distance", "--algorithm", "gaco", "--population", "1001"}, "of gaco at most 1000");
  expect_fault({"--maximize", "distance", "--algorithm", "pso", "--population", "100", "--generations", "10001"},
               "pso evaluates at most 1000000 individuals");
  expect_fault({"--maximize", "distance", "--algorithm", "map-elites"}, "name its descriptors");
  expect_fault({"--maximize", "distance", "--descriptor", "distance", "--algorithm", "nsga2"},
               "only map-elites has descriptors");
  expect_fault({"--maximize", "distance", "--minimize", "noise", "--population", "1001"}, "of nsga2 at most 1000");
  const RunResult result = run({"evolve", "--maximize", "distance"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("name the scene"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test

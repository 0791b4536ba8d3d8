// limber evolve with the algorithms of the module limber-pagmo.so.
#include <string>
#include <vector>

#include "app/evolve_kills.h"
#include "app/push_scene.h"

namespace limber::app::test {
namespace {

RunResult evolve_push(const TempFolder& folder, const std::string& algorithm, const std::string& out,
                      std::vector<std::string> more) {
  std::vector<std::string> words{"evolve",     "push.lua", "--maximize",   "distance", "--algorithm", algorithm,
                                 "--duration", "1",        "--population", "6",        "--out",       out};
  if (algorithm == "maco" || algorithm == "nspso") words.insert(words.end(), {"--minimize", "noise"});
  words.insert(words.end(), more.begin(), more.end());
  return run(words, folder.path());
}

TEST(EvolvePagmo, ArchiveIsTheSameAfterAnyInterruption) {
  for (const std::string algorithm : {"gaco", "pso", "maco", "nspso"}) {
    const TempFolder folder;
    folder.file("push.lua", kPush);
    const RunResult whole = evolve_push(folder, algorithm, "whole", {"--generations", "6", "--jobs", "2"});
    ASSERT_EQ(whole.code, 0) << whole.err;
    ASSERT_EQ(evolve_push(folder, algorithm, "parts", {"--generations", "1"}).code, 0);
    ASSERT_EQ(evolve_push(folder, algorithm, "parts", {"--generations", "3", "--jobs", "3", "--resume"}).code, 0);
    ASSERT_EQ(evolve_push(folder, algorithm, "parts", {"--generations", "6", "--jobs", "1", "--resume"}).code, 0);
    for (const char* name : {"elites.csv", "elites.presets.json", "state.json"}) {
      const std::string text = content(folder.path() + "/whole/" + name);
      EXPECT_FALSE(text.empty()) << name;
      EXPECT_TRUE(text == content(folder.path() + "/parts/" + name)) << algorithm << " " << name;
    }
    const std::vector<Row> table = rows(content(folder.path() + "/whole/elites.csv"));
    ASSERT_GT(table.size(), 1u);
    EXPECT_EQ(table[1][1], algorithm == "gaco" || algorithm == "pso" ? "best_1" : "front_1");
    // the optimum is 8
    EXPECT_GT(std::stod((algorithm == "gaco" || algorithm == "pso" ? table.back() : table[1])[4]), 4) << algorithm;
  }
}

TEST(EvolvePagmo, SurvivesKills) {
  KilledSearch search(14, {"--algorithm", "pso"});
  search.run_whole();
  search.run_with_killed_children(4);
  search.expect_same("children");
  search.run_with_killed_jobs(2);
  search.expect_same("jobs");
}

// An installation without the module names it, and plays elites that were found with it.
TEST(EvolvePagmo, WithoutTheModule) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  ASSERT_EQ(evolve_push(folder, "pso", "found", {"--generations", "3"}).code, 0);
  const std::string program = install_copy(folder);
  const RunResult searched =
      Process({program, "evolve", "push.lua", "--maximize", "distance", "--algorithm", "pso"}, folder.path()).finish();
  EXPECT_EQ(searched.code, 2);
  EXPECT_NE(searched.err.find("--algorithm pso: the module limber-pagmo.so is not beside " + program +
                              ". Install libpagmo-dev and build Limber again"),
            std::string::npos)
      << searched.err;
  const RunResult played =
      Process({program, "evolve", "--play", "found", "--fast", "--duration", "1", "--hash"}, folder.path()).finish();
  EXPECT_EQ(played.code, 0) << played.err;
  const std::vector<Row> table = rows(content(folder.path() + "/found/elites.csv"));
  const std::string& hash = table.back()[table[0].size() - 2];
  EXPECT_NE(played.out.find("hash " + hash), std::string::npos) << played.out << " expected " << hash;
}

}  // namespace
}  // namespace limber::app::test

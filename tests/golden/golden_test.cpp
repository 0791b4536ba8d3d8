// Each golden scene reaches the hash in hashes.txt for any number of threads, and the recorded show replays to its
// hash. LIMBER_GOLDEN_OUT=FILE appends lines "name ticks hash threads" to that file. LIMBER_GOLDEN_RECORD=FILE
// records the show to this file.
#include "golden/golden.h"
#include "support/skip.h"

namespace limber::golden {
namespace {

constexpr const char* kShow = "show.take";

void print_line(const std::string& name, const Outcome& outcome, int threads) {
  const char* const file = std::getenv("LIMBER_GOLDEN_OUT");
  if (file == nullptr) return;
  std::ofstream(file, std::ios::app) << fmt::format("{} {} {}\n", name, text_of(outcome), threads);
}

void compare(const std::string& name, const Outcome& outcome, int threads) {
  print_line(name, outcome, threads);
  const std::map<std::string, Outcome> golden = golden_hashes();
  ASSERT_TRUE(golden.contains(name)) << name << " is missing in hashes.txt; this machine's line:\n"
                                     << name << " " << text_of(outcome);
  EXPECT_EQ(text_of(outcome), text_of(golden.at(name)))
      << "scene '" << name << "', " << threads << " threads: ticks and hash differ from tests/golden/hashes.txt";
}

class Golden : public ::testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(Golden, HashIsTheSame) {
  const auto& [name, threads] = GetParam();
  ScenePlay play("scenes/" + name + ".lua", threads);
  const Outcome outcome = play.play();
  compare(name, outcome, threads);
  if (threads == 1 && play.records_take()) {
    EXPECT_EQ(text_of(replay(play.take_path(), threads)), text_of(outcome)) << name << ": replay of its take";
  }
}

std::string name_of(const ::testing::TestParamInfo<Golden::ParamType>& info) {
  return fmt::format("{}_{}", std::get<0>(info.param), std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden,
                         ::testing::Combine(::testing::ValuesIn(scene_names()), ::testing::Values(1, 2, 3)), name_of);

TEST(GoldenShow, TakeReplaysToItsHash) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests replay takes");
  if (const char* const file = std::getenv("LIMBER_GOLDEN_RECORD")) {
    ScenePlay show("show.lua", 1);
    show.play();
    fs::copy_file(show.take_path(), file, fs::copy_options::overwrite_existing);
  }
  for (const int threads : {1, 2, 3}) compare(kShow, replay((kFolder / kShow).string(), threads), threads);
}

TEST(GoldenTable, NamesEveryScene) {
  std::vector<std::string> named;
  for (const auto& [name, outcome] : golden_hashes()) named.push_back(name);
  std::vector<std::string> all = scene_names();
  all.emplace_back(kShow);
  std::sort(all.begin(), all.end());
  EXPECT_EQ(named, all);
  EXPECT_GE(named.size(), 50u);
}

}  // namespace
}  // namespace limber::golden

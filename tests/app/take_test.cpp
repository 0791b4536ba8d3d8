// Takes from the command line: record, info and replay, also after a kill.
#include <filesystem>

#include "app/program.h"
#include "base/random.h"
#include "support/skip.h"

namespace limber::app::test {
namespace {

constexpr const char* kTakeScene = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 4 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 0.5 * i) }) end
sim:every(0.2, function() sim:body("ball1").parts[1]:apply_impulse(rng:direction() * 0.01) end)
)";

std::string last_line(const std::string& text, const std::string& start) {
  const std::size_t at = text.rfind(start);
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

TEST(TakeApp, ReplaysToTheRecordedHash) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kTakeScene);
  const std::string take = folder.path() + "/s.take";
  const RunResult recorded = run({scene, "--fast", "--ticks", "150", "--seed", "5", "--set", "/physics/sim/substeps=3",
                                  "--record", take, "--hash"});
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const std::string hash = last_line(recorded.out, "hash ");
  ASSERT_TRUE(hash.ends_with(" tick 150")) << recorded.out;
  const RunResult info = run({"take", "info", take});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("ticks     150\n"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("end       complete; " + hash + "\n"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find(scene), std::string::npos);
  // the current content of the scene file must not matter
  folder.file("s.lua", "error('another one')\n");
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--fast"}, {"--osc-in", "off", "--osc-out", "off", "--query", "off"}}) {
    std::vector<std::string> args = {"--replay", take, "--hash"};
    args.insert(args.end(), how.begin(), how.end());
    const RunResult again = run(args);
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(last_line(again.out, "hash "), hash);
    EXPECT_NE(again.err.find("replayed 150 ticks: all hashes match the take\n"), std::string::npos) << again.err;
  }
}

TEST(TakeApp, CurrentScriptsReportTheDivergence) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kTakeScene);
  const std::string take = folder.path() + "/s.take";
  ASSERT_EQ(run({scene, "--fast", "--ticks", "60", "--record", take}).code, 0);
  folder.file("s.lua", std::string(kTakeScene) +
                           "sim:at(0.5, function() sim:body('ball3').parts[1]:apply_impulse(vec3(0, 0, 1)) end)\n");
  const RunResult again = run({"--replay", take, "--fast", "--with-current-scripts"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.err.find("diverged at tick 31; the first body that differs is 'ball3'"), std::string::npos)
      << again.err;
}

TEST(TakeApp, ReplaysAKilledShowToItsLastTick) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kTakeScene);
  const std::string take = folder.path() + "/s.take";
  {
    Process running(limber_command({scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--record", take}));
    ASSERT_TRUE(running.wait_for("tick ")) << running.err();  // a status line: a second has passed
    running.signal(SIGKILL);
  }
  const RunResult again = run({"--replay", take, "--fast"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.err.find("all hashes match the take; the take was cut off there\n"), std::string::npos) << again.err;
  EXPECT_NE(run({"take", "info", take}).out.find("end       cut off after tick "), std::string::npos);
}

TEST(TakeApp, ReplaysAShowKilledAtAnyTime) {
  Random random(1, "kills");
  for (int i = 0; i < 8; i++) {
    const TempFolder folder;
    const std::string scene =
        folder.file("s.lua", std::string(kTakeScene) + "sim:on_step(function() print('at ' .. sim.tick) end)\n");
    const std::string take = folder.path() + "/s.take";
    const auto wanted = static_cast<std::uintmax_t>(random.uniform(4000, 120000));
    Process running(limber_command({scene, "--fast", "--record", take}));
    // waits until the file has reached a given size
    std::error_code none;
    for (int at = 0; !std::filesystem::exists(take, none) || std::filesystem::file_size(take) < wanted; at += 400)
      ASSERT_TRUE(running.wait_for(fmt::format("at {}\n", at), true)) << running.err();
    running.signal(SIGKILL);
    running.finish();
    const RunResult info = run({"take", "info", take});
    EXPECT_EQ(info.code, 0) << info.err;
    const std::string last = last_line(info.out, "end       cut off after tick ");
    ASSERT_FALSE(last.empty()) << info.out;
    const std::string ticks = last.substr(29, last.find(',') - 29);
    EXPECT_GT(std::stoi(ticks), 0) << last;
    const RunResult again = run({"--replay", take, "--fast"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.err.find("replayed " + ticks + " ticks: all hashes match the take; the take was cut off there\n"),
              std::string::npos)
        << again.err;
  }
}

TEST(TakeApp, FullDiskEndsTheTakeNotTheShow) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", kTakeScene);
  const std::string take = folder.path() + "/s.take";
  const std::string command =
      fmt::format("ulimit -f 8; exec {} {} --fast --ticks 3000 --record {}", LIMBER_PROGRAM, scene, take);
  const RunResult recorded = Process({"/bin/sh", "-c", command}).finish();
  EXPECT_EQ(recorded.code, 0) << recorded.err;
  EXPECT_NE(recorded.err.find("s.take: the take ends here, writing failed: File too large\n"), std::string::npos)
      << recorded.err;
  const RunResult again = run({"--replay", take, "--fast"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.err.find("all hashes match the take; the take was cut off there\n"), std::string::npos) << again.err;
}

}  // namespace
}  // namespace limber::app::test

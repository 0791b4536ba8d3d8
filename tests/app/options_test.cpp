// The command line: help, version, and suggestions for mistyped words.
#include "app/program.h"

namespace limber::app::test {
namespace {

TEST(Options, HelpShowsExamples) {
  const RunResult result = run({"--help"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
  for (const char* taught :
       {"scripts/arms.lua", "oscsend", "--fast --duration 10 --hash", "play", "inspect", "describe", "bench", "doctor",
        "console", "annotate", "limber new show", "console -e sim.time",
        "Exit codes: 0 success; 1 invalid input (such as a scene); 2 wrong usage;"}) {
    EXPECT_NE(result.out.find(taught), std::string::npos) << taught;
  }
}

TEST(Options, EachCommandHasHelp) {
  for (const char* command : {"play", "console", "new", "inspect", "describe", "bench", "annotate", "doctor"}) {
    const RunResult result = run({command, "--help"});
    EXPECT_EQ(result.code, 0) << command;
    EXPECT_NE(result.out.find("--help"), std::string::npos) << command;
  }
  const std::string play = run({"play", "--help"}).out;
  for (const char* option :
       {"--headless", "--fast", "--duration", "--ticks", "--seed", "--threads", "--set", "--osc-in", "--osc-allow",
        "--osc-out", "--query", "--osc-optional", "--package-path", "--strict", "--hash"}) {
    EXPECT_NE(play.find(option), std::string::npos) << option;
  }
}

TEST(Options, Version) {
  const RunResult result = run({"--version"});
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.out.starts_with("limber 0.")) << result.out;
}

TEST(Options, PlayIsTheDefaultCommand) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "print('played')\n");
  for (const std::vector<std::string>& args : {std::vector<std::string>{scene, "--fast", "--ticks", "1"},
                                               {"play", scene, "--fast", "--ticks", "1"},
                                               {"--fast", "--ticks", "1", scene},
                                               {"--headless", "--fast", "--ticks", "1", scene}}) {
    const RunResult result = run(args);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out, "played\n");
  }
}

TEST(Options, FindsScenesHereAndInTheDataFolder) {
  const TempFolder folder;
  folder.file("my.lua", "print('here')\n");
  EXPECT_EQ(run({"my.lua", "--fast", "--ticks", "1"}, folder.path()).out, "here\n");
  const std::string program = install_copy(folder);
  const RunResult result = Process({program, "scripts/far.lua", "--fast", "--ticks", "1"}, "/").finish();
  EXPECT_EQ(result.out, "far\n") << result.err;
}

}  // namespace
}  // namespace limber::app::test

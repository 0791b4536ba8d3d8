// The command line: help that teaches, the version, near words for mistyped ones.
#include "app/program.h"

namespace limber::app_test {
namespace {

TEST(Options, HelpTeaches) {
  const Ran ran = run({"--help"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.err, "");
  for (const char* taught : {"scripts/arms.lua", "oscsend", "--fast --duration 10 --hash", "play", "inspect",
                             "describe", "bench", "doctor", "console", "annotate", "limber new show",
                             "console -e sim.time", "Exit codes: 0 fine; 1 the input is at fault; 2 wrong usage; 3"}) {
    EXPECT_NE(ran.out.find(taught), std::string::npos) << taught;
  }
}

TEST(Options, EachCommandHasHelp) {
  for (const char* command : {"play", "console", "new", "inspect", "describe", "bench", "annotate", "doctor"}) {
    const Ran ran = run({command, "--help"});
    EXPECT_EQ(ran.code, 0) << command;
    EXPECT_NE(ran.out.find("--help"), std::string::npos) << command;
  }
  const std::string play = run({"play", "--help"}).out;
  for (const char* option :
       {"--headless", "--fast", "--duration", "--ticks", "--seed", "--threads", "--set", "--osc-in", "--osc-allow",
        "--osc-out", "--query", "--osc-optional", "--package-path", "--strict", "--hash"}) {
    EXPECT_NE(play.find(option), std::string::npos) << option;
  }
}

TEST(Options, Version) {
  const Ran ran = run({"--version"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_TRUE(ran.out.starts_with("limber 0.")) << ran.out;
}

TEST(Options, PlayIsLeftOut) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", "print('played')\n");
  for (const std::vector<std::string>& args : {std::vector<std::string>{scene, "--fast", "--ticks", "1"},
                                               {"play", scene, "--fast", "--ticks", "1"},
                                               {"--fast", "--ticks", "1", scene},
                                               {"--headless", "--fast", "--ticks", "1", scene}}) {
    const Ran ran = run(args);
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.out, "played\n");
  }
}

TEST(Options, ASceneIsFoundHereOrInTheProgramsData) {
  const Folder folder;
  folder.file("my.lua", "print('here')\n");
  EXPECT_EQ(run({"my.lua", "--fast", "--ticks", "1"}, folder.path()).out, "here\n");
  const std::string program = install_copy(folder);
  const Ran ran = Running({program, "scripts/far.lua", "--fast", "--ticks", "1"}, "/").finish();
  EXPECT_EQ(ran.out, "far\n") << ran.err;
}

}  // namespace
}  // namespace limber::app_test

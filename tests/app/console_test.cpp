// `limber console` without a terminal: one expression, lines from a pipe, and the choice of the program.
#include "app/playing.h"

namespace limber::app::test {
namespace {

constexpr const char* kApple = "apple = 3\nsim:on_start(function() print('played') end)\n";

TEST(Console, EvaluatesOneExpression) {
  Playing show(kApple);
  RunResult result = show.console({"-e", "apple + 1, 'x'"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, "4\tx\n");
  EXPECT_EQ(result.err, "");
  result = show.console({"-e", "apple = 10"});
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.code, 0);
  result = show.console({"--evaluate", "print('said') print(apple) return apple"});
  EXPECT_EQ(result.out, "said\n10\n10\n") << "its output, then its value";
  result = show.console({"-e", "sim.gravty"});
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err,
            "console:1: sim has no property 'gravty'; did you mean 'gravity'?\n  1 | sim.gravty\n"
            "stack traceback:\n  console:1: in the main chunk\n");
  result = show.console({"-e", "for i = 1, 2 do"});
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err, "limber: console: incomplete input: a block, bracket or string is not closed\n");
  EXPECT_TRUE(show.running().wait_for("said\n10\n", true)) << "print goes to the show's stdout as well";
}

TEST(Console, EvaluatesLinesFromAPipe) {
  Playing show(kApple);
  const RunResult fine =
      show.pipe("x = 1\n\nfunction twice(n)\n\n  return 2 * n\nend\r\ntwice(x)\nprint('by hand')\ntwice(4)");
  EXPECT_EQ(fine.out, "2\nby hand\n8\n");
  EXPECT_EQ(fine.err, "");
  EXPECT_EQ(fine.code, 0);
  const RunResult wrong = show.pipe("nothing\n1 + 1\nwarn('mind')\n");
  EXPECT_EQ(wrong.out, "2\n") << "the lines after an error are evaluated";
  EXPECT_EQ(wrong.code, 1);
  EXPECT_TRUE(wrong.err.starts_with("console:1: there is no global 'nothing'")) << wrong.err;
  EXPECT_TRUE(wrong.err.ends_with("\nlimber: warning: mind\n")) << wrong.err;
  const RunResult open = show.pipe("if apple then\n");
  EXPECT_EQ(open.code, 1);
  EXPECT_EQ(open.err, "limber: console: incomplete input at the end: a block, bracket or string is not closed\n");
  EXPECT_EQ(show.pipe("").code, 0);
}

TEST(Console, ListsProgramsIfSeveralRun) {
  Playing first(kApple);
  Process second(first.words({"play", first.file()}));
  ASSERT_TRUE(second.wait_for("playing headless")) << second.err();
  const RunResult result = first.console({"-e", "1"});
  EXPECT_EQ(result.code, 1);
  EXPECT_TRUE(result.err.starts_with("limber: console: 2 of your programs are running; choose one:\n  limber console "))
      << result.err;
  EXPECT_NE(result.err.find("\n  limber console " + first.pid() + "    " + first.file() + "\n"), std::string::npos)
      << result.err;
  EXPECT_EQ(first.console({first.pid(), "-e", "apple"}).out, "3\n");
  const RunResult none = first.console({"1", "-e", "apple"});
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(none.err.starts_with("limber: console: no running Limber program has the process id 1; there are:\n"))
      << none.err;
}

TEST(Console, ReportsThatNoProgramRuns) {
  Playing show(kApple);
  const std::string socket = show.runtime() / ("limber-" + show.pid() + ".sock");
  EXPECT_TRUE(std::filesystem::exists(socket));
  show.running().signal(SIGINT);
  EXPECT_EQ(show.running().finish().code, 0);
  EXPECT_FALSE(std::filesystem::exists(socket)) << "the socket is removed";
  const RunResult result = show.console({"-e", "1"});
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(
      result.err,
      "limber: console: no Limber program of this user is running; start one with `limber play`, without --fast\n");
}

TEST(Console, RemovesTheSocketOfAKilledShow) {
  Playing show(kApple);
  const std::string socket = show.runtime() / ("limber-" + show.pid() + ".sock");
  show.running().signal(SIGKILL);
  show.running().finish();
  EXPECT_TRUE(std::filesystem::exists(socket));
  Process next(show.words({"play", show.file()}));
  ASSERT_TRUE(next.wait_for("playing headless"));
  EXPECT_FALSE(std::filesystem::exists(socket));
  EXPECT_EQ(show.console({"-e", "apple"}).out, "3\n");
}

TEST(Console, ShowPlaysWithoutARuntimeFolder) {
  const console::PrivateFolder runtime;
  std::filesystem::permissions(runtime.path(), std::filesystem::perms::all);
  std::ofstream(runtime / ("limber-" + std::to_string(geteuid()))) << "no folder";
  const TempFolder folder;
  Process running(
      limber_command({"play", folder.file("s.lua", kApple), "--osc-in", "off", "--osc-out", "off", "--query", "off"},
                     {"env", "XDG_RUNTIME_DIR=" + runtime.path(), "TMPDIR=" + runtime.path()}));
  EXPECT_TRUE(running.wait_for("playing headless"));
  EXPECT_NE(running.err().find("limber: warning: console not available, retrying: the folder " + runtime.path()),
            std::string::npos)
      << running.err();
}

TEST(Console, BatchRunsHaveNoConsole) {
  const TempFolder folder;
  const RunResult result = run({folder.file("s.lua", kApple), "--fast", "--ticks", "2"});
  EXPECT_EQ(result.err.find("console"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test

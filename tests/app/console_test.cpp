// `limber console` without a terminal: one expression, lines of a pipe, and which program is meant.
#include "app/playing.h"

namespace limber::app_test {
namespace {

constexpr const char* kApple = "apple = 3\nsim:on_start(function() print('played') end)\n";

TEST(Console, OneExpression) {
  Playing show(kApple);
  Ran ran = show.console({"-e", "apple + 1, 'x'"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.out, "4\tx\n");
  EXPECT_EQ(ran.err, "");
  ran = show.console({"-e", "apple = 10"});
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.code, 0);
  ran = show.console({"--evaluate", "print('said') print(apple) return apple"});
  EXPECT_EQ(ran.out, "said\n10\n10\n") << "what it printed, then its value";
  ran = show.console({"-e", "sim.gravty"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.err,
            "console:1: sim has no property 'gravty'; did you mean 'gravity'?\n  1 | sim.gravty\n"
            "stack traceback:\n  console:1: in the main chunk\n");
  ran = show.console({"-e", "for i = 1, 2 do"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.err, "limber: console: the text is not complete: something that it opens is never closed\n");
  EXPECT_TRUE(show.running().wait_for("said\n10\n", true)) << "print goes to the show's stdout as well";
}

TEST(Console, LinesOfAPipe) {
  Playing show(kApple);
  const Ran fine =
      show.pipe("x = 1\n\nfunction twice(n)\n\n  return 2 * n\nend\r\ntwice(x)\nprint('by hand')\ntwice(4)");
  EXPECT_EQ(fine.out, "2\nby hand\n8\n");
  EXPECT_EQ(fine.err, "");
  EXPECT_EQ(fine.code, 0);
  const Ran wrong = show.pipe("nothing\n1 + 1\nwarn('mind')\n");
  EXPECT_EQ(wrong.out, "2\n") << "the lines after an error are evaluated";
  EXPECT_EQ(wrong.code, 1);
  EXPECT_TRUE(wrong.err.starts_with("console:1: there is no global 'nothing'")) << wrong.err;
  EXPECT_TRUE(wrong.err.ends_with("\nlimber: warning: mind\n")) << wrong.err;
  const Ran open = show.pipe("if apple then\n");
  EXPECT_EQ(open.code, 1);
  EXPECT_EQ(open.err, "limber: console: the input ends in the middle: something that it opens is never closed\n");
  EXPECT_EQ(show.pipe("").code, 0);
}

TEST(Console, WithSeveralItSaysHowToChoose) {
  Playing first(kApple);
  Running second(first.words({"play", first.file()}));
  ASSERT_TRUE(second.wait_for("playing headless")) << second.err();
  const Ran ran = first.console({"-e", "1"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_TRUE(ran.err.starts_with("limber: console: 2 of your programs are running; choose one:\n  limber console "))
      << ran.err;
  EXPECT_NE(ran.err.find("\n  limber console " + first.pid() + "    " + first.file() + "\n"), std::string::npos)
      << ran.err;
  EXPECT_EQ(first.console({first.pid(), "-e", "apple"}).out, "3\n");
  const Ran none = first.console({"1", "-e", "apple"});
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(none.err.starts_with("limber: console: no limber of yours has the number 1; there are:\n")) << none.err;
}

TEST(Console, WithoutAShowThereIsNobodyToTalkTo) {
  Playing show(kApple);
  const std::string socket = show.runtime() / ("limber-" + show.pid() + ".sock");
  EXPECT_TRUE(std::filesystem::exists(socket));
  show.running().signal(SIGINT);
  EXPECT_EQ(show.running().finish().code, 0);
  EXPECT_FALSE(std::filesystem::exists(socket)) << "it takes its socket along";
  const Ran ran = show.console({"-e", "1"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.err,
            "limber: console: no limber of yours is running; start one with `limber play`, without --fast, first\n");
}

TEST(Console, AKilledShowsSocketIsRemovedByTheNext) {
  Playing show(kApple);
  const std::string socket = show.runtime() / ("limber-" + show.pid() + ".sock");
  show.running().signal(SIGKILL);
  show.running().finish();
  EXPECT_TRUE(std::filesystem::exists(socket));
  Running next(show.words({"play", show.file()}));
  ASSERT_TRUE(next.wait_for("playing headless"));
  EXPECT_FALSE(std::filesystem::exists(socket));
  EXPECT_EQ(show.console({"-e", "apple"}).out, "3\n");
}

TEST(Console, AShowWithoutAFolderForItPlaysOn) {
  const PrivateFolder runtime;
  std::filesystem::permissions(runtime.path(), std::filesystem::perms::all);
  std::ofstream(runtime / ("limber-" + std::to_string(geteuid()))) << "no folder";
  const Folder folder;
  Running running(
      limber({"play", folder.file("s.lua", kApple), "--osc-in", "off", "--osc-out", "off", "--query", "off"},
             {"env", "XDG_RUNTIME_DIR=" + runtime.path(), "TMPDIR=" + runtime.path()}));
  EXPECT_TRUE(running.wait_for("playing headless"));
  EXPECT_NE(running.err().find("limber: warning: there is no console, it is tried again: the folder " + runtime.path()),
            std::string::npos)
      << running.err();
}

TEST(Console, BatchesHaveNone) {
  const Folder folder;
  const Ran ran = run({folder.file("s.lua", kApple), "--fast", "--ticks", "2"});
  EXPECT_EQ(ran.err.find("console"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace limber::app_test

// The console history: saved at once, bounded, and robust against damaged files.
#include "app/console/history.h"

#include "app/program.h"
#include "base/random.h"
#include "console/private_folder.h"

namespace limber::app::test {
namespace {

using Lines = std::vector<std::string>;

TEST(ConsoleHistory, SavesLinesForLaterConsoles) {
  const console::PrivateFolder folder;
  const std::string file = folder / "state/limber/console_history";
  ConsoleHistory first(file);
  EXPECT_TRUE(first.lines().empty());
  for (const char* line : {"sim.time", "sim.time", "  ", "", "x = 'ä'", "two\nlines", "\x1b[31m", "sim.time"})
    first.add(line);
  const Lines expected = {"sim.time", "x = 'ä'", "sim.time"};
  EXPECT_EQ(first.lines(), expected) << "no blank lines, no repetitions, no control sequences";
  EXPECT_EQ(ConsoleHistory(file).lines(), expected);
  // two consoles at the same time
  ConsoleHistory other(file);
  first.add("one");
  other.add("another");
  EXPECT_EQ(ConsoleHistory(file).lines(), (Lines{"sim.time", "x = 'ä'", "sim.time", "one", "another"}));
  EXPECT_EQ(std::filesystem::status(file).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST(ConsoleHistory, IsBounded) {
  const console::PrivateFolder folder;
  const std::string file = folder / "h";
  std::string much;
  for (int i = 1; i <= 5000; i++) much += "line " + std::to_string(i) + "\n";
  std::ofstream(file) << much;
  ConsoleHistory history(file);
  ASSERT_EQ(history.lines().size(), ConsoleHistory::kMaxLines);
  EXPECT_EQ(history.lines().front(), "line 4001");
  EXPECT_EQ(history.lines().back(), "line 5000");
  EXPECT_EQ(content(file).size(), 1000 * std::string("line 4001\n").size()) << "old lines are removed from the file";
  history.add("new");
  EXPECT_EQ(history.lines().size(), ConsoleHistory::kMaxLines);
  history.add(std::string(ConsoleHistory::kMaxLineBytes + 1, 'x'));
  EXPECT_EQ(history.lines().back(), "new");
}

TEST(ConsoleHistory, ReadsTheValidLinesOfADamagedFile) {
  const console::PrivateFolder folder;
  const std::string file = folder / "h";
  std::ofstream(file, std::ios::binary) << "good\n\xff\xfe\x80\n"
                                        << std::string(3, '\0') << "\n\x1b[2J\nalso good\ncut";
  EXPECT_EQ(ConsoleHistory(file).lines(), (Lines{"good", "also good", "cut"}));
  Random random(3, "history");
  for (int i = 0; i < 200; i++) {
    std::string bytes;
    for (int k = 0; k < 500; k++) bytes += static_cast<char>(static_cast<int>(random.uniform() * 256));
    std::ofstream(file, std::ios::binary) << bytes << "\nlast\n";
    ConsoleHistory history(file);
    ASSERT_FALSE(history.lines().empty());
    EXPECT_EQ(history.lines().back(), "last");
  }
}

TEST(ConsoleHistory, WorksWithoutAFile) {
  for (const std::string& file : {std::string(), std::string("/proc/nowhere/h"), std::string("/")}) {
    ConsoleHistory history(file);
    history.add("x");
    EXPECT_EQ(history.lines(), Lines{"x"}) << file;
  }
}

TEST(ConsoleHistory, IsInTheStateFolder) {
  const console::Environment home("HOME", "/home/somebody");
  {
    const console::Environment state("XDG_STATE_HOME", "/somewhere");
    EXPECT_EQ(ConsoleHistory::default_file(), "/somewhere/limber/console_history");
  }
  const console::Environment state("XDG_STATE_HOME", nullptr);
  EXPECT_EQ(ConsoleHistory::default_file(), "/home/somebody/.local/state/limber/console_history");
  const console::Environment none("HOME", nullptr);
  EXPECT_EQ(ConsoleHistory::default_file(), "");
}

}  // namespace
}  // namespace limber::app::test

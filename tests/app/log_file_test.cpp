// --log and --quiet.
#include <regex>

#include "app/program.h"

namespace limber::app::test {
namespace {

constexpr const char* kLoggedScene = R"(
print("hello")
sim:after(0.1, function() error("lost") end)
)";

RunResult play_logged(const std::string& scene, std::vector<std::string> more) {
  more.insert(more.begin(),
              {"play", scene, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off", "--ticks", "30"});
  return run(std::move(more));
}

TEST(Log, ContainsEveryMessageWithItsTime) {
  const TempFolder folder;
  const std::string file = folder.path() + "/show.log";
  const RunResult result = play_logged(folder.file("s.lua", kLoggedScene), {"--log", file});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("limber: playing headless"), std::string::npos) << "standard error stays as it is";
  const std::string log = content(file);
  const std::string time = "\\d{4}-\\d\\d-\\d\\d \\d\\d:\\d\\d:\\d\\d\\.\\d{3}[+-]\\d{4} ";
  for (const char* line : {"limber 0", "print: hello", "playing headless", "error: .*s\\.lua:3: lost"})
    EXPECT_TRUE(std::regex_search(log, std::regex("(^|\n)" + time + line))) << line << "\n" << log;
  EXPECT_EQ(log.find("real time"), std::string::npos) << "no status lines: " << log;
}

TEST(Log, MissingFolderIsAnErrorAtStart) {
  const TempFolder folder;
  const RunResult result = play_logged(folder.file("s.lua", kLoggedScene), {"--log", folder.path() + "/none/show.log"});
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("none/show.log can't be written: No such file or directory"), std::string::npos)
      << result.err;
  EXPECT_EQ(result.out, "");
}

TEST(Log, IsRotated) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "for i = 1, 100 do print(string.rep('x', 30)) end\n");
  const std::string file = folder.path() + "/show.log";
  EXPECT_EQ(play_logged(scene, {"--log", file, "--log-size", "0.001", "--log-keep", "2"}).code, 0);
  for (const char* number : {"", ".1", ".2"}) {
    EXPECT_GT(content(file + number).size(), 0U) << number;
    EXPECT_LE(content(file + number).size(), 1000U) << number;
  }
  EXPECT_FALSE(std::filesystem::exists(file + ".3"));
}

TEST(Log, QuietPrintsOnlyWarningsAndErrors) {
  const TempFolder folder;
  const std::string file = folder.path() + "/show.log";
  const RunResult result = play_logged(folder.file("s.lua", kLoggedScene), {"--quiet", "--log", file});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, "hello\n") << "output of scripts is a result";
  EXPECT_NE(result.err.find("limber: error: "), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("playing headless"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("real time"), std::string::npos) << result.err;
  EXPECT_NE(content(file).find("playing headless"), std::string::npos);
  const RunResult missing = run({"play", folder.path() + "/none.lua", "--quiet"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.err.find("not found; searched "), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace limber::app::test

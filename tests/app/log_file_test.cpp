// --log and --quiet.
#include <regex>

#include "app/program.h"

namespace limber::app_test {
namespace {

constexpr const char* kLoggedScene = R"(
print("hello")
sim:after(0.1, function() error("lost") end)
)";

Ran play_logged(const std::string& scene, std::vector<std::string> more) {
  more.insert(more.begin(),
              {"play", scene, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off", "--ticks", "30"});
  return run(std::move(more));
}

TEST(Log, GetsEveryMessageWithItsTime) {
  const Folder folder;
  const std::string file = folder.path() + "/show.log";
  const Ran ran = play_logged(folder.file("s.lua", kLoggedScene), {"--log", file});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.err.find("limber: playing headless"), std::string::npos) << "standard error stays as it is";
  const std::string log = content(file);
  const std::string time = "\\d{4}-\\d\\d-\\d\\d \\d\\d:\\d\\d:\\d\\d\\.\\d{3}[+-]\\d{4} ";
  for (const char* line : {"limber 0", "print: hello", "playing headless", "error: .*s\\.lua:3: lost"})
    EXPECT_TRUE(std::regex_search(log, std::regex("(^|\n)" + time + line))) << line << "\n" << log;
  EXPECT_EQ(log.find("real time"), std::string::npos) << "no status lines: " << log;
}

TEST(Log, AMissingFolderIsAnErrorAtTheStart) {
  const Folder folder;
  const Ran ran = play_logged(folder.file("s.lua", kLoggedScene), {"--log", folder.path() + "/none/show.log"});
  EXPECT_EQ(ran.code, 3);
  EXPECT_NE(ran.err.find("none/show.log can't be written: No such file or directory"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.out, "");
}

TEST(Log, IsRotated) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", "for i = 1, 100 do print(string.rep('x', 30)) end\n");
  const std::string file = folder.path() + "/show.log";
  EXPECT_EQ(play_logged(scene, {"--log", file, "--log-size", "0.001", "--log-keep", "2"}).code, 0);
  for (const char* number : {"", ".1", ".2"}) {
    EXPECT_GT(content(file + number).size(), 0U) << number;
    EXPECT_LE(content(file + number).size(), 1000U) << number;
  }
  EXPECT_FALSE(std::filesystem::exists(file + ".3"));
}

TEST(Log, QuietLeavesWarningsAndErrors) {
  const Folder folder;
  const std::string file = folder.path() + "/show.log";
  const Ran ran = play_logged(folder.file("s.lua", kLoggedScene), {"--quiet", "--log", file});
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.out, "hello\n") << "what scripts print is a result";
  EXPECT_NE(ran.err.find("limber: error: "), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("playing headless"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("real time"), std::string::npos) << ran.err;
  EXPECT_NE(content(file).find("playing headless"), std::string::npos);
  const Ran missing = run({"play", folder.path() + "/none.lua", "--quiet"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.err.find("there is no scene"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace limber::app_test

// Resource limits of the system: the program plays, or reports the missing resource with exit code 3.
#include "app/program.h"

namespace limber::app::test {
namespace {

RunResult play_with(const std::string& limit) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "sim:add_body('b')\n");
  return Process({"prlimit", limit, LIMBER_PROGRAM, scene, "--headless", "--osc-in", "127.0.0.1:0", "--query",
                  "127.0.0.1:0", "--osc-out", "off", "--ticks", "3", "--hash"},
                 "/")
      .finish();
}

TEST(Starved, PlaysOrReportsTheDescriptorLimit) {
  bool played = false;
  for (int limit = 5; limit < 64; limit += limit < 40 ? 3 : 12) {
    const RunResult result = play_with("--nofile=" + std::to_string(limit));
    if (result.code == 0) {
      played = true;
      EXPECT_NE(result.out.find(" tick 3\n"), std::string::npos) << limit << result.out;
    } else {
      EXPECT_FALSE(played) << "it plays with fewer";
      EXPECT_EQ(result.code, 3) << limit << result.err;
      EXPECT_NE(result.err.find("more files and sockets can be opened"), std::string::npos) << limit << result.err;
    }
  }
  EXPECT_TRUE(played);
}

TEST(Starved, ReportsATooSmallStack) {
  const RunResult result = play_with("--stack=65536");
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("the stack is limited to 64 KiB"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test

// Limits of the system: the program plays, or says what is missing, with exit code 3.
#include "app/program.h"

namespace limber::app_test {
namespace {

Ran play_with(const std::string& limit) {
  const Folder folder;
  const std::string scene = folder.file("s.lua", "sim:add_body('b')\n");
  return Running({"prlimit", limit, LIMBER_PROGRAM, scene, "--headless", "--osc-in", "127.0.0.1:0", "--query",
                  "127.0.0.1:0", "--osc-out", "off", "--ticks", "3", "--hash"},
                 "/")
      .finish();
}

TEST(Starved, AnyNumberOfDescriptorsPlaysOrIsNamed) {
  bool played = false;
  for (int most = 5; most < 64; most += most < 40 ? 3 : 12) {
    const Ran ran = play_with("--nofile=" + std::to_string(most));
    if (ran.code == 0) {
      played = true;
      EXPECT_NE(ran.out.find(" tick 3\n"), std::string::npos) << most << ran.out;
    } else {
      EXPECT_FALSE(played) << "with fewer it did";
      EXPECT_EQ(ran.code, 3) << most << ran.err;
      EXPECT_NE(ran.err.find("more files and sockets can be opened"), std::string::npos) << most << ran.err;
    }
  }
  EXPECT_TRUE(played);
}

TEST(Starved, AStackThatIsTooSmallIsNamed) {
  const Ran ran = play_with("--stack=65536");
  EXPECT_EQ(ran.code, 3);
  EXPECT_NE(ran.err.find("the stack is limited to 64 KiB"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace limber::app_test

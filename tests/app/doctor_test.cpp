// `limber doctor`: a line for each finding, and 3 when what playing needs is missing.
#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app_test {
namespace {

TEST(Doctor, SaysWhatIsThere) {
  const Folder folder;
  const Ran ran = Running({install_copy(folder), "doctor", "--osc-in", "0", "--query", "0"}, "/").finish();
  for (const char* what : {"limber ", "system ", "data ", "ports ", "buffer ", "display "})
    EXPECT_NE(ran.out.find(what), std::string::npos) << what << "\n" << ran.out;
  EXPECT_NE(ran.out.find("ok   data       " + folder.path() + "/share/limber\n"), std::string::npos) << ran.out;
  EXPECT_EQ(ran.code, 0) << ran.out;
  EXPECT_EQ(ran.err, "");
}

TEST(Doctor, ATakenPortIsTheMachinesFault) {
  for (const auto& [kind, cure] : {std::pair(SOCK_DGRAM, "--osc-in"), std::pair(SOCK_STREAM, "--query")}) {
    const TakenPort taken(kind);
    const bool osc = kind == SOCK_DGRAM;
    const Ran ran = run({"doctor", "--osc-in", osc ? taken.number() : "0", "--query", osc ? "0" : taken.number()});
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.out.find("no   ports"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find(cure), std::string::npos) << "the cure: " << ran.out;
  }
}

}  // namespace
}  // namespace limber::app_test

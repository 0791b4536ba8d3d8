// `limber doctor`: one line per check, and exit code 3 if a requirement is missing.
#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app::test {
namespace {

TEST(Doctor, PrintsEveryCheck) {
  const TempFolder folder;
  const RunResult result = Process({install_copy(folder), "doctor", "--osc-in", "0", "--query", "0"}, "/").finish();
  for (const char* prefix : {"limber ", "system ", "data ", "ports ", "buffer ", "display "})
    EXPECT_NE(result.out.find(prefix), std::string::npos) << prefix << "\n" << result.out;
  EXPECT_NE(result.out.find("ok   data       " + folder.path() + "/share/limber\n"), std::string::npos) << result.out;
  EXPECT_EQ(result.code, 0) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST(Doctor, PortInUseIsExitCode3) {
  for (const auto& [kind, cure] : {std::pair(SOCK_DGRAM, "--osc-in"), std::pair(SOCK_STREAM, "--query")}) {
    const PortInUse port_in_use(kind);
    const bool osc = kind == SOCK_DGRAM;
    const RunResult result =
        run({"doctor", "--osc-in", osc ? port_in_use.port() : "0", "--query", osc ? "0" : port_in_use.port()});
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.out.find("fail ports"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(cure), std::string::npos) << "the fix: " << result.out;
  }
}

}  // namespace
}  // namespace limber::app::test

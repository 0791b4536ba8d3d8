// `limber doctor`: a line for each finding, and 3 when what playing needs is missing.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "app/program.h"

namespace limber::app_test {
namespace {

// takes the default port unless somebody on this machine has it already; either way it is taken
class TakenDefaultPort {
 public:
  explicit TakenDefaultPort(int kind) : fd_(socket(AF_INET, kind | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(9003);
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)bind(fd_, reinterpret_cast<const sockaddr*>(&at), sizeof at);
    if (kind == SOCK_STREAM) (void)listen(fd_, 1);
  }
  ~TakenDefaultPort() { close(fd_); }
  TakenDefaultPort(const TakenDefaultPort&) = delete;
  TakenDefaultPort& operator=(const TakenDefaultPort&) = delete;

 private:
  int fd_;
};

TEST(Doctor, SaysWhatIsThere) {
  const Folder folder;
  const Ran ran = Running({install_copy(folder), "doctor"}, "/").finish();
  for (const char* what : {"limber ", "system ", "data ", "ports ", "buffer ", "display "})
    EXPECT_NE(ran.out.find(what), std::string::npos) << what << "\n" << ran.out;
  EXPECT_NE(ran.out.find("ok   data       " + folder.path() + "/share/limber\n"), std::string::npos) << ran.out;
  EXPECT_TRUE(ran.code == 0 || ran.out.find("no   ports") != std::string::npos) << ran.out;
  EXPECT_EQ(ran.err, "");
}

TEST(Doctor, ATakenPortIsTheMachinesFault) {
  for (const auto& [kind, cure] : {std::pair(SOCK_DGRAM, "--osc-in"), std::pair(SOCK_STREAM, "--query")}) {
    const TakenDefaultPort taken(kind);
    const Ran ran = run({"doctor"});
    EXPECT_EQ(ran.code, 3);
    EXPECT_NE(ran.out.find("no   ports"), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find(cure), std::string::npos) << "the cure: " << ran.out;
  }
}

}  // namespace
}  // namespace limber::app_test

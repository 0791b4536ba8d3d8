// Third-party clients control the running program and read its streams: liblo's oscsend and oscdump, and Pure Data.
#include <netinet/in.h>
#include <sys/socket.h>

#include "app/program.h"

namespace limber::app::test {
namespace {

// an arm with one hanging joint that prints the values it receives
constexpr const char* kHangingArm = R"(
local shape = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", shape, { mass = 0, position = vec3(1, 2, 3) })
arm:add_part("tip", shape, { position = vec3(1, 2, 2.5) })
arm:add_joint("elbow", "base", "tip", { position = vec3(1, 2, 3), axis = vec3(0, 1, 0) })
osc:on("/physics/part/friction", function() print("friction", arm:part("tip").friction) end)
osc:on("/physics/sim/gravity", function() print("gravity", sim.gravity.z) end)
)";

// returns a UDP port that is currently free; the client will open it
std::string free_port() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&at), size), 0);
  getsockname(fd, reinterpret_cast<sockaddr*>(&at), &size);
  close(fd);
  return std::to_string(ntohs(at.sin_port));
}

// the program on its own ports; `in`: its OSC input port
struct ArmPlayer {
  TempFolder folder;
  std::string out = free_port();
  Process running{
      limber_command({folder.file("s.lua", kHangingArm), "--osc-in", "127.0.0.1:0", "--osc-out", "127.0.0.1:" + out})};
  std::string in;

  ArmPlayer() {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    in = running.text_after("OSC in 127.0.0.1:");
  }
};

TEST(Clients, OscsendSetsValues) {
  ArmPlayer player;
  const std::string url = "osc.udp://127.0.0.1:" + player.in;
  EXPECT_EQ(Process({"oscsend", url, "/physics/part/friction", "ssf", "arm", "tip", "0.25"}).finish().code, 0);
  EXPECT_TRUE(player.running.wait_for("friction\t0.25\n", true)) << player.running.out();
  EXPECT_EQ(Process({"oscsend", url, "/physics/sim/gravity", "i", "-3"}).finish().code, 0);
  EXPECT_TRUE(player.running.wait_for("gravity\t-3\n", true)) << player.running.out();
}

TEST(Clients, OscdumpReadsTheStreams) {
  ArmPlayer player;
  Process dump({"stdbuf", "-oL", "oscdump", "-L", player.out});
  // the joint is at the base's center, which is fixed
  EXPECT_TRUE(dump.wait_for("/physics/joint/pos sfff \"arm\" 1.000000 2.000000 3.000000", true)) << dump.out();
  EXPECT_TRUE(dump.wait_for("/physics/joint/rot sffff \"arm\" ", true)) << dump.out();
  EXPECT_TRUE(dump.wait_for("/physics/joint/relrot sfff \"arm\" ", true)) << dump.out();
}

TEST(Clients, PureDataSendsReadsAndReceivesReplies) {
  ArmPlayer player;
  const std::string patch = std::string(LIMBER_SOURCE_DIR) + "/tests/app/play.pd";
  Process pd({"pd", "-nogui", "-nosound", "-noprefs", "-stderr", "-open", patch, "-send",
              "ports " + player.in + " " + player.out});
  EXPECT_TRUE(player.running.wait_for("gravity\t-3\n", true)) << player.running.out() << pd.err();
  EXPECT_TRUE(player.running.wait_for("friction\t0.75\n", true)) << player.running.out() << pd.err();
  EXPECT_TRUE(pd.wait_for("pos: arm 1 2 3")) << pd.err();
  EXPECT_TRUE(pd.wait_for("reply: list physics sim gravity 0 0 -3") || pd.wait_for("reply: physics sim gravity 0 0 -3"))
      << pd.err();
}

}  // namespace
}  // namespace limber::app::test

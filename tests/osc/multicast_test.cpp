// Multicast, in a network namespace of the test's own.
#include <gtest/gtest.h>

#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "base/system/net/udp_socket.h"
#include "support/skip.h"

namespace limber::system {
namespace {

constexpr std::uint32_t kLoopback = 0x7f000001;
constexpr std::uint32_t kGroup = 0xef010203;  // 239.1.2.3

enum Result : int { passed, no_namespace, not_opened, not_received, no_error };

bool enable_loopback() {
  const UdpSocket socket = std::move(open_udp({0, 0}).value());
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  return ioctl(socket.fd(), SIOCSIFFLAGS, &request) == 0;
}

// A child process runs it, with one thread.
int receive_in_own_namespace() {
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 || !enable_loopback()) return no_namespace;
  const std::array<std::uint32_t, 2> interfaces = {kLoopback, kLoopback};  // twice, as one with two addresses
  const auto first = open_multicast({kGroup, 9003}, interfaces);
  const auto second = open_multicast({kGroup, 9003}, interfaces);
  if (!first || !second) return not_opened;
  const UdpSocket sender = std::move(open_udp({kLoopback, 0}).value());
  send_multicast_from(sender.fd(), kLoopback);
  const std::array<char, 4> packet = {'/', 'a', 0, 0};
  if (send_datagram(sender.fd(), {kGroup, 9003}, packet) != 0) return not_received;
  for (const UdpSocket* const socket : {&*first, &*second}) {
    DatagramReader reader;
    const std::span<const Datagram> got = reader.read(socket->fd());  // on loopback, sending delivers
    if (got.size() != 1 || got[0].size != 4 || got[0].from != sender.local()) return not_received;
    const std::array<char, 4> answer = {'/', 'b', 0, 0};
    if (send_datagram(socket->fd(), got[0].from, answer) != 0) return not_received;
  }
  DatagramReader reader;
  if (reader.read(sender.fd()).size() != 2) return not_received;
  const std::array<std::uint32_t, 1> absent = {0x0a000001};
  return open_multicast({kGroup, 9003}, absent).ok() ? no_error : passed;
}

TEST(Multicast, SeveralProgramsReceiveAndAnswer) {
  LIMBER_SKIP_IF(kThreadSanitizer || is_emulated(), "it forks");
  const pid_t child = fork();
  if (child == 0) _exit(receive_in_own_namespace());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  LIMBER_SKIP_IF(WEXITSTATUS(status) == no_namespace, "this machine permits no network namespaces");
  EXPECT_EQ(WEXITSTATUS(status), passed);
}

}  // namespace
}  // namespace limber::system

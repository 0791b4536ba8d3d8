// Multicast, broadcast and shared ports, in network namespaces of the tests' own.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>

#include "base/system/net/interfaces.h"
#include "base/system/net/socket_address.h"
#include "base/system/net/udp_socket.h"
#include "base/system/wait.h"
#include "support/skip.h"

namespace limber::system {
namespace {

constexpr std::uint32_t kLoopback = 0x7f000001;
constexpr std::uint32_t kGroup = 0xef010203;  // 239.1.2.3

enum Result : int {
  passed,
  no_namespace,
  no_ipv6,
  no_broadcast_address,
  not_opened,
  not_sent,
  not_received,
  not_answered,
  received_twice,
  no_error
};

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
  const std::array<IpAddress, 2> interfaces = {kLoopback, kLoopback};  // twice, as one with two addresses
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
  const std::array<IpAddress, 1> absent = {0x0a000001};
  return open_multicast({kGroup, 9003}, absent).ok() ? no_error : passed;
}

// Adds a second address to the loopback interface of the namespace, with its network and broadcast address.
bool add_network(const char* address, const char* mask) {
  const UdpSocket socket = std::move(open_udp({0, 0}).value());
  const auto set = [&](unsigned long what, const char* text) {
    ifreq request{};
    std::strcpy(request.ifr_name, "lo:1");
    const sockaddr_in value = [&] {
      sockaddr_in of_text{};
      of_text.sin_family = AF_INET;
      of_text.sin_addr.s_addr = htonl(parse_ipv4(text).value());
      return of_text;
    }();
    std::memcpy(&request.ifr_addr, &value, sizeof value);
    return ioctl(socket.fd(), what, &request) == 0;
  };
  return set(SIOCSIFADDR, address) && set(SIOCSIFNETMASK, mask) && set(SIOCSIFBRDADDR, "10.9.8.255");
}

std::size_t count_received(const UdpSocket& socket) {
  DatagramReader reader;
  return reader.read(socket.fd()).size();
}

// A network that nothing else is in. It has a link-local address at once, and routes to groups, unlike loopback.
Descriptor add_tunnel() {
  Descriptor tunnel(open("/dev/net/tun", O_RDWR | O_CLOEXEC));
  const UdpSocket socket = std::move(open_udp({0, 0}).value());
  ifreq request{};
  std::strcpy(request.ifr_name, "limber0");
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (ioctl(tunnel.fd(), TUNSETIFF, &request) != 0) return {};
  request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_POINTOPOINT | IFF_NOARP | IFF_MULTICAST;
  if (ioctl(socket.fd(), SIOCSIFFLAGS, &request) != 0) return {};
  return tunnel;
}

// The system adds routes and addresses of a new network a little later.
bool send_when_up(UdpSender& sender, const Endpoint& to, std::span<const char> packet) {
  constexpr int kMaxTries = 2000;
  for (int tries = 0; tries < kMaxTries; tries++) {
    if (sender.send(to, packet) == 0) return true;
    (void)wait_ready({}, std::chrono::milliseconds(10));
  }
  return false;
}

// IPv6: the group is joined on the interface of its zone, or on all; link-local groups need a zone. A shared port that
// has not joined it gets nothing.
int receive_ipv6_in_own_namespace() {
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 || !enable_loopback()) return no_namespace;
  const Descriptor tunnel = add_tunnel();
  if (!tunnel.is_open() || !parse_ip("fe80::1%limber0")) return no_ipv6;
  const std::array<char, 4> packet = {'/', 'a', 0, 0};
  for (const char* text : {"ff02::7%limber0", "ff05::7"}) {
    const Endpoint group{parse_ip(text).value(), 9003};
    const auto first = open_multicast(group, {});
    const auto second = open_multicast(group, {});
    const auto other = open_udp({IpAddress(0, 0), 9003}, PortSharing::shared);
    if (!first || !second || !other) return not_opened;
    UdpSender sender;
    if (!sender.open()) return not_opened;
    Endpoint to = group;
    if (!group.ip.is_link_local()) to.ip = IpAddress(group.ip.high, group.ip.low, if_nametoindex("limber0"));
    if (!send_when_up(sender, to, packet)) return not_sent;
    for (const UdpSocket* const socket : {&*first, &*second}) {
      DatagramReader reader;
      const std::span<const Datagram> got = reader.read(socket->fd());
      if (got.size() != 1 || !ip_text(got[0].from.ip).ends_with("%limber0")) return not_received;
      if (send_datagram(socket->fd(), got[0].from, packet) != 0) return not_answered;
    }
    if (count_received(*other) != 0) return received_twice;
  }
  return open_multicast({parse_ip("ff02::7%4000").value(), 9003}, {}).ok() ? no_error : passed;
}

// All programs that share a port receive a broadcast, one of them a datagram to the machine; a group reaches only those
// that have joined it.
int share_in_own_namespace() {
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 || !enable_loopback() || !add_network("10.9.8.1", "255.255.255.0"))
    return no_namespace;
  const auto first = open_udp({0, 9003}, PortSharing::shared);
  const auto second = open_udp({0, 9003}, PortSharing::shared);
  if (!first || !second) return not_opened;
  if (open_udp({0, 9003}).ok()) return no_error;  // this one doesn't share
  UdpSender sender;
  if (!sender.open()) return not_opened;
  const std::array<char, 4> packet = {'/', 'a', 0, 0};
  bool connected = false;
  for (const Subnet& subnet : connected_subnets())
    connected = connected || subnet.broadcast() == IpAddress(0x0a0908ffU);
  if (!connected) return no_broadcast_address;
  if (sender.send({0x0a0908ffU, 9003}, packet) != 0) return not_sent;
  if (count_received(*first) != 1 || count_received(*second) != 1) return not_received;
  if (sender.send({0x0a090801U, 9003}, packet) != 0) return not_sent;
  if (count_received(*first) + count_received(*second) != 1) return received_twice;
  const std::array<IpAddress, 1> interfaces = {kLoopback};
  const auto group = open_multicast({kGroup, 9003}, interfaces);
  if (!group) return not_opened;
  const UdpSocket out = std::move(open_udp({kLoopback, 0}).value());
  send_multicast_from(out.fd(), kLoopback);
  if (send_datagram(out.fd(), {kGroup, 9003}, packet) != 0) return not_sent;
  if (count_received(*group) != 1) return not_received;
  return count_received(*first) + count_received(*second) == 0 ? passed : received_twice;
}

void expect_passes_in_child(int (*test)()) {
  LIMBER_SKIP_IF(kThreadSanitizer || is_emulated(), "it forks");
  const pid_t child = fork();
  if (child == 0) _exit(test());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  LIMBER_SKIP_IF(WEXITSTATUS(status) == no_namespace, "this machine permits no network namespaces");
  LIMBER_SKIP_IF(WEXITSTATUS(status) == no_ipv6, "this machine has no IPv6, or no /dev/net/tun");
  EXPECT_EQ(WEXITSTATUS(status), passed);
}

TEST(Multicast, SeveralProgramsReceiveAndAnswer) { expect_passes_in_child(receive_in_own_namespace); }

TEST(Multicast, GroupsOfIPv6AreJoined) { expect_passes_in_child(receive_ipv6_in_own_namespace); }

TEST(SharedPort, AllProgramsReceiveBroadcasts) { expect_passes_in_child(share_in_own_namespace); }

}  // namespace
}  // namespace limber::system

// Outages and recovery: the network, a listener, a port used by another program, a wrong clock. Each is logged once,
// affects nothing else, and recovers automatically.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "base/log/log.h"
#include "net/osc/network.h"
#include "net/osc/packets/decode.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace {

// Sending to this port fails as if its network was down; 0: no failure.
std::atomic<int> unreachable_port{0};

bool unreachable(const void* to) {
  const auto* address = static_cast<const sockaddr_in*>(to);
  const int port = unreachable_port.load();
  if (port == 0 || address == nullptr || ntohs(address->sin_port) != port) return false;
  errno = ENETUNREACH;
  return true;
}

}  // namespace

// Replacements of the system calls in this program.
extern "C" ssize_t sendto(int fd, const void* data, size_t size, int flags, const sockaddr* to, socklen_t length) {
  return unreachable(to) ? -1 : syscall(SYS_sendto, fd, data, size, flags, to, length);
}
extern "C" ssize_t send(int fd, const void* data, size_t size, int flags) {
  sockaddr_in peer{};
  socklen_t length = sizeof peer;
  const bool connected = getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &length) == 0;
  return connected && unreachable(&peer) ? -1 : syscall(SYS_sendto, fd, data, size, flags, nullptr, 0);
}
extern "C" int sendmmsg(int fd, mmsghdr* messages, unsigned count, int flags) {
  if (count > 0 && unreachable(messages[0].msg_hdr.msg_name)) return -1;
  return static_cast<int>(syscall(SYS_sendmmsg, fd, messages, count, flags));
}

namespace limber::osc {
namespace {

using namespace test;

OscOptions options_to_ports(std::vector<std::uint16_t> ports, const std::string& more) {
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out.emplace();
  for (const std::uint16_t port : ports)
    options.out->push_back(parse_osc_out("127.0.0.1:" + std::to_string(port) + more)->front());
  return options;
}

bool wait_until(const std::function<bool()>& condition) {
  const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > late) return false;
    std::this_thread::yield();
  }
  return true;
}

void publish_world(engine::EngineLink& link) {
  const auto spare = link.snapshots.acquire_buffer();
  *spare = test_world({{"arm", 2}});
  link.snapshots.publish(spare);
}

int log_count_of(std::uint64_t since, const std::string& text) {
  const auto lines = log_since(since);
  return static_cast<int>(
      std::ranges::count_if(lines, [&](const auto& line) { return line.text.find(text) != std::string::npos; }));
}

TEST(Outage, RecoversFromNetworkOutage) {
  log_to_stderr(false);
  const std::uint64_t before = log_newest();
  FakeEngine engine;
  const Client target, player;
  const std::uint16_t port = target.end().port;
  Network network(engine.link, options_to_ports({port}, ",rate=1000,streams=pos"), kTestOffsets);
  publish_world(engine.link);
  ASSERT_TRUE(network.start().ok());
  ASSERT_TRUE(target.receive());
  EXPECT_EQ(engine.link.counters.unsent, 0u);

  unreachable_port = port;
  engine.push_out({engine::Outgoing::Destination::targets, {}, {"/lost", {}}});
  ASSERT_TRUE(wait_until([&] { return engine.link.counters.unsent >= 20; }));
  while (target.receive(0)) continue;
  EXPECT_EQ(log_count_of(before, "Network is unreachable"), 2) << "once for the stream, once for the message";
  player.send(network.bound().at(0), numbered(1));
  EXPECT_TRUE(engine.wait_for(1)) << "input is not affected";

  unreachable_port = 0;
  EXPECT_TRUE(target.receive()) << "frames come again by themselves";
  engine.push_out({engine::Outgoing::Destination::targets, {}, {"/found", {}}});
  const std::string found = Bytes().text("/found").text(",").str();
  std::optional<std::string> got = target.receive();
  while (got && *got != found) got = target.receive();
  EXPECT_TRUE(got);
  network.stop();
  EXPECT_EQ(log_count_of(before, "Network is unreachable"), 2);
  log_to_stderr(true);
}

TEST(Outage, ReportsUnreachableTargetOnceAndKeepsSending) {
  log_to_stderr(false);
  const std::uint64_t before = log_newest();
  FakeEngine engine;
  const Client innocent;
  Endpoint refuser;
  {
    const Client closed;
    refuser = closed.end();
  }
  Network network(engine.link, options_to_ports({refuser.port, innocent.end().port}, ",rate=500,streams=pos"),
                  kTestOffsets);
  publish_world(engine.link);
  ASSERT_TRUE(network.start().ok());
  ASSERT_TRUE(wait_until([&] { return engine.link.counters.unsent >= 10; }));
  const std::string text = "OSC out 127.0.0.1:" + std::to_string(refuser.port) + ": no listener yet";
  EXPECT_EQ(log_count_of(before, text), 1);
  EXPECT_EQ(log_count_of(before, "no listener yet"), 1) << "the other target is not reported";

  // all messages sent between failed datagrams arrive
  for (int i = 0; i < 200; i++)
    engine.push_out({engine::Outgoing::Destination::targets, {}, {"/n", {Arg::of(static_cast<double>(i))}}});
  double expected = 0;
  const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
  while (expected < 200 && std::chrono::steady_clock::now() < late) {
    const auto bytes = innocent.receive();
    ASSERT_TRUE(bytes) << "lost: " << expected;
    const auto decoded = decode_packet(bytes->data(), bytes->size());
    ASSERT_TRUE(decoded.ok());
    if (decoded->messages.at(0).address != "/n") continue;
    ASSERT_EQ(decoded->messages[0].args.at(0).number, expected);
    expected++;
  }
  EXPECT_EQ(expected, 200);

  const Result<system::UdpSocket> back = system::open_udp(refuser);
  ASSERT_TRUE(back.ok()) << back.error();
  pollfd p{back->fd(), POLLIN, 0};
  EXPECT_EQ(poll(&p, 1, kTimeoutMs), 1) << "a new listener receives immediately";
  network.stop();
  EXPECT_EQ(log_count_of(before, text), 1);
  log_to_stderr(true);
}

// A clock of the network thread that a test changes while the thread runs.
struct AdjustableClock {
  std::atomic<std::int64_t> ns{1'000'000'000};
  std::atomic<int> readings{0};
  NetClock clock() {
    NetClock c;
    c.steady = [this] {
      readings++;
      return ns.load();
    };
    return c;
  }
};

TEST(Outage, OpensPortWhenItBecomesFree) {
  log_to_stderr(false);
  const std::uint64_t before = log_newest();
  FakeEngine engine;
  auto holder = std::make_unique<Client>();
  const Endpoint wanted = holder->end();
  OscOptions options = options_to_ports({}, "");
  options.in = {{"127.0.0.1", wanted.port}};
  options.optional = true;
  AdjustableClock manual_clock;
  Network network(engine.link, options, kTestOffsets, manual_clock.clock());
  ASSERT_TRUE(network.start().ok());
  EXPECT_EQ(network.status_lines().at(0), "OSC in off");
  const auto try_again = [&] {
    manual_clock.ns += 1'000'000'000;
    engine.link.wake_network();
  };
  // run some passes of the network thread's loop, each of which retries
  const int readings = manual_clock.readings;
  ASSERT_TRUE(wait_until([&] {
    try_again();
    return manual_clock.readings >= readings + 100;
  }));
  holder.reset();
  ASSERT_TRUE(wait_until([&] {
    try_again();
    return !network.bound().empty();
  }));
  EXPECT_EQ(network.bound().at(0), wanted);
  EXPECT_EQ(network.status_lines().at(0), "OSC in " + endpoint_text(wanted));
  const Client player;
  player.send(wanted, numbered(7));
  ASSERT_TRUE(engine.wait_for(1));
  EXPECT_EQ(engine.commands.at(0).messages.at(0).args.at(0).number, 7);
  network.stop();
  EXPECT_EQ(log_count_of(before, "Address already in use"), 1) << "not at each try";
  EXPECT_EQ(log_count_of(before, "OSC in " + endpoint_text(wanted)), 1);
  log_to_stderr(true);
}

// A sender's clock is an hour ahead, then an hour behind, then correct: its bundle is applied immediately, immediately,
// at its time.
TEST(Outage, ToleratesWrongClocks) {
  log_to_stderr(false);
  constexpr std::uint64_t kSecond = std::uint64_t{1} << 32;
  constexpr std::uint64_t kHour = 3600 * kSecond;
  const std::uint64_t before = log_newest();
  FakeEngine engine;
  ManualClock manual_clock;
  const NetClock clock = manual_clock.clock();
  Receiver receiver(engine.link, {}, {}, clock);
  const auto process = [&](std::uint64_t tag, std::uint32_t number) {
    const std::string bytes = bundle(tag, {numbered(number)});
    receiver.process(bytes.data(), bytes.size(), {0xc0a80107u, 5000});
    receiver.process_pending();
    engine.collect();
    return engine.count();
  };
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < 100; i++) EXPECT_EQ(process(manual_clock.ntp + kHour + i * kSecond, i), ++count);
  EXPECT_EQ(log_count_of(before, "the time tag of a bundle from 192.168.1.7:5000 is more than 10 s ahead; applied now"),
            1);
  for (std::uint32_t i = 0; i < 100; i++) EXPECT_EQ(process(manual_clock.ntp - kHour + i * kSecond, i), ++count);
  EXPECT_EQ(log_count_of(before, "is more than 10 s ahead"), 1);
  EXPECT_EQ(process(manual_clock.ntp + kSecond, 1), count) << "right again: it waits";
  manual_clock.advance(1);
  receiver.process_pending();
  engine.collect();
  EXPECT_EQ(engine.count(), ++count);

  // the system clock is set an hour ahead while a bundle is scheduled, and then back: both are delivered
  EXPECT_EQ(process(manual_clock.ntp + 5 * kSecond, 2), count);
  manual_clock.ntp += kHour;
  receiver.process_pending();
  engine.collect();
  EXPECT_EQ(engine.count(), ++count);
  EXPECT_EQ(process(manual_clock.ntp + 5 * kSecond, 3), count);
  manual_clock.ntp -= kHour;
  manual_clock.advance(10);
  receiver.process_pending();
  engine.collect();
  EXPECT_EQ(engine.count(), ++count) << "ten seconds at the most";
  EXPECT_EQ(engine.link.counters.dropped, 0u);
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::osc

// OSC by IPv6, on ::1.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "base/log/log.h"
#include "base/system/net/tcp_socket.h"
#include "net/osc/network.h"
#include "net/osc/packets/decode.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"
#include "support/skip.h"

namespace limber::osc {
namespace {

using namespace test;

constexpr IpAddress kLoopback6(0, 1);

bool has_ipv6() { return system::open_udp({kLoopback6, 0}).ok(); }

#define LIMBER_NEEDS_IPV6() LIMBER_SKIP_IF(!has_ipv6(), "this machine has no ::1")

std::string wind_message(float value) { return Bytes().text("/scene/wind").text(",f").f(value).str(); }

struct Ipv6Fixture {
  explicit Ipv6Fixture(OscOptions options = listening(), ResolveFunction look_up = resolve)
      : network(engine.link, std::move(options), kTestOffsets, {}, std::move(look_up)) {
    const Result<void> started = network.start();
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error());
    if (!network.bound().empty()) end = network.bound().at(0);
    const auto spare = engine.link.snapshots.acquire_buffer();
    *spare = test_world({{"arm", 3}});
    engine.link.snapshots.publish(spare);
  }
  static OscOptions listening() {
    OscOptions options;
    options.in = *parse_osc_in("[::1]:0");
    options.out.emplace();
    return options;
  }
  CommandOrigin origin() const { return {CommandSource::osc, client.end().ip, client.end().port}; }

  Client client{kLoopback6};
  FakeEngine engine;
  Network network;
  Endpoint end;
};

TEST(Ipv6, DeliversMessagesAndAnswers) {
  LIMBER_NEEDS_IPV6();
  Ipv6Fixture fixture;
  EXPECT_EQ(fixture.network.status_lines().at(0), fmt::format("OSC in [::1]:{}", fixture.end.port));
  fixture.client.send(fixture.end, wind_message(2));
  ASSERT_TRUE(fixture.engine.wait_for(1));
  EXPECT_EQ(fixture.engine.commands[0].origin, fixture.origin());
  EXPECT_EQ(sender_text(fixture.origin()), fmt::format("[::1]:{}", fixture.client.end().port));
  fixture.client.send(fixture.end, Bytes().text("/ping").text(",").str());
  Endpoint from;
  EXPECT_TRUE(fixture.client.receive(kTimeoutMs, &from).value_or("").starts_with("/pong"));
  EXPECT_EQ(from, fixture.end) << "the answer has the address that the sender knows";
  fixture.engine.push_out({engine::Outgoing::Destination::direct, fixture.origin(), {"/direct", {}}});
  EXPECT_TRUE(fixture.client.receive().value_or("").starts_with("/direct"));
}

TEST(Ipv6, ReceivesNoIPv4) {
  LIMBER_NEEDS_IPV6();
  // both kinds with the same port: a socket of IPv6 is not one of IPv4, too
  Client other;
  OscOptions options = Ipv6Fixture::listening();
  options.in = *parse_osc_in(fmt::format("[::]:{}", other.end().port));
  Ipv6Fixture fixture(std::move(options));
  fixture.client.send({kLoopback6, fixture.end.port}, wind_message(1));
  EXPECT_TRUE(fixture.engine.wait_for(1));
}

TEST(Ipv6, StreamsToTargetsAndSubscribers) {
  LIMBER_NEEDS_IPV6();
  const Client target(kLoopback6);
  OscOptions options = Ipv6Fixture::listening();
  const std::string name = fmt::format("[::1]:{}", target.end().port);
  options.out = *parse_osc_out(name + ",rate=1000,streams=pos,bundle=1472");
  Ipv6Fixture fixture(std::move(options));
  EXPECT_TRUE(target.receive().value_or("").starts_with("/physics/joint/pos"));
  EXPECT_EQ(fixture.network.status_lines().at(1), "OSC out " + name + " (pos at 1000 Hz, bundles of 1472 bytes)");
  fixture.client.send(fixture.end, Bytes().text("/subscribe").text(",s").text("rot").str());
  EXPECT_TRUE(fixture.client.receive().value_or("").starts_with("/physics/joint/rot"));
}

TEST(Ipv6, NamesPreferTheKindOfTheInput) {
  LIMBER_NEEDS_IPV6();
  std::map<std::string, IpVersion> preferred;
  for (const char* in : {"[::1]:0", "127.0.0.1:0", "127.0.0.1:0,[::1]:0"}) {
    OscOptions options;
    options.in = *parse_osc_in(in);
    options.out = *parse_osc_out("both.example:9");
    Ipv6Fixture fixture(std::move(options),
                        [&](const std::string&, std::uint16_t port, IpVersion version) -> Result<Endpoint> {
                          preferred[in] = version;
                          return Endpoint{kLoopback6, port};
                        });
  }
  EXPECT_EQ(preferred,
            (std::map<std::string, IpVersion>{
                {"[::1]:0", IpVersion::v6}, {"127.0.0.1:0", IpVersion::v4}, {"127.0.0.1:0,[::1]:0", IpVersion::v4}}));
}

TEST(Ipv6, AllowListRejectsOthers) {
  LIMBER_NEEDS_IPV6();
  log_to_stderr(false);
  OscOptions options = Ipv6Fixture::listening();
  options.allow = *parse_osc_allow("fd00::/8,127.0.0.1");
  Ipv6Fixture denied(std::move(options));
  denied.client.send(denied.end, Bytes().text("/ping").text(",").str());
  options = Ipv6Fixture::listening();
  options.allow = *parse_osc_allow("::1");
  Ipv6Fixture allowed(std::move(options));
  allowed.client.send(allowed.end, Bytes().text("/ping").text(",").str());
  EXPECT_TRUE(allowed.client.receive().value_or("").starts_with("/pong"));
  for (int ms = 0; denied.engine.link.counters.denied == 0 && ms < kTimeoutMs; ms++) (void)denied.client.receive(1);
  EXPECT_EQ(denied.engine.link.counters.denied, 1U);
  log_to_stderr(true);
}

TEST(Ipv6, LimitsSendersOfOtherNetworks) {
  LIMBER_NEEDS_IPV6();
  log_to_stderr(false);
  OscOptions options = Ipv6Fixture::listening();
  options.connected = [] { return std::vector<Cidr>{}; };
  Ipv6Fixture fixture(std::move(options));
  fixture.client.send(fixture.end, Bytes().text("/subscribe").text(",sf").text("pos").f(1000).str());
  std::optional<std::string> token = fixture.client.receive();
  ASSERT_TRUE(token.value_or("").starts_with("/token"));
  const std::string text = decode_packet(token->data(), token->size())->messages.at(0).args.at(0).text;
  fixture.client.send(fixture.end, Bytes().text("/token").text(",s").text(text).str());
  // unlimited from now on: more than three bytes for each one that it has sent
  std::size_t bytes = 0;
  while (bytes < 4096) {
    const std::optional<std::string> frame = fixture.client.receive();
    ASSERT_TRUE(frame);
    bytes += frame->size();
  }
  log_to_stderr(true);
}

TEST(Ipv6, SendsNothingToItself) {
  LIMBER_NEEDS_IPV6();
  log_to_stderr(false);
  FakeEngine engine;
  engine::Counters& counters = engine.link.counters;
  const NetClock clock;
  Sender sender(
      counters, engine.link.message_log, [](const Endpoint&) { return -1; }, clock);
  sender.set_own_inputs({{IpAddress(0, 0), 9003}, {0U, 9004}}, {0xc0a80105U, 0xc0a801ffU, kLoopback6});
  EXPECT_TRUE(sender.is_own_input({kLoopback6, 9003}));
  EXPECT_FALSE(sender.is_own_input({0x7f000001U, 9003})) << "the input of IPv6 receives no IPv4";
  EXPECT_FALSE(sender.is_own_input({kLoopback6, 9004}));
  EXPECT_FALSE(sender.is_own_input({IpAddress(0x20010db8ULL << 32U, 1), 9003})) << "another machine";
  EXPECT_TRUE(sender.is_own_input({0xc0a801ffU, 9004})) << "a broadcast returns to its sender";
  log_to_stderr(true);
}

TEST(Ipv6, ReportsClosedPorts) {
  LIMBER_NEEDS_IPV6();
  Endpoint closed;
  {
    const Client gone(kLoopback6);
    closed = gone.end();
  }
  system::UdpSender sender;
  ASSERT_TRUE(sender.open().ok());
  const std::array<char, 4> packet = {'/', 'a', 0, 0};
  EXPECT_EQ(sender.send(closed, packet), 0);
  const std::optional<system::SendFailure> failure = sender.next_failure();  // on loopback, at once
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->to, closed);
  const Client listener(kLoopback6);
  bool segmentation = true;
  const std::array<std::uint32_t, 3> sizes = {4, 4, 4};
  const std::array<char, 12> three = {'/', 'a', 0, 0, '/', 'b', 0, 0, '/', 'c', 0, 0};
  EXPECT_EQ(sender.send(listener.end(), three, sizes, segmentation).sent, 3U);
  for (const char* name : {"/a", "/b", "/c"}) EXPECT_TRUE(listener.receive().value_or("").starts_with(name));
}

TEST(Ipv6, TcpClientsAreServed) {
  LIMBER_NEEDS_IPV6();
  OscOptions options;
  options.in.emplace();
  options.out.emplace();
  options.tcp = *parse_listen("--osc-tcp", "[::1]:0");
  Ipv6Fixture fixture(std::move(options));
  const Endpoint end = fixture.network.bound_tcp().at(0);
  EXPECT_EQ(fixture.network.status_lines().at(0), "OSC in " + endpoint_text(end) + " (TCP)");
  const system::Descriptor client = system::connect_tcp(end);
  ASSERT_TRUE(client.is_open());
  ASSERT_GT(system::send_bytes(client.fd(), std::string("\xc0") + wind_message(1) + "\xc0"), 0);
  ASSERT_TRUE(fixture.engine.wait_for(1));
  EXPECT_EQ(fixture.engine.commands[0].origin.ip, kLoopback6);
}

}  // namespace
}  // namespace limber::osc

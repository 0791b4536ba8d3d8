// The network thread on this machine: real sockets with ports chosen by the kernel, bursts, answers, streams, plans.
#include "net/osc/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>

#include "base/log/log.h"
#include "net/osc/packets/decode.h"
#include "osc/bad_packets.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

OscOptions options_to(const Client& client, const std::string& more = ",streams=none") {
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out = *parse_osc_out("127.0.0.1:" + std::to_string(client.end().port) + more);
  return options;
}

void publish(engine::EngineLink& link, engine::Snapshot snapshot) {
  const auto spare = link.snapshots.acquire_buffer();
  *spare = std::move(snapshot);
  link.snapshots.publish(spare);
}

struct NetworkFixture {
  explicit NetworkFixture(const std::string& more = ",streams=none")
      : network(engine.link, options_to(target, more), kTestOffsets) {
    const Result<void> started = network.start();
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error());
    if (started.ok()) end = network.bound().at(0);
  }
  Client client, target;
  FakeEngine engine;
  Network network;
  Endpoint end;
};

// Checks the receive buffer that the kernel grants for small datagrams. Measured: 10 000 need 4 MiB, granted as 8.
bool buffer_granted() {
  const system::UdpSocket probe = std::move(system::open_udp({0x7f000001, 0}).value());
  const int wanted = 4 << 20;
  setsockopt(probe.fd(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
  int granted = 0;
  socklen_t length = sizeof granted;
  getsockopt(probe.fd(), SOL_SOCKET, SO_RCVBUF, &granted, &length);
  return granted >= 2 * wanted;
}

TEST(Network, DeliversMessageWithSender) {
  NetworkFixture fixture;
  fixture.client.send(fixture.end,
                      Bytes().text("/physics/part/mass").text(",ssf").text("arm").text("tip").f(0.25f).str());
  ASSERT_TRUE(fixture.engine.wait_for(1));
  const engine::Command& c = fixture.engine.commands.at(0);
  EXPECT_EQ(c.origin.ip, 0x7f000001u);
  EXPECT_EQ(c.origin.port, fixture.client.end().port);
  EXPECT_EQ(c.messages.at(0).address, "/physics/part/mass");
  EXPECT_EQ(c.messages[0].args.at(2).number, 0.25);
}

// As fast as possible: as many datagrams as every kernel buffers, and ten thousand if the buffer is granted.
TEST(Network, ReceivesBurstWithoutLoss) {
  NetworkFixture fixture;
  const std::uint32_t count = buffer_granted() ? 10000 : 2000;
  for (std::uint32_t i = 0; i < count; i++) {
    fixture.client.send(fixture.end, numbered(i));
    // with a small buffer, give the network thread time to read
    if (count == 2000 && i % 100 == 99) {
      ASSERT_TRUE(fixture.engine.wait_for(i + 1));
    }
  }
  ASSERT_TRUE(fixture.engine.wait_for(count));
  std::uint32_t expected = 0;
  for (const engine::Command& c : fixture.engine.commands) {
    for (const Message& m : c.messages) EXPECT_EQ(m.args.at(0).number, static_cast<double>(expected++));
  }
  EXPECT_EQ(fixture.engine.link.counters.received, count);
  EXPECT_EQ(fixture.engine.link.counters.dropped_kernel, 0u);
  EXPECT_EQ(fixture.engine.link.counters.dropped, 0u);
}

TEST(Network, SkipsMalformedDatagrams) {
  log_to_stderr(false);
  NetworkFixture fixture;
  std::uint64_t bad = 0;
  for (const BadPacket& packet : bad_packets()) {
    if (packet.bytes.size() > 65507) continue;  // too large for UDP
    fixture.client.send(fixture.end, packet.bytes);
    fixture.client.send(fixture.end, numbered(static_cast<std::uint32_t>(++bad)));
    ASSERT_TRUE(fixture.engine.wait_for(bad)) << packet.description;
  }
  EXPECT_EQ(fixture.engine.link.counters.malformed, bad);
  EXPECT_EQ(fixture.engine.link.counters.received, bad);
  log_to_stderr(true);
}

TEST(Network, AnswersPingFromLatestSnapshot) {
  NetworkFixture fixture;
  const std::string ping = Bytes().text("/ping").str();
  Endpoint from;
  fixture.client.send(fixture.end, ping);
  EXPECT_EQ(fixture.client.receive(kTimeoutMs, &from), Bytes().text("/pong").text(",if").u32(0).f(0).str());
  EXPECT_EQ(from, fixture.end);
  engine::Snapshot s;
  s.tick = 77;
  s.time = 1.25;
  publish(fixture.engine.link, s);
  fixture.client.send(fixture.end, ping);
  EXPECT_EQ(fixture.client.receive(), Bytes().text("/pong").text(",if").u32(77).f(1.25f).str());
}

TEST(Network, SendsEngineReplies) {
  NetworkFixture fixture;
  fixture.client.send(fixture.end, numbered(1));
  ASSERT_TRUE(fixture.engine.wait_for(1));
  const CommandOrigin origin = fixture.engine.commands[0].origin;
  fixture.engine.push_out(
      {engine::Outgoing::Destination::error, origin, {"/error", {Arg::of("/n"), Arg::of("unknown")}}});
  Endpoint from;
  EXPECT_EQ(fixture.client.receive(kTimeoutMs, &from),
            Bytes().text("/error").text(",ss").text("/n").text("unknown").str());
  EXPECT_EQ(from, fixture.end) << "the answer comes from where the question went";
  fixture.engine.push_out({engine::Outgoing::Destination::targets, {}, {"/pulse", {Arg::of(1.0)}}});
  EXPECT_EQ(fixture.target.receive(), Bytes().text("/pulse").text(",f").f(1).str());
}

// A bundle dated 50 ms ahead arrives, and not before its time.
TEST(Network, DeliversScheduledBundle) {
  NetworkFixture fixture;
  const NetClock clock;
  const std::uint64_t when = clock.ntp() + (std::uint64_t{1} << 32) / 20;
  fixture.client.send(fixture.end, bundle(when, {numbered(2)}));
  fixture.client.send(fixture.end, numbered(1));
  ASSERT_TRUE(fixture.engine.wait_for(2));
  EXPECT_GE(clock.ntp(), when);
  EXPECT_EQ(fixture.engine.commands.at(0).messages.at(0).args.at(0).number, 1);
  EXPECT_EQ(fixture.engine.commands.at(1).messages.at(0).args.at(0).number, 2);
}

TEST(Network, StreamsFrames) {
  NetworkFixture fixture(",rate=1000,streams=pos");
  const engine::Snapshot s = test_world({{"arm", 2}});
  publish(fixture.engine.link, s);
  for (int i = 0; i < 20; i++) {
    const auto frame = fixture.target.receive();
    ASSERT_TRUE(frame);
    const auto d = decode_packet(frame->data(), frame->size());
    ASSERT_EQ(d->messages.at(0).args.size(), 7u);
    EXPECT_EQ(d->messages[0].args[0].text, "arm");
    EXPECT_EQ(d->messages[0].args[1].number, test_number(s.body_list->bodies[0].joint_offsets[0] + 1));
  }
}

TEST(Network, SceneConfigReplacesDefaultAtRuntime) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client first, second;
  const auto plan_to = [&](const std::vector<ListenAddress>& in, const Client& client) {
    OscConfig plan;
    plan.listen = in;
    plan.targets = {StreamTarget{.host = "127.0.0.1", .port = client.end().port}};
    const auto spare = engine.link.osc_config.acquire_buffer();
    *spare = plan;
    engine.link.osc_config.publish(spare);
    engine.link.wake_network();
  };
  Network network(engine.link, {}, kTestOffsets);
  plan_to({{"127.0.0.1", 0}}, first);
  ASSERT_TRUE(network.start().ok());
  const Endpoint previous = network.bound().at(0);
  publish(engine.link, test_world({{"arm", 1}}));
  ASSERT_TRUE(first.receive());

  plan_to({{"127.0.0.1", 0}, {"127.0.0.2", 0}}, second);
  ASSERT_TRUE(second.receive());
  ASSERT_EQ(network.bound().size(), 2u);
  EXPECT_EQ(network.bound()[0], previous) << "unchanged sockets stay open";
  EXPECT_EQ(network.status_lines().at(2),
            "OSC out 127.0.0.1:" + std::to_string(second.end().port) + " (pos+rot+relrot at 60 Hz)");
  first.send(network.bound()[1], numbered(5));
  ASSERT_TRUE(engine.wait_for(1));
  network.stop();
  log_to_stderr(true);
}

// A slow name server delays only the target with that name.
TEST(Network, ResolvesNamesInBackground) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client numeric, named;
  std::promise<void> answer;
  const std::shared_future<void> answered = answer.get_future().share();
  const ResolveFunction slow = [answered](const std::string& host, std::uint16_t port, IpVersion) -> Result<Endpoint> {
    answered.wait();
    if (host == "unknown.example") return Error{"no IPv4 address for 'unknown.example'"};
    return Endpoint{0x7f000001, port};
  };
  OscOptions options;
  options.in = *parse_osc_in("0");
  Network network(engine.link, options, kTestOffsets, {}, slow);
  const auto plan = engine.link.osc_config.acquire_buffer();
  plan->targets = {StreamTarget{.host = "127.0.0.1", .port = numeric.end().port}};
  engine.link.osc_config.publish(plan);
  ASSERT_TRUE(network.start().ok());

  const std::uint64_t errors = log_count(LogLevel::error);
  const auto second = engine.link.osc_config.acquire_buffer();
  second->targets = {StreamTarget{.host = "slow.example", .port = named.end().port},
                     StreamTarget{.host = "unknown.example", .port = 9},
                     StreamTarget{.host = "localhost", .port = numeric.end().port}};
  engine.link.osc_config.publish(second);
  engine.link.wake_network();
  publish(engine.link, test_world({{"arm", 1}}));
  for (int i = 0; i < 3; i++) ASSERT_TRUE(numeric.receive());
  const std::string port = std::to_string(numeric.end().port);
  while (network.status_lines().at(1) != "OSC out localhost:" + port + " (pos+rot+relrot at 60 Hz)") {
    ASSERT_TRUE(numeric.receive());
  }
  EXPECT_EQ(network.status_lines().size(), 2u) << "the others are on their way";
  answer.set_value();
  ASSERT_TRUE(named.receive());
  while (log_count(LogLevel::error) == errors) ASSERT_TRUE(named.receive());
  EXPECT_EQ(log_count(LogLevel::error), errors + 1);
  network.stop();
  log_to_stderr(true);
}

// A machine that has just booted does not resolve names yet.
TEST(Network, RetriesFailedLookUp) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client client;
  std::atomic<std::int64_t> ns{5'000'000'000};
  std::atomic<int> looked_up{0};
  std::atomic<bool> known{false};
  NetClock clock;
  clock.steady = [&ns] { return ns.load(); };
  const ResolveFunction look_up = [&](const std::string&, std::uint16_t port, IpVersion) -> Result<Endpoint> {
    const bool found = known.load();
    looked_up++;
    if (!found) return Error{"no IPv4 address"};
    return Endpoint{0x7f000001, port};
  };
  OscOptions options;
  options.in = *parse_osc_in("off");
  options.out = *parse_osc_out("later.example:" + std::to_string(client.end().port) + ",streams=none");
  Network network(engine.link, options, kTestOffsets, clock, look_up);
  const auto texts = [] { return log_count(LogLevel::warning) + log_count(LogLevel::error); };
  const std::uint64_t before = texts();
  ASSERT_TRUE(network.start().ok());
  EXPECT_EQ(network.status_lines().at(1), "OSC out off");
  EXPECT_EQ(texts(), before + 1);
  const auto pass = [&] {
    ns += 5'000'000'000;
    engine.link.wake_network();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  constexpr int kMaxPasses = 20000;  // reached only by failing tests
  for (int i = 0; i < kMaxPasses && looked_up.load() < 4; i++) pass();
  ASSERT_GE(looked_up.load(), 4);
  EXPECT_EQ(texts(), before + 1) << "logged once";
  const std::uint64_t newest = log_newest();
  known = true;
  for (int i = 0; i < kMaxPasses && network.status_lines().at(1) == "OSC out off"; i++) pass();
  engine.push_out({engine::Outgoing::Destination::targets, {}, {"/there", {}}});
  EXPECT_EQ(client.receive(), Bytes().text("/there").text(",").str());
  network.stop();
  int warnings = 0;
  for (const LogLine& line : log_since(newest)) warnings += line.text.starts_with("OSC out later.example") ? 1 : 0;
  EXPECT_EQ(warnings, 1);
  log_to_stderr(true);
}

TEST(Network, CommandLineOverridesScene) {
  FakeEngine engine;
  const Client client;
  Network network(engine.link, options_to(client), kTestOffsets);
  const auto spare = engine.link.osc_config.acquire_buffer();
  spare->listen = {{"127.0.0.3", 0}};
  engine.link.osc_config.publish(spare);
  ASSERT_TRUE(network.start().ok());
  EXPECT_EQ(network.bound().at(0).ip, 0x7f000001u);
  EXPECT_EQ(network.status_lines(), (std::vector<std::string>{"OSC in " + endpoint_text(network.bound()[0]),
                                                              "OSC out 127.0.0.1:" + std::to_string(client.end().port) +
                                                                  " (no streams at 60 Hz)"}));
}

TEST(Network, PortInUseIsErrorUnlessOptional) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client holder;
  OscOptions options = options_to(holder);
  options.in = {{"127.0.0.1", holder.end().port}};
  {
    Network network(engine.link, options, kTestOffsets);
    const Result<void> started = network.start();
    ASSERT_FALSE(started.ok());
    EXPECT_EQ(started.error(), "OSC can't listen on 127.0.0.1:" + std::to_string(holder.end().port) +
                                   ": Address already in use. Choose another port with --osc-in ADDR:PORT, or continue "
                                   "without it with --osc-optional");
  }
  options.optional = true;
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  EXPECT_TRUE(network.bound().empty());
  engine.push_out({engine::Outgoing::Destination::targets, {}, {"/still", {}}});
  EXPECT_EQ(holder.receive(), Bytes().text("/still").text(",").str());
  log_to_stderr(true);
}

TEST(Network, OffOpensNoPorts) {
  FakeEngine engine;
  OscOptions options;
  options.in = *parse_osc_in("off");
  options.out = *parse_osc_out("off");
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  EXPECT_EQ(network.status_lines(), (std::vector<std::string>{"OSC in off", "OSC out off"}));
}

// Starts and stops repeatedly: the ports are free afterwards, and a notification after the end is harmless.
TEST(Network, StartsAndStopsRepeatedly) {
  FakeEngine engine;
  const Client client;
  std::uint16_t port = 0;
  for (int i = 0; i < 20; i++) {
    OscOptions options = options_to(client);
    options.in = {{"127.0.0.1", port}};
    Network network(engine.link, options, kTestOffsets);
    ASSERT_TRUE(network.start().ok());
    port = network.bound().at(0).port;
    engine.push_out({engine::Outgoing::Destination::targets, {}, {"/last", {Arg::of(static_cast<double>(i))}}});
    network.stop();
    network.stop();
    EXPECT_EQ(client.receive(), Bytes().text("/last").text(",f").f(static_cast<float>(i)).str());
  }
  engine.link.wake_network();
}

}  // namespace
}  // namespace limber::osc

// The network thread on this machine: real sockets with ports that the kernel chooses, bursts, answers, streams, plans.
#include "osc/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>

#include "base/log.h"
#include "osc/bad_packets.h"
#include "osc/decode.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber {
namespace {

using namespace osc_test;

OscOptions options_to(const Client& client, const std::string& more = ",streams=none") {
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out = *parse_osc_out("127.0.0.1:" + std::to_string(client.end().port) + more);
  return options;
}

void publish(EngineLink& link, Snapshot snapshot) {
  const auto spare = link.snapshots.spare();
  *spare = std::move(snapshot);
  link.snapshots.publish(spare);
}

struct NetworkDesk {
  explicit NetworkDesk(const std::string& more = ",streams=none")
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

// how many small datagrams the kernel keeps for us at most; facts measured: 10 000 need 4 MiB, granted as 8
bool buffer_granted() {
  const system::UdpSocket probe = std::move(system::open_udp({0x7f000001, 0}).value());
  const int wanted = 4 << 20;
  setsockopt(probe.fd(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
  int granted = 0;
  socklen_t length = sizeof granted;
  getsockopt(probe.fd(), SOL_SOCKET, SO_RCVBUF, &granted, &length);
  return granted >= 2 * wanted;
}

TEST(Network, MessageArrivesWithItsSender) {
  NetworkDesk desk;
  desk.client.send(desk.end, Bytes().text("/physics/part/mass").text(",ssf").text("arm").text("tip").f(0.25f).str());
  ASSERT_TRUE(desk.engine.wait_for(1));
  const Command& c = desk.engine.commands.at(0);
  EXPECT_EQ(c.origin.ip, 0x7f000001u);
  EXPECT_EQ(c.origin.port, desk.client.end().port);
  EXPECT_EQ(c.messages.at(0).address, "/physics/part/mass");
  EXPECT_EQ(c.messages[0].args.at(2).number, 0.25);
}

// as fast as a client can; as many as every kernel keeps, and ten thousand where the buffer is granted
TEST(Network, BurstWithoutLoss) {
  NetworkDesk desk;
  const std::uint32_t count = buffer_granted() ? 10000 : 2000;
  for (std::uint32_t i = 0; i < count; i++) {
    desk.client.send(desk.end, numbered(i));
    // a kernel that grants little gets time to hand over
    if (count == 2000 && i % 100 == 99) {
      ASSERT_TRUE(desk.engine.wait_for(i + 1));
    }
  }
  ASSERT_TRUE(desk.engine.wait_for(count));
  std::uint32_t expected = 0;
  for (const Command& c : desk.engine.commands) {
    for (const Message& m : c.messages) EXPECT_EQ(m.args.at(0).number, static_cast<double>(expected++));
  }
  EXPECT_EQ(desk.engine.link.counters.received, count);
  EXPECT_EQ(desk.engine.link.counters.dropped_kernel, 0u);
  EXPECT_EQ(desk.engine.link.counters.dropped, 0u);
}

TEST(Network, BadDatagramsInBetween) {
  log_to_stderr(false);
  NetworkDesk desk;
  std::uint64_t bad = 0;
  for (const BadPacket& packet : bad_packets()) {
    if (packet.bytes.size() > 65507) continue;  // UDP does not carry it
    desk.client.send(desk.end, packet.bytes);
    desk.client.send(desk.end, numbered(static_cast<std::uint32_t>(++bad)));
    ASSERT_TRUE(desk.engine.wait_for(bad)) << packet.what;
  }
  EXPECT_EQ(desk.engine.link.counters.malformed, bad);
  EXPECT_EQ(desk.engine.link.counters.received, bad);
  log_to_stderr(true);
}

TEST(Network, PingIsAnsweredFromTheNewestSnapshot) {
  NetworkDesk desk;
  const std::string ping = Bytes().text("/ping").str();
  Endpoint from;
  desk.client.send(desk.end, ping);
  EXPECT_EQ(desk.client.receive(kPatienceMs, &from), Bytes().text("/pong").text(",if").u32(0).f(0).str());
  EXPECT_EQ(from, desk.end);
  Snapshot s;
  s.tick = 77;
  s.time = 1.25;
  publish(desk.engine.link, s);
  desk.client.send(desk.end, ping);
  EXPECT_EQ(desk.client.receive(), Bytes().text("/pong").text(",if").u32(77).f(1.25f).str());
}

TEST(Network, EnginesAnswersGoOut) {
  NetworkDesk desk;
  desk.client.send(desk.end, numbered(1));
  ASSERT_TRUE(desk.engine.wait_for(1));
  const Origin origin = desk.engine.commands[0].origin;
  desk.engine.say({Outgoing::To::error, origin, {"/error", {Arg::of("/n"), Arg::of("unknown")}}});
  Endpoint from;
  EXPECT_EQ(desk.client.receive(kPatienceMs, &from),
            Bytes().text("/error").text(",ss").text("/n").text("unknown").str());
  EXPECT_EQ(from, desk.end) << "the answer comes from where the question went";
  desk.engine.say({Outgoing::To::targets, {}, {"/pulse", {Arg::of(1.0)}}});
  EXPECT_EQ(desk.target.receive(), Bytes().text("/pulse").text(",f").f(1).str());
}

// a bundle dated 50 ms ahead comes, and not before its time
TEST(Network, HeldBundleComes) {
  NetworkDesk desk;
  const NetClock clock;
  const std::uint64_t when = clock.ntp() + (std::uint64_t{1} << 32) / 20;
  desk.client.send(desk.end, bundle(when, {numbered(2)}));
  desk.client.send(desk.end, numbered(1));
  ASSERT_TRUE(desk.engine.wait_for(2));
  EXPECT_GE(clock.ntp(), when);
  EXPECT_EQ(desk.engine.commands.at(0).messages.at(0).args.at(0).number, 1);
  EXPECT_EQ(desk.engine.commands.at(1).messages.at(0).args.at(0).number, 2);
}

TEST(Network, StreamsFrameAfterFrame) {
  NetworkDesk desk(",rate=1000,streams=pos");
  const Snapshot s = test_world({{"arm", 2}});
  publish(desk.engine.link, s);
  for (int i = 0; i < 20; i++) {
    const auto frame = desk.target.receive();
    ASSERT_TRUE(frame);
    const auto d = decode_packet(frame->data(), frame->size());
    ASSERT_EQ(d->messages.at(0).args.size(), 7u);
    EXPECT_EQ(d->messages[0].args[0].text, "arm");
    EXPECT_EQ(d->messages[0].args[1].number, test_number(s.roster->bodies[0].joints[0] + 1));
  }
}

TEST(Network, ScenePlanReplacesTheDefaultWhileRunning) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client first, second;
  const auto plan_to = [&](const std::vector<ListenAddress>& in, const Client& client) {
    OscPlan plan;
    plan.listen = in;
    plan.targets = {StreamTarget{.host = "127.0.0.1", .port = client.end().port}};
    const auto spare = engine.link.osc_plan.spare();
    *spare = plan;
    engine.link.osc_plan.publish(spare);
    engine.link.wake_network();
  };
  Network network(engine.link, {}, kTestOffsets);
  plan_to({{"127.0.0.1", 0}}, first);
  ASSERT_TRUE(network.start().ok());
  const Endpoint kept = network.bound().at(0);
  publish(engine.link, test_world({{"arm", 1}}));
  ASSERT_TRUE(first.receive());

  plan_to({{"127.0.0.1", 0}, {"127.0.0.2", 0}}, second);
  ASSERT_TRUE(second.receive());
  ASSERT_EQ(network.bound().size(), 2u);
  EXPECT_EQ(network.bound()[0], kept) << "what did not change stays open";
  EXPECT_EQ(network.lines().at(2),
            "OSC out 127.0.0.1:" + std::to_string(second.end().port) + " (pos+rot+relrot at 60 Hz)");
  first.send(network.bound()[1], numbered(5));
  ASSERT_TRUE(engine.wait_for(1));
  network.stop();
  log_to_stderr(true);
}

// a name server that lets one wait holds up nobody but the target that needs it
TEST(Network, NamesAreLookedUpBesides) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client numeric, named;
  std::promise<void> answer;
  const std::shared_future<void> answered = answer.get_future().share();
  const LookUp slow = [answered](const std::string& host, std::uint16_t port) -> Result<Endpoint> {
    answered.wait();
    if (host == "nobody.example") return Error{"no IPv4 address for 'nobody.example'"};
    return Endpoint{0x7f000001, port};
  };
  OscOptions options;
  options.in = *parse_osc_in("0");
  Network network(engine.link, options, kTestOffsets, {}, slow);
  const auto plan = engine.link.osc_plan.spare();
  plan->targets = {StreamTarget{.host = "127.0.0.1", .port = numeric.end().port}};
  engine.link.osc_plan.publish(plan);
  ASSERT_TRUE(network.start().ok());

  const std::uint64_t errors = log_count(LogLevel::error);
  const auto second = engine.link.osc_plan.spare();
  second->targets = {StreamTarget{.host = "slow.example", .port = named.end().port},
                     StreamTarget{.host = "nobody.example", .port = 9},
                     StreamTarget{.host = "localhost", .port = numeric.end().port}};
  engine.link.osc_plan.publish(second);
  engine.link.wake_network();
  publish(engine.link, test_world({{"arm", 1}}));
  for (int i = 0; i < 3; i++) ASSERT_TRUE(numeric.receive());
  const std::string port = std::to_string(numeric.end().port);
  while (network.lines().at(1) != "OSC out localhost:" + port + " (pos+rot+relrot at 60 Hz)") {
    ASSERT_TRUE(numeric.receive());
  }
  EXPECT_EQ(network.lines().size(), 2u) << "the others are on their way";
  answer.set_value();
  ASSERT_TRUE(named.receive());
  while (log_count(LogLevel::error) == errors) ASSERT_TRUE(named.receive());
  EXPECT_EQ(log_count(LogLevel::error), errors + 1);
  network.stop();
  log_to_stderr(true);
}

// a machine that has just been switched on knows no names yet
TEST(Network, ANameThatIsNotKnownYetIsLookedUpAgain) {
  log_to_stderr(false);
  FakeEngine engine;
  const Client client;
  std::atomic<std::int64_t> ns{5'000'000'000};
  std::atomic<int> looked_up{0};
  std::atomic<bool> known{false};
  NetClock clock;
  clock.steady = [&ns] { return ns.load(); };
  const LookUp look_up = [&](const std::string&, std::uint16_t port) -> Result<Endpoint> {
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
  EXPECT_EQ(network.lines().at(1), "OSC out off");
  EXPECT_EQ(texts(), before + 1);
  const auto pass = [&] {
    ns += 5'000'000'000;
    engine.link.wake_network();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  constexpr int kMostPasses = 20000;  // only a failing test takes as many
  for (int i = 0; i < kMostPasses && looked_up.load() < 4; i++) pass();
  ASSERT_GE(looked_up.load(), 4);
  EXPECT_EQ(texts(), before + 1) << "said once";
  const std::uint64_t newest = log_newest();
  known = true;
  for (int i = 0; i < kMostPasses && network.lines().at(1) == "OSC out off"; i++) pass();
  engine.say({Outgoing::To::targets, {}, {"/there", {}}});
  EXPECT_EQ(client.receive(), Bytes().text("/there").text(",").str());
  network.stop();
  int said = 0;
  for (const LogLine& line : log_since(newest)) said += line.text.starts_with("OSC out later.example") ? 1 : 0;
  EXPECT_EQ(said, 1);
  log_to_stderr(true);
}

TEST(Network, CommandLineWinsOverTheScene) {
  FakeEngine engine;
  const Client client;
  Network network(engine.link, options_to(client), kTestOffsets);
  const auto spare = engine.link.osc_plan.spare();
  spare->listen = {{"127.0.0.3", 0}};
  engine.link.osc_plan.publish(spare);
  ASSERT_TRUE(network.start().ok());
  EXPECT_EQ(network.bound().at(0).ip, 0x7f000001u);
  EXPECT_EQ(network.lines(), (std::vector<std::string>{
                                 "OSC in " + endpoint_text(network.bound()[0]),
                                 "OSC out 127.0.0.1:" + std::to_string(client.end().port) + " (no streams at 60 Hz)"}));
}

TEST(Network, TakenPortIsAnErrorUnlessOptional) {
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
                                   ": Address already in use; choose another with --osc-in ADDR:PORT, or play without "
                                   "with --osc-optional");
  }
  options.optional = true;
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  EXPECT_TRUE(network.bound().empty());
  engine.say({Outgoing::To::targets, {}, {"/still", {}}});
  EXPECT_EQ(holder.receive(), Bytes().text("/still").text(",").str());
  log_to_stderr(true);
}

TEST(Network, OffIsOff) {
  FakeEngine engine;
  OscOptions options;
  options.in = *parse_osc_in("off");
  options.out = *parse_osc_out("off");
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  EXPECT_EQ(network.lines(), (std::vector<std::string>{"OSC in off", "OSC out off"}));
}

// started and stopped again and again: ports are free afterwards, and a ring after the end does no harm
TEST(Network, StartsAndStops) {
  FakeEngine engine;
  const Client client;
  std::uint16_t port = 0;
  for (int i = 0; i < 20; i++) {
    OscOptions options = options_to(client);
    options.in = {{"127.0.0.1", port}};
    Network network(engine.link, options, kTestOffsets);
    ASSERT_TRUE(network.start().ok());
    port = network.bound().at(0).port;
    engine.say({Outgoing::To::targets, {}, {"/last", {Arg::of(static_cast<double>(i))}}});
    network.stop();
    network.stop();
    EXPECT_EQ(client.receive(), Bytes().text("/last").text(",f").f(static_cast<float>(i)).str());
  }
  engine.link.wake_network();
}

}  // namespace
}  // namespace limber

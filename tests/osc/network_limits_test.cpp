// Limits of the network thread: tokens, loops, and the TouchOSC setup of the documentation. All clients are on this
// machine; a remote sender is simulated by leaving its address out of the test's list of subnets.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/log/log.h"
#include "engine/everything.h"
#include "engine/image_of.h"
#include "net/osc/network.h"
#include "net/osc/packets/decode.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

// A Network with a client that appears to be in another network.
struct RemoteClientFixture {
  RemoteClientFixture() {
    OscOptions options;
    options.in = *parse_osc_in("0");
    options.out = *parse_osc_out("off");
    options.connected = [] { return std::vector<Cidr>{}; };
    network = std::make_unique<Network>(engine.link, std::move(options), kTestOffsets);
    EXPECT_TRUE(network->start().ok());
    end = network->bound().at(0);
    const auto spare = engine.link.snapshots.acquire_buffer();
    *spare = test_world({{"arm", 50}});
    engine.link.snapshots.publish(spare);
  }
  void send(const std::string& bytes) {
    sent += bytes.size();
    client.send(end, bytes);
  }
  // Returns the client's next message and counts its bytes.
  Message next() {
    const std::optional<std::string> bytes = client.receive();
    if (!bytes) return {"no reply", {}};
    received += bytes->size();
    const Result<Decoded> decoded = decode_packet(bytes->data(), bytes->size());
    return decoded && !decoded->messages.empty() ? decoded->messages[0] : Message{"no message", {}};
  }

  Client client;
  FakeEngine engine;
  std::unique_ptr<Network> network;
  Endpoint end;
  std::size_t sent = 0, received = 0;
};

TEST(NetworkLimits, LimitsRemoteSenderUntilTokenReturns) {
  log_to_stderr(false);
  RemoteClientFixture fixture;
  fixture.send(Bytes().text("/subscribe").text(",sf").text("pos").f(1000).str());
  const Message token = fixture.next();
  ASSERT_EQ(token.address, "/token");
  for (int i = 0; i < 200; i++) {
    fixture.send(Bytes().text("/ping").text(",").str());
    while (fixture.next().address != "/pong") continue;
    ASSERT_LE(fixture.received, 3 * fixture.sent);
  }
  fixture.send(Bytes().text("/token").text(",s").text(token.args.at(0).text).str());
  while (fixture.received < 6 * fixture.sent) ASSERT_NE(fixture.next().address, "no reply");
  EXPECT_GT(fixture.engine.link.health.count(engine::HealthItem::limited), 0u);
  log_to_stderr(true);
}

TEST(NetworkLimits, SendsNoTokenToLocalSender) {
  Client client;
  FakeEngine engine;
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out = *parse_osc_out("off");
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  const auto spare = engine.link.snapshots.acquire_buffer();
  *spare = test_world({{"arm", 50}});
  engine.link.snapshots.publish(spare);
  client.send(network.bound().at(0), Bytes().text("/subscribe").text(",sf").text("pos").f(1000).str());
  for (int i = 0; i < 20; i++) {
    const std::optional<std::string> frame = client.receive();
    ASSERT_TRUE(frame);
    EXPECT_TRUE(frame->starts_with("/physics/joint/pos"));
  }
}

struct LocalClientFixture {
  LocalClientFixture() {
    OscOptions options;
    options.in = *parse_osc_in("0");
    options.out = *parse_osc_out("off");
    network = std::make_unique<Network>(engine.link, std::move(options), kTestOffsets);
    EXPECT_TRUE(network->start().ok());
    end = network->bound().at(0);
  }
  CommandOrigin origin() const { return {CommandSource::osc, client.end().ip, client.end().port}; }
  // Sends a marker after all earlier messages of the engine.
  void send_mark() { engine.push_out({engine::Outgoing::Destination::direct, origin(), {"/mark", {}}}); }
  std::string next() const {
    const std::optional<std::string> bytes = client.receive();
    return bytes ? std::string(bytes->c_str()) : "nothing";
  }

  Client client;
  FakeEngine engine;
  std::unique_ptr<Network> network;
  Endpoint end;
};

TEST(NetworkLimits, NeverSendsToOwnInput) {
  log_to_stderr(false);
  const std::uint64_t warnings = log_count(LogLevel::warning);
  LocalClientFixture fixture;
  const CommandOrigin self{CommandSource::osc, fixture.end.ip, fixture.end.port};
  for (int i = 0; i < 5; i++) {
    fixture.engine.push_out({engine::Outgoing::Destination::direct, self, {"/loop", {}}});
    fixture.engine.push_out(
        {engine::Outgoing::Destination::error, self, {"/error", {Arg::of("/loop"), Arg::of("unknown")}}});
  }
  fixture.send_mark();
  EXPECT_EQ(fixture.next(), "/mark");
  fixture.client.send(fixture.end, Bytes().text("/after").text(",").str());
  ASSERT_TRUE(fixture.engine.wait_for(1));
  EXPECT_EQ(fixture.engine.commands.at(0).messages.at(0).address, "/after");
  EXPECT_EQ(fixture.engine.link.counters.received, 1u);
  EXPECT_EQ(fixture.engine.link.health.count(engine::HealthItem::loops), 1u);
  EXPECT_EQ(log_count(LogLevel::warning), warnings + 1) << "reported once";
  log_to_stderr(true);
}

TEST(NetworkLimits, SkipsTargetThatIsOwnInput) {
  log_to_stderr(false);
  LocalClientFixture fixture;
  auto plan = std::make_shared<OscConfig>();
  for (const std::uint16_t port : {fixture.end.port, fixture.client.end().port}) {
    StreamTarget target;
    target.host = "127.0.0.1";
    target.port = port;
    plan->targets.push_back(target);
  }
  // `--osc-out` is not given here, so that the second network uses the scene's plan
  OscOptions options;
  options.in = *parse_osc_in("127.0.0.1:" + std::to_string(fixture.end.port));
  fixture.network->stop();
  const auto spare = fixture.engine.link.osc_config.acquire_buffer();
  *spare = *plan;
  fixture.engine.link.osc_config.publish(spare);
  Network network(fixture.engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  const std::vector<std::string> lines = network.status_lines();
  EXPECT_EQ(std::ranges::count_if(lines, [](const std::string& line) { return line.starts_with("OSC out 127"); }), 1);
  network.stop();
  log_to_stderr(true);
}

TEST(NetworkLimits, StopsErrorLoop) {
  log_to_stderr(false);
  const std::uint64_t warnings = log_count(LogLevel::warning);
  LocalClientFixture fixture;
  const engine::Outgoing error{
      engine::Outgoing::Destination::error, fixture.origin(), {"/error", {Arg::of("/wrong"), Arg::of("unknown")}}};
  for (const char* answer : {"/Error/", "/failed"}) {
    LocalClientFixture other;
    const engine::Outgoing fault{
        engine::Outgoing::Destination::error, other.origin(), {"/error", {Arg::of("/wrong"), Arg::of("unknown")}}};
    other.engine.push_out(fault);
    ASSERT_EQ(other.next(), "/error");
    other.client.send(other.end, Bytes().text(answer).text(",ss").text("/error").text("no such address").str());
    ASSERT_TRUE(other.engine.wait_for(1)) << "it reaches the scene";
    for (int i = 0; i < 3; i++) other.engine.push_out(fault);
    other.engine.push_out({engine::Outgoing::Destination::direct, other.origin(), {"/mark", {}}});
    EXPECT_EQ(other.next(), "/mark") << answer;
    EXPECT_EQ(other.engine.link.health.count(engine::HealthItem::loops), 1u);
  }
  EXPECT_EQ(log_count(LogLevel::warning), warnings + 2) << "once each";
  // an /error is no answer if none was sent before, and other faulty messages are always answered
  fixture.client.send(fixture.end, Bytes().text("/error").text(",s").text("/x").str());
  ASSERT_TRUE(fixture.engine.wait_for(1));
  for (int i = 0; i < 3; i++) {
    fixture.engine.push_out(error);
    EXPECT_EQ(fixture.next(), "/error");
    fixture.client.send(fixture.end, Bytes().text("/wrong").text(",").str());
  }
  EXPECT_EQ(fixture.engine.link.health.count(engine::HealthItem::loops), 0u);
  log_to_stderr(true);
}

// docs/reference/osc.md, "Clients": --osc-in 0.0.0.0:9003, --osc-out TABLET:PORT, faders, buttons,
// /subscribe every 20 s
TEST(NetworkLimits, DocumentedTouchOscSetupWorks) {
  log_to_stderr(false);
  const engine::test::SceneFile file(engine::test::kEverything);
  engine::test::Show show(file.path());
  Client tablet;
  Client receiver;  // the tablet's port for incoming messages
  OscOptions options;
  options.in = *parse_osc_in("0.0.0.0:0");
  options.out = *parse_osc_out("127.0.0.1:" + std::to_string(receiver.end().port));
  Network network(show.link, options, engine::transient_offsets());
  ASSERT_TRUE(network.start().ok());
  const Endpoint end{0x7f000001, network.bound().at(0).port};
  // runs ticks until the client has received such a message
  const auto comes = [&](const Client& client, std::string_view begin) {
    for (int i = 0; i < kTimeoutMs / 5; i++) {
      show.ticks(1);
      const std::optional<std::string> bytes = client.receive(5);
      if (!bytes) continue;
      EXPECT_FALSE(bytes->starts_with("/token"));
      if (bytes->starts_with(begin)) return true;
    }
    return false;
  };
  // runs ticks until the property has this value
  const auto becomes = [&](const char* path, double value) {
    for (int i = 0; i < kTimeoutMs; i++) {
      show.ticks(1);
      if (std::abs(show.read(path) - value) < 1e-6) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  };
  EXPECT_TRUE(comes(receiver, "/physics/joint/pos")) << "--osc-out";
  tablet.send(end, Bytes().text("/subscribe").text(",s").text("/scene/wind").str());
  EXPECT_TRUE(comes(tablet, "/scene/wind"));
  tablet.send(end, Bytes().text("/scene/wind").text(",f").f(7).str());
  EXPECT_TRUE(becomes("/scene/wind", 7)) << "a fader";
  tablet.send(end, Bytes().text("/transport/pause").text(",f").f(1).str());
  EXPECT_TRUE(becomes("/physics/sim/paused", 1)) << "a button that is pressed";
  tablet.send(end, Bytes().text("/transport/play").text(",f").f(0).str());
  tablet.send(end, Bytes().text("/scene/wind").text(",f").f(3).str());
  EXPECT_TRUE(becomes("/scene/wind", 3));
  EXPECT_EQ(show.read("/physics/sim/paused"), 1) << "a button that is released";
  show.send("/scene/wind", 5);
  EXPECT_TRUE(comes(tablet, "/scene/wind")) << "set by another controller";
  EXPECT_EQ(show.link.health.count(engine::HealthItem::limited), 0u);
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::osc

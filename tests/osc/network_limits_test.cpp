// What the network thread sends to whom: tokens, loops, and the setup that the docs describe for TouchOSC. Clients are
// on this machine; a sender of another network is one whose address is in no subnet that the test names.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/log.h"
#include "engine/everything.h"
#include "engine/image_of.h"
#include "osc/decode.h"
#include "osc/network.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber {
namespace {

using namespace osc_test;

// an end whose client belongs to another network
struct FarDesk {
  FarDesk() {
    OscOptions options;
    options.in = *parse_osc_in("0");
    options.out = *parse_osc_out("off");
    options.connected = [] { return std::vector<Cidr>{}; };
    network = std::make_unique<Network>(engine.link, std::move(options), kTestOffsets);
    EXPECT_TRUE(network->start().ok());
    end = network->bound().at(0);
    const auto spare = engine.link.snapshots.spare();
    *spare = test_world({{"arm", 50}});
    engine.link.snapshots.publish(spare);
  }
  void send(const std::string& bytes) {
    sent += bytes.size();
    client.send(end, bytes);
  }
  // the next message to the client, which counts its bytes
  Message next() {
    const std::optional<std::string> bytes = client.receive();
    if (!bytes) return {"nothing came", {}};
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

TEST(NetworkLimits, AFarSenderGetsThreeBytesForOneUntilItReturnsTheToken) {
  log_to_stderr(false);
  FarDesk desk;
  desk.send(Bytes().text("/subscribe").text(",sf").text("pos").f(1000).str());
  const Message token = desk.next();
  ASSERT_EQ(token.address, "/token");
  for (int i = 0; i < 200; i++) {
    desk.send(Bytes().text("/ping").text(",").str());
    while (desk.next().address != "/pong") continue;
    ASSERT_LE(desk.received, 3 * desk.sent);
  }
  desk.send(Bytes().text("/token").text(",s").text(token.args.at(0).text).str());
  while (desk.received < 6 * desk.sent) ASSERT_NE(desk.next().address, "nothing came");
  EXPECT_GT(desk.engine.link.health.count(HealthItem::limited), 0u);
  log_to_stderr(true);
}

TEST(NetworkLimits, ANearSenderGetsNoToken) {
  Client client;
  FakeEngine engine;
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out = *parse_osc_out("off");
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  const auto spare = engine.link.snapshots.spare();
  *spare = test_world({{"arm", 50}});
  engine.link.snapshots.publish(spare);
  client.send(network.bound().at(0), Bytes().text("/subscribe").text(",sf").text("pos").f(1000).str());
  for (int i = 0; i < 20; i++) {
    const std::optional<std::string> frame = client.receive();
    ASSERT_TRUE(frame);
    EXPECT_TRUE(frame->starts_with("/physics/joint/pos"));
  }
}

struct NearDesk {
  NearDesk() {
    OscOptions options;
    options.in = *parse_osc_in("0");
    options.out = *parse_osc_out("off");
    network = std::make_unique<Network>(engine.link, std::move(options), kTestOffsets);
    EXPECT_TRUE(network->start().ok());
    end = network->bound().at(0);
  }
  Origin origin() const { return {Hand::osc, client.end().ip, client.end().port}; }
  // what the engine sends after all before
  void mark() { engine.say({Outgoing::To::direct, origin(), {"/mark", {}}}); }
  std::string next() const {
    const std::optional<std::string> bytes = client.receive();
    return bytes ? std::string(bytes->c_str()) : "nothing";
  }

  Client client;
  FakeEngine engine;
  std::unique_ptr<Network> network;
  Endpoint end;
};

TEST(NetworkLimits, NothingIsSentToTheProgramItself) {
  log_to_stderr(false);
  const std::uint64_t warnings = log_count(LogLevel::warning);
  NearDesk desk;
  const Origin self{Hand::osc, desk.end.ip, desk.end.port};
  for (int i = 0; i < 5; i++) {
    desk.engine.say({Outgoing::To::direct, self, {"/loop", {}}});
    desk.engine.say({Outgoing::To::error, self, {"/error", {Arg::of("/loop"), Arg::of("unknown")}}});
  }
  desk.mark();
  EXPECT_EQ(desk.next(), "/mark");
  desk.client.send(desk.end, Bytes().text("/after").text(",").str());
  ASSERT_TRUE(desk.engine.wait_for(1));
  EXPECT_EQ(desk.engine.commands.at(0).messages.at(0).address, "/after");
  EXPECT_EQ(desk.engine.link.counters.received, 1u);
  EXPECT_EQ(desk.engine.link.health.count(HealthItem::loops), 1u);
  EXPECT_EQ(log_count(LogLevel::warning), warnings + 1) << "reported once";
  log_to_stderr(true);
}

TEST(NetworkLimits, ATargetThatIsTheOwnInputIsLeftOut) {
  log_to_stderr(false);
  NearDesk desk;
  auto plan = std::make_shared<OscPlan>();
  for (const std::uint16_t port : {desk.end.port, desk.client.end().port}) {
    StreamTarget target;
    target.host = "127.0.0.1";
    target.port = port;
    plan->targets.push_back(target);
  }
  // the command line says "off", so the scene's plan is given to another network
  OscOptions options;
  options.in = *parse_osc_in("127.0.0.1:" + std::to_string(desk.end.port));
  desk.network->stop();
  const auto spare = desk.engine.link.osc_plan.spare();
  *spare = *plan;
  desk.engine.link.osc_plan.publish(spare);
  Network network(desk.engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  const std::vector<std::string> lines = network.lines();
  EXPECT_EQ(std::ranges::count_if(lines, [](const std::string& line) { return line.starts_with("OSC out 127"); }), 1);
  network.stop();
  log_to_stderr(true);
}

TEST(NetworkLimits, AProgramThatAnswersErrorsGetsNoMore) {
  log_to_stderr(false);
  const std::uint64_t warnings = log_count(LogLevel::warning);
  NearDesk desk;
  const Outgoing error{Outgoing::To::error, desk.origin(), {"/error", {Arg::of("/wrong"), Arg::of("unknown")}}};
  for (const char* answer : {"/Error/", "/failed"}) {
    NearDesk other;
    const Outgoing fault{Outgoing::To::error, other.origin(), {"/error", {Arg::of("/wrong"), Arg::of("unknown")}}};
    other.engine.say(fault);
    ASSERT_EQ(other.next(), "/error");
    other.client.send(other.end, Bytes().text(answer).text(",ss").text("/error").text("no such address").str());
    ASSERT_TRUE(other.engine.wait_for(1)) << "the scene hears it";
    for (int i = 0; i < 3; i++) other.engine.say(fault);
    other.engine.say({Outgoing::To::direct, other.origin(), {"/mark", {}}});
    EXPECT_EQ(other.next(), "/mark") << answer;
    EXPECT_EQ(other.engine.link.health.count(HealthItem::loops), 1u);
  }
  EXPECT_EQ(log_count(LogLevel::warning), warnings + 2) << "once each";
  // an /error to which nothing was sent before is no answer, and whoever errs otherwise is told each time
  desk.client.send(desk.end, Bytes().text("/error").text(",s").text("/x").str());
  ASSERT_TRUE(desk.engine.wait_for(1));
  for (int i = 0; i < 3; i++) {
    desk.engine.say(error);
    EXPECT_EQ(desk.next(), "/error");
    desk.client.send(desk.end, Bytes().text("/wrong").text(",").str());
  }
  EXPECT_EQ(desk.engine.link.health.count(HealthItem::loops), 0u);
  log_to_stderr(true);
}

// docs/osc.md, "Clients": --osc-in 0.0.0.0:9003, --osc-out TABLET:PORT, faders, buttons, /subscribe every 20 s
TEST(NetworkLimits, TheTouchOscSetupOfTheDocsWorks) {
  log_to_stderr(false);
  const engine_test::SceneFile file(engine_test::kEverything);
  engine_test::Show show(file.path());
  Client tablet;
  Client receiver;  // the tablet's port for what comes in
  OscOptions options;
  options.in = *parse_osc_in("0.0.0.0:0");
  options.out = *parse_osc_out("127.0.0.1:" + std::to_string(receiver.end().port));
  Network network(show.link, options, live_offsets());
  ASSERT_TRUE(network.start().ok());
  const Endpoint end{0x7f000001, network.bound().at(0).port};
  // ticks until the tablet has got that
  const auto comes = [&](const Client& client, std::string_view begin) {
    for (int i = 0; i < kPatienceMs / 5; i++) {
      show.ticks(1);
      const std::optional<std::string> bytes = client.receive(5);
      if (!bytes) continue;
      EXPECT_FALSE(bytes->starts_with("/token"));
      if (bytes->starts_with(begin)) return true;
    }
    return false;
  };
  // and until a row has that value
  const auto becomes = [&](const char* path, double value) {
    for (int i = 0; i < kPatienceMs; i++) {
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
  EXPECT_TRUE(comes(tablet, "/scene/wind")) << "another hand has set it";
  EXPECT_EQ(show.link.health.count(HealthItem::limited), 0u);
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber

// Changes of targets while the show plays.
#include "net/osc/targets/target_edits.h"

#include <gtest/gtest.h>

#include "base/log/log.h"
#include "net/osc/network.h"
#include "net/osc/packets/decode.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

Message target_message(const char* what, std::vector<const char*> texts = {}) {
  Message message{std::string("/osc/target/") + what, {}};
  for (const char* text : texts) message.args.push_back(Arg::of(text));
  return message;
}

// The edits, without a network.
struct EditsRig {
  std::string execute(const Message& message) {
    if (const Result<void> valid = edits.push(message, {}); !valid) return valid.error();
    (void)edits.drain();
    const Result<void> done = edits.execute(message, targets());
    return done ? targets_text(targets()) : done.error();
  }
  std::vector<StreamTarget> targets() const { return edits.applied_to(configured); }

  std::vector<StreamTarget> configured = {StreamTarget{}};
  TargetEdits edits;
};

TEST(TargetEdits, AddChangeRemoveReset) {
  EditsRig rig;
  const std::string usual = "127.0.0.1:9005 (pos+rot+relrot at 60 Hz)";
  EXPECT_EQ(rig.execute(target_message("add", {"[fd00::7]:9000", "rate=30"})),
            usual + "\n[fd00::7]:9000 (pos+rot+relrot at 30 Hz)");
  EXPECT_EQ(rig.execute(target_message("add", {"[fd00::7]:9000,streams=pos", "errors=on"})),
            usual + "\n[fd00::7]:9000 (pos at 30 Hz, errors)")
      << "settings that are not named stay";
  EXPECT_EQ(rig.execute(target_message("remove", {"127.0.0.1:9005"})), "[fd00::7]:9000 (pos at 30 Hz, errors)");
  EXPECT_EQ(rig.execute(target_message("add", {"127.0.0.1:9005"})), usual + "\n[fd00::7]:9000 (pos at 30 Hz, errors)")
      << "in its place";
  EXPECT_EQ(rig.execute(target_message("reset")), usual);
  EXPECT_EQ(rig.execute(target_message("remove", {"127.0.0.1:9005"})), "");
}

TEST(TargetEdits, KeepTemplatesOfTheScene) {
  EditsRig rig;
  rig.configured[0].messages.push_back({.address = "/x", .objects = "/physics/body/*", .values = {"position"}});
  (void)rig.execute(target_message("add", {"127.0.0.1:9005", "rate=10"}));
  ASSERT_EQ(rig.targets().size(), 1U);
  EXPECT_EQ(rig.targets()[0].rate, 10);
  EXPECT_EQ(rig.targets()[0].messages, rig.configured[0].messages);
}

TEST(TargetEdits, RejectsBadInput) {
  EditsRig rig;
  EXPECT_EQ(rig.execute(target_message("add", {"nowhere"})),
            "'nowhere': 'nowhere' is not HOST:PORT; write "
            "HOST:PORT[,rate=60,bundle=1472,streams=pos+rot,bodies=arm*,errors=on]");
  for (const char* host : {"two words:9000", "new\nline:9000", "\x1b[2J:9000", "a (b:9000"})
    EXPECT_NE(rig.execute(target_message("add", {host})).find("is not HOST:PORT"), std::string::npos) << host;
  EXPECT_NE(rig.execute(target_message("add", {"h:1", "rate=0"})).find("rate must be 0.1 to 1000"), std::string::npos);
  EXPECT_EQ(rig.execute(target_message("remove", {"h:1"})), "there is no target h:1; /list/targets lists them");
  EXPECT_EQ(rig.execute(target_message("add", {std::string(2000, 'x').c_str()})), "the text has more than 1024 bytes");
  for (std::size_t i = 1; i < TargetEdits::kMaxTargets; i++)
    (void)rig.execute(target_message("add", {fmt::format("h:{}", i).c_str()}));
  EXPECT_EQ(rig.execute(target_message("add", {"h:9999"})), "there are 64 targets; remove one with /osc/target/remove");
  // removing and adding others never ends
  for (int i = 100; i < 1000; i++) {
    ASSERT_EQ(rig.targets().size(), TargetEdits::kMaxTargets);
    const std::string last = fmt::format("h:{}", i == 100 ? 63 : i - 1);
    (void)rig.execute(target_message("remove", {last.c_str()}));
    (void)rig.execute(target_message("add", {fmt::format("h:{}", i).c_str()}));
  }
}

struct TargetFixture {
  explicit TargetFixture(bool remote = false) : network(engine.link, options(remote), kTestOffsets) {
    EXPECT_TRUE(network.start().ok());
    const auto spare = engine.link.snapshots.acquire_buffer();
    *spare = test_world({{"arm", 3}});
    engine.link.snapshots.publish(spare);
  }
  static OscOptions options(bool remote) {
    OscOptions options;
    options.in = *parse_osc_in("0");
    options.out.emplace();
    if (remote) options.connected = [] { return std::vector<Cidr>{}; };
    return options;
  }
  // As the engine calls it.
  Result<void> request(const Message& message) {
    return engine.link.on_osc_request(message, {CommandSource::osc, client.end().ip, client.end().port});
  }
  std::string next() { return client.receive().value_or("nothing"); }

  Client client, target;
  FakeEngine engine;
  Network network;
};

TEST(TargetEdits, StreamsFollow) {
  log_to_stderr(false);
  TargetFixture fixture;
  const std::string name = endpoint_text(fixture.target.end());
  ASSERT_TRUE(fixture.request(target_message("add", {name.c_str(), "rate=1000,streams=rot"})).ok());
  EXPECT_TRUE(fixture.target.receive().value_or("").starts_with("/physics/joint/rot"));
  ASSERT_TRUE(fixture.request({"/list/targets", {}}).ok());
  EXPECT_EQ(fixture.next(), Bytes().text("/list/targets").text(",s").text(name + " (rot at 1000 Hz)").str());
  EXPECT_EQ(fixture.engine.link.osc.targets(), name + " (rot at 1000 Hz)");
  // a new scene keeps the change
  fixture.engine.link.osc_config.publish(std::make_shared<OscConfig>());
  fixture.engine.link.wake_network();
  ASSERT_TRUE(fixture.request(target_message("remove", {name.c_str()})).ok());
  ASSERT_TRUE(fixture.request({"/list/targets", {}}).ok());
  EXPECT_EQ(fixture.next(), Bytes().text("/list/targets").text(",s").text("").str());
  ASSERT_TRUE(fixture.request(target_message("remove", {name.c_str()})).ok());
  EXPECT_EQ(fixture.next(), Bytes()
                                .text("/error")
                                .text(",ss")
                                .text("/osc/target/remove")
                                .text("there is no target " + name + "; /list/targets lists them")
                                .str());
  EXPECT_FALSE(fixture.request(target_message("add", {"nowhere"})).ok());
  log_to_stderr(true);
}

TEST(TargetEdits, SendersOfOtherNetworksNeedAToken) {
  log_to_stderr(false);
  TargetFixture fixture(true);
  ASSERT_TRUE(fixture.request(target_message("add", {"127.0.0.1:9"})).ok());
  for (int ms = 0; fixture.engine.link.counters.refused == 0 && ms < kTimeoutMs; ms++) (void)fixture.target.receive(1);
  EXPECT_EQ(fixture.engine.link.counters.refused, 1U);
  EXPECT_EQ(fixture.engine.link.osc.targets(), "");
  // the panel is on this machine
  ASSERT_TRUE(fixture.engine.link.on_osc_request(target_message("add", {"127.0.0.1:9"}), {CommandSource::panel}).ok());
  for (int ms = 0; fixture.engine.link.osc.targets().empty() && ms < kTimeoutMs; ms++) (void)fixture.target.receive(1);
  EXPECT_EQ(fixture.engine.link.osc.targets(), "127.0.0.1:9 (pos+rot+relrot at 60 Hz)");
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::osc

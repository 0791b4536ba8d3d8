// The protocol of one client without a socket: commands, values, path events, replies, the log.
#include "net/oscquery/client.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/log/log.h"
#include "engine/everything.h"
#include "engine/image_of.h"
#include "oscquery/fake_doors.h"

namespace limber::oscquery::test {
namespace {

using engine::test::make_value_snapshot;
using nlohmann::json;
using Frames = std::vector<std::string>;

struct FillingSink : ClientSink {
  Frames frames;
  std::size_t full = 0;

  void send(bool text, std::string frame) override { frames.push_back((text ? "t " : "b ") + frame); }
  std::size_t queued_bytes() const override { return full; }
  Frames consume_frames() { return std::exchange(frames, {}); }
};

struct ClientFixture {
  engine::test::SceneFile file{engine::test::kEverything};
  engine::test::Show show{file.path()};
  std::vector<std::pair<CommandOrigin, std::string>> packets;
  QueryHost host = fake_query_host(&packets);
  FillingSink sink;
  QueryClient client{{CommandSource::oscquery, 0x7f000001, 77}, sink, host};

  ClientFixture() { show.send("/transport/pause"); }
  Frames new_frames() {
    client.on_snapshot(make_value_snapshot(show), {});
    return sink.consume_frames();
  }
};

std::string command(const std::string& word, const std::string& path) {
  return json{{"COMMAND", word}, {"DATA", path}}.dump();
}

TEST(QueryClient, HandlesListenAndIgnore) {
  ClientFixture fixture;
  EXPECT_EQ(fixture.new_frames(), Frames{});
  EXPECT_TRUE(fixture.client.on_text(command("LISTEN", "/scene/wind")));
  EXPECT_TRUE(fixture.client.is_listening());
  EXPECT_EQ(fixture.new_frames(), Frames{"b /scene/wind f 0"});
  EXPECT_EQ(fixture.new_frames(), Frames{});
  fixture.show.send("/scene/wind", 2);
  EXPECT_EQ(fixture.new_frames(), Frames{"b /scene/wind f 2"});
  EXPECT_FALSE(fixture.client.on_text(command("IGNORE", "/scene/wind")));
  EXPECT_FALSE(fixture.client.is_listening());
  fixture.show.send("/scene/wind", 3);
  EXPECT_EQ(fixture.new_frames(), Frames{});
}

TEST(QueryClient, SendsValuesWithTypeTags) {
  ClientFixture fixture;
  for (const char* path : {"/scene/style", "/scene/lively", "/scene/where", "/physics/body/arm/part/base/rotation",
                           "/physics/sim/seed", "/physics/sim/substeps"})
    fixture.client.on_text(command("LISTEN", path));
  EXPECT_EQ(fixture.new_frames(), (Frames{"b /scene/style s calm", "b /scene/lively T 1", "b /scene/where fff 0 0 1",
                                          "b /physics/body/arm/part/base/rotation [ffff] 0 0 0 1",
                                          "b /physics/sim/seed h 1", "b /physics/sim/substeps i 4"}));
}

TEST(QueryClient, IgnoresUnknownCommands) {
  ClientFixture fixture;
  std::string deep(60000, '[');
  const std::vector<std::string> none = {"",
                                         "{",
                                         "[]",
                                         "null",
                                         "1e999",
                                         "\"LISTEN\"",
                                         deep,
                                         "\xff\xfe",
                                         R"({"COMMAND":"LISTEN"})",
                                         R"({"DATA":"/scene/wind"})",
                                         R"({"COMMAND":1,"DATA":"/scene/wind"})",
                                         R"({"COMMAND":"LISTEN","DATA":1})",
                                         R"({"COMMAND":"LISTEN","DATA":["/scene/wind"]})",
                                         R"({"COMMAND":"LISTEN","DATA":{"a":{}}})",
                                         R"({"COMMAND":"LAUGH","DATA":"/scene/wind"})",
                                         R"({"COMMAND":"IGNORE","DATA":"/never"})",
                                         R"({"COMMAND":"LIMBER_LOG","DATA":"on"})"};
  for (const std::string& frame : none) EXPECT_FALSE(fixture.client.on_text(frame)) << frame.substr(0, 50);
  // listening to invalid paths is harmless
  for (const char* path : {"", "/", "scene", "/scene", "/nowhere", "/transport/play", "/a\nb"})
    fixture.client.on_text(command("LISTEN", path));
  EXPECT_EQ(fixture.new_frames(), Frames{});
  fixture.client.on_text(command("LISTEN", "/scene/wind"));
  EXPECT_EQ(fixture.new_frames(), Frames{"b /scene/wind f 0"}) << "after all that it is served";
}

TEST(QueryClient, ForwardsPacketsWithOrigin) {
  ClientFixture fixture;
  fixture.client.on_binary("abc");
  fixture.client.on_text(command("LISTEN", "/scene/wind"));
  fixture.client.on_binary("def");
  ASSERT_EQ(fixture.packets.size(), 2u);
  EXPECT_EQ(fixture.packets[0].second, "abc");
  EXPECT_EQ(fixture.packets[0].first.source, CommandSource::oscquery);
  EXPECT_EQ(fixture.packets[0].first.port, 77);
  EXPECT_FALSE(fixture.packets[0].first.is_subscriber);
  EXPECT_TRUE(fixture.packets[1].first.is_subscriber) << "listening clients get no echo";
}

TEST(QueryClient, DoesNotEchoOwnValues) {
  ClientFixture fixture;
  fixture.client.on_text(command("LISTEN", "/scene/wind"));
  fixture.new_frames();
  CommandOrigin self = fixture.client.origin();
  fixture.show.link.command_queue.push({{engine::test::message("/scene/wind", 5)}, self});
  EXPECT_EQ(fixture.new_frames(), Frames{});
  self.port = 78;
  fixture.show.link.command_queue.push({{engine::test::message("/scene/wind", 6)}, self});
  EXPECT_EQ(fixture.new_frames(), Frames{"b /scene/wind f 6"});
}

TEST(QueryClient, SkipsValuesForSlowClient) {
  ClientFixture fixture;
  fixture.client.on_text(command("LISTEN", "/scene/wind"));
  fixture.new_frames();
  fixture.sink.full = QueryClient::kMaxQueuedForValues;
  for (int i = 1; i < 9; i++) {
    fixture.show.send("/scene/wind", i);
    EXPECT_EQ(fixture.new_frames(), Frames{});
  }
  fixture.sink.full = 0;
  EXPECT_EQ(fixture.new_frames(), Frames{"b /scene/wind f 8"});
}

TEST(QueryClient, SendsPathEventsAndReplies) {
  ClientFixture fixture;
  const Frames notices = {R"({"COMMAND":"PATH_ADDED","DATA":"/x"})"};
  fixture.client.on_snapshot(make_value_snapshot(fixture.show), notices);
  EXPECT_EQ(fixture.sink.consume_frames(), Frames{"t " + notices[0]});
  fixture.client.send_reply({engine::Outgoing::Destination::reply, {}, engine::test::message("/scene/wind", 0.5)}, 0);
  EXPECT_EQ(fixture.sink.consume_frames(), Frames{"b /scene/wind  0.5"});
}

TEST(QueryClient, LimitsErrorsToTenPerSecond) {
  ClientFixture fixture;
  const engine::Outgoing error{engine::Outgoing::Destination::error, {}, engine::error_message("/a", "b")};
  for (int i = 0; i < 30; i++) fixture.client.send_reply(error, 5.0 + 0.01 * i);
  EXPECT_EQ(fixture.sink.consume_frames().size(), 10u);
  fixture.client.send_reply(error, 6.01);
  EXPECT_EQ(fixture.sink.consume_frames(), Frames{"b /error  /a b"});
}

TEST(QueryClient, SendsLogOnRequest) {
  ClientFixture fixture;
  log_to_stderr(false);
  log_warning("before it came");
  fixture.client.send_log();
  EXPECT_EQ(fixture.sink.consume_frames(), Frames{});
  fixture.client.on_text(R"({"COMMAND":"LIMBER_LOG","DATA":true})");
  Frames frames = fixture.sink.consume_frames();
  ASSERT_EQ(frames.size(), 1u);
  json lines = json::parse(frames[0].substr(2));
  EXPECT_EQ(lines["COMMAND"], "LIMBER_LOG");
  EXPECT_EQ(lines["DATA"].back(), (json{{"LEVEL", "warning"}, {"TEXT", "before it came"}}));
  fixture.client.send_log();
  EXPECT_EQ(fixture.sink.consume_frames(), Frames{}) << "nothing new";
  log_error("a \"fault\"\nof two lines");
  fixture.client.send_log();
  frames = fixture.sink.consume_frames();
  ASSERT_EQ(frames.size(), 1u);
  lines = json::parse(frames[0].substr(2));
  ASSERT_EQ(lines["DATA"].size(), 1u);
  EXPECT_EQ(lines["DATA"][0]["LEVEL"], "error");
  fixture.client.on_text(R"({"COMMAND":"LIMBER_LOG","DATA":false})");
  log_error("unheard");
  fixture.client.send_log();
  EXPECT_EQ(fixture.sink.consume_frames(), Frames{});
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::oscquery::test

// One client's conversation, without a socket: commands, values, notices, answers, the log.
#include "query/client.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "engine/everything.h"
#include "engine/image_of.h"
#include "query/fake_doors.h"

namespace limber::query_test {
namespace {

using engine_test::image_of;
using nlohmann::json;
using Frames = std::vector<std::string>;

struct FillingLine : ClientLine {
  Frames frames;
  std::size_t full = 0;

  void send(bool text, std::string frame) override { frames.push_back((text ? "t " : "b ") + frame); }
  std::size_t waiting() const override { return full; }
  Frames take() { return std::exchange(frames, {}); }
};

struct ClientStage {
  engine_test::SceneFile file{engine_test::kEverything};
  engine_test::Show show{file.path()};
  std::vector<std::pair<Origin, std::string>> packets;
  QueryDoors doors = fake_doors(&packets);
  FillingLine line;
  Client client{{Hand::query, 0x7f000001, 77}, line, doors};

  ClientStage() { show.send("/transport/pause"); }
  Frames news() {
    client.image(image_of(show), {});
    return line.take();
  }
};

std::string command(const std::string& word, const std::string& path) {
  return json{{"COMMAND", word}, {"DATA", path}}.dump();
}

TEST(Client, ListensAndIgnores) {
  ClientStage stage;
  EXPECT_EQ(stage.news(), Frames{});
  EXPECT_TRUE(stage.client.text(command("LISTEN", "/scene/wind")));
  EXPECT_TRUE(stage.client.listens());
  EXPECT_EQ(stage.news(), Frames{"b /scene/wind f 0"});
  EXPECT_EQ(stage.news(), Frames{});
  stage.show.send("/scene/wind", 2);
  EXPECT_EQ(stage.news(), Frames{"b /scene/wind f 2"});
  EXPECT_FALSE(stage.client.text(command("IGNORE", "/scene/wind")));
  EXPECT_FALSE(stage.client.listens());
  stage.show.send("/scene/wind", 3);
  EXPECT_EQ(stage.news(), Frames{});
}

TEST(Client, ValuesComeAsTheTreeSaysTheyAre) {
  ClientStage stage;
  for (const char* path : {"/scene/style", "/scene/lively", "/scene/where", "/physics/body/arm/part/base/rotation",
                           "/physics/sim/seed", "/physics/sim/substeps"})
    stage.client.text(command("LISTEN", path));
  EXPECT_EQ(stage.news(), (Frames{"b /scene/style s calm", "b /scene/lively T 1", "b /scene/where fff 0 0 1",
                                  "b /physics/body/arm/part/base/rotation [ffff] 0 0 0 1", "b /physics/sim/seed h 1",
                                  "b /physics/sim/substeps i 4"}));
}

TEST(Client, WhatIsNoCommandIsLeftAlone) {
  ClientStage stage;
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
  for (const std::string& frame : none) EXPECT_FALSE(stage.client.text(frame)) << frame.substr(0, 50);
  // paths that are none are waited for, and never come
  for (const char* path : {"", "/", "scene", "/scene", "/nowhere", "/transport/play", "/a\nb"})
    stage.client.text(command("LISTEN", path));
  EXPECT_EQ(stage.news(), Frames{});
  stage.client.text(command("LISTEN", "/scene/wind"));
  EXPECT_EQ(stage.news(), Frames{"b /scene/wind f 0"}) << "after all that it is served";
}

TEST(Client, PacketsAreHandedOnWithWhoSentThem) {
  ClientStage stage;
  stage.client.binary("abc");
  stage.client.text(command("LISTEN", "/scene/wind"));
  stage.client.binary("def");
  ASSERT_EQ(stage.packets.size(), 2u);
  EXPECT_EQ(stage.packets[0].second, "abc");
  EXPECT_EQ(stage.packets[0].first.hand, Hand::query);
  EXPECT_EQ(stage.packets[0].first.port, 77);
  EXPECT_FALSE(stage.packets[0].first.follows);
  EXPECT_TRUE(stage.packets[1].first.follows) << "who listens is not told what it sets itself";
}

TEST(Client, WhatItSetsItselfIsNotToldBack) {
  ClientStage stage;
  stage.client.text(command("LISTEN", "/scene/wind"));
  stage.news();
  Origin self = stage.client.origin();
  stage.show.link.inbox.push({{engine_test::message("/scene/wind", 5)}, self});
  EXPECT_EQ(stage.news(), Frames{});
  self.port = 78;
  stage.show.link.inbox.push({{engine_test::message("/scene/wind", 6)}, self});
  EXPECT_EQ(stage.news(), Frames{"b /scene/wind f 6"});
}

TEST(Client, ASlowOneGetsTheNewestWhenItHasRoom) {
  ClientStage stage;
  stage.client.text(command("LISTEN", "/scene/wind"));
  stage.news();
  stage.line.full = Client::kRoom;
  for (int i = 1; i < 9; i++) {
    stage.show.send("/scene/wind", i);
    EXPECT_EQ(stage.news(), Frames{});
  }
  stage.line.full = 0;
  EXPECT_EQ(stage.news(), Frames{"b /scene/wind f 8"});
}

TEST(Client, NoticesAndAnswersAreSent) {
  ClientStage stage;
  const Frames notices = {R"({"COMMAND":"PATH_ADDED","DATA":"/x"})"};
  stage.client.image(image_of(stage.show), notices);
  EXPECT_EQ(stage.line.take(), Frames{"t " + notices[0]});
  stage.client.answer({Outgoing::To::sender, {}, engine_test::message("/scene/wind", 0.5)}, 0);
  EXPECT_EQ(stage.line.take(), Frames{"b /scene/wind  0.5"});
}

TEST(Client, TenErrorsASecond) {
  ClientStage stage;
  const Outgoing error{Outgoing::To::error, {}, error_message("/a", "b")};
  for (int i = 0; i < 30; i++) stage.client.answer(error, 5.0 + 0.01 * i);
  EXPECT_EQ(stage.line.take().size(), 10u);
  stage.client.answer(error, 6.01);
  EXPECT_EQ(stage.line.take(), Frames{"b /error  /a b"});
}

TEST(Client, TheLogForWhoAsks) {
  ClientStage stage;
  log_to_stderr(false);
  log_warning("before it came");
  stage.client.log();
  EXPECT_EQ(stage.line.take(), Frames{});
  stage.client.text(R"({"COMMAND":"LIMBER_LOG","DATA":true})");
  Frames frames = stage.line.take();
  ASSERT_EQ(frames.size(), 1u);
  json lines = json::parse(frames[0].substr(2));
  EXPECT_EQ(lines["COMMAND"], "LIMBER_LOG");
  EXPECT_EQ(lines["DATA"].back(), (json{{"LEVEL", "warning"}, {"TEXT", "before it came"}}));
  stage.client.log();
  EXPECT_EQ(stage.line.take(), Frames{}) << "nothing new";
  log_error("a \"fault\"\nof two lines");
  stage.client.log();
  frames = stage.line.take();
  ASSERT_EQ(frames.size(), 1u);
  lines = json::parse(frames[0].substr(2));
  ASSERT_EQ(lines["DATA"].size(), 1u);
  EXPECT_EQ(lines["DATA"][0]["LEVEL"], "error");
  stage.client.text(R"({"COMMAND":"LIMBER_LOG","DATA":false})");
  log_error("unheard");
  stage.client.log();
  EXPECT_EQ(stage.line.take(), Frames{});
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::query_test

// Requests wait for an image, not for ever; clients are told on the beat.
#include "query/hall.h"

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "query/fake_doors.h"

namespace limber::query_test {
namespace {

using Frames = std::vector<std::string>;

double the_time = 100;
double read_time() { return the_time; }

struct FrameLine : ClientLine {
  Frames frames;
  void send(bool, std::string frame) override { frames.push_back(std::move(frame)); }
  std::size_t waiting() const override { return 0; }
  Frames take() { return std::exchange(frames, {}); }
};

struct HallStage {
  engine_test::SceneFile file{engine_test::kEverything};
  engine_test::Show show{file.path()};
  QueryDoors doors = fake_doors();
  Hall hall{show.link, doors, {}, &read_time};
  std::vector<HttpAnswer> answers;

  HallStage() { show.send("/transport/pause"); }
  void ask(const std::string& target) {
    HttpRequest request;
    request.method = "GET";
    request.target = target;
    request.host = "localhost";
    hall.ask(request, [this](HttpAnswer answer) { answers.push_back(std::move(answer)); });
  }
  // the engine makes what was asked for, and the bell rings
  void image() {
    const std::uint64_t ask = show.link.image_asks.load();
    for (int i = 0; i < 1000000; i++) {
      show.ticks(1);
      const auto made = show.link.images.read();
      if (made != nullptr && made->asks >= ask) break;
    }
    hall.bell();
  }
};

TEST(Hall, ARequestWaitsForAnImageOfAfterItCame) {
  HallStage stage;
  engine_test::image_of(stage.show);
  stage.show.send("/scene/wind", 7);
  stage.ask("/scene/wind?VALUE");
  stage.hall.bell();
  EXPECT_TRUE(stage.answers.empty()) << "the image that there is was made before";
  EXPECT_TRUE(stage.hall.busy());
  stage.image();
  ASSERT_EQ(stage.answers.size(), 1u);
  EXPECT_EQ(stage.answers[0].body, R"({"VALUE":[7]})");
  EXPECT_FALSE(stage.hall.busy());
}

TEST(Hall, WhatNeedsNoTreeIsAnsweredAtOnce) {
  HallStage stage;
  stage.ask("/?HOST_INFO");
  stage.ask("/?NONSENSE");
  ASSERT_EQ(stage.answers.size(), 2u);
  EXPECT_EQ(stage.answers[0].status, 200);
  EXPECT_EQ(stage.answers[1].status, 400);
  EXPECT_EQ(stage.show.link.image_asks.load(), 0u);
}

TEST(Hall, PatienceEnds) {
  HallStage stage;
  stage.ask("/scene/wind?VALUE");
  the_time += Hall::kPatience - 0.01;
  stage.hall.beat();
  EXPECT_TRUE(stage.answers.empty());
  the_time += 0.02;
  stage.hall.beat();
  ASSERT_EQ(stage.answers.size(), 1u);
  EXPECT_EQ(stage.answers[0].status, 503);
  // with an image from before, that one is better than nothing
  engine_test::image_of(stage.show);
  stage.ask("/scene/wind?VALUE");
  the_time += Hall::kPatience + 0.01;
  stage.hall.beat();
  ASSERT_EQ(stage.answers.size(), 2u);
  EXPECT_EQ(stage.answers[1].body, R"({"VALUE":[0]})");
}

TEST(Hall, TooManyWaitingAreTurnedAway) {
  HallStage stage;
  for (std::size_t i = 0; i < Hall::kMostWaiting; i++) stage.ask("/scene/wind?VALUE");
  EXPECT_TRUE(stage.answers.empty());
  stage.ask("/scene/wind?VALUE");
  ASSERT_EQ(stage.answers.size(), 1u);
  EXPECT_EQ(stage.answers[0].status, 503);
  stage.image();
  EXPECT_EQ(stage.answers.size(), Hall::kMostWaiting + 1);
}

TEST(Hall, ClientsHearOnTheBeatAndNotMoreOften) {
  HallStage stage;
  FrameLine line;
  Client client({Hand::query, 1, 1}, line, stage.hall.doors());
  stage.hall.enter(client);
  client.text(R"({"COMMAND":"LISTEN","DATA":"/scene/wind"})");
  stage.image();
  EXPECT_EQ(line.take(), Frames{"/scene/wind f 0"});
  // images that others ask for are not told
  stage.show.send("/scene/wind", 1);
  engine_test::image_of(stage.show);
  stage.hall.bell();
  EXPECT_EQ(line.take(), Frames{});
  const std::uint64_t asks = stage.show.link.image_asks.load();
  the_time += Hall::kBeat;
  stage.hall.beat();
  stage.hall.beat();
  EXPECT_EQ(stage.show.link.image_asks.load(), asks + 1) << "one is on its way";
  stage.image();
  EXPECT_EQ(line.take(), Frames{"/scene/wind f 1"});
  stage.hall.leave(client);
  EXPECT_FALSE(stage.hall.busy());
}

TEST(Hall, ThoseWhoOnlyAreThereCostFewImages) {
  HallStage stage;
  FrameLine line;
  Client client({Hand::query, 1, 1}, line, stage.hall.doors());
  stage.hall.enter(client);
  const std::uint64_t asks = stage.show.link.image_asks.load();
  for (int i = 0; i < 60; i++) {
    the_time += Hall::kBeat;
    stage.hall.beat();
    stage.image();
  }
  EXPECT_LE(stage.show.link.image_asks.load() - asks, 11u) << "2 s, five a second";
  // and yet they hear of what comes
  ASSERT_TRUE(stage.show.engine.world().add_body("new").ok());
  for (int i = 0; i < 7; i++) {
    the_time += Hall::kBeat;
    stage.hall.beat();
    stage.image();
  }
  EXPECT_EQ(line.take(), Frames{R"({"COMMAND":"PATH_ADDED","DATA":"/physics/body/new"})"});
  stage.hall.leave(client);
}

// one who asks again and again must not keep the others from their values
TEST(Hall, HurryingDoesNotPutOffWhatIsOnItsWay) {
  HallStage stage;
  FrameLine line;
  Client client({Hand::query, 1, 1}, line, stage.hall.doors());
  stage.hall.enter(client);
  client.text(R"({"COMMAND":"LISTEN","DATA":"/scene/wind"})");
  const std::uint64_t ask = stage.show.link.image_asks.load();
  for (int i = 0; i < 100; i++) stage.hall.hurry();
  EXPECT_EQ(stage.show.link.image_asks.load(), ask);
  stage.image();
  EXPECT_EQ(line.take(), Frames{"/scene/wind f 0"});
  EXPECT_EQ(stage.show.link.image_asks.load(), ask + 1) << "one more for all who hurried";
  stage.hall.leave(client);
}

TEST(Hall, AnswersGoToWhoAsked) {
  HallStage stage;
  FrameLine one;
  FrameLine two;
  Client first({Hand::query, 1, 1}, one, stage.hall.doors());
  Client second({Hand::query, 1, 2}, two, stage.hall.doors());
  stage.hall.enter(first);
  stage.hall.enter(second);
  stage.show.link.inbox.push({{engine_test::message("/get", "/scene/wind")}, second.origin()});
  stage.show.link.inbox.push({{engine_test::message("/scene/wind", "much")}, first.origin()});
  stage.show.link.inbox.push({{engine_test::message("/get", "/scene/wind")}, {Hand::query, 1, 3}});
  stage.show.ticks(1);
  stage.hall.bell();
  EXPECT_EQ(two.take(), Frames{"/scene/wind  0"});
  EXPECT_EQ(one.take(), Frames{"/error  /scene/wind takes 1 number, not 'much'"});
  stage.hall.leave(first);
  stage.hall.leave(second);
}

}  // namespace
}  // namespace limber::query_test

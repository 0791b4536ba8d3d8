// What a client is told: the newest value where it is not what it knows, once, and never what it set itself.
#include "engine/feed.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "engine/show.h"

namespace limber::engine_test {
namespace {

using Told = std::vector<std::string>;

// one who follows, on its way to a show
struct Hearer {
  Origin self;
  Feed feed;

  explicit Hearer(std::uint16_t port) : self{Hand::osc, 0x7f000001, port, true} {}

  template <class... A>
  void send(Show& show, std::string address, A&&... args) const {
    show.link.inbox.push({{message(std::move(address), std::forward<A>(args)...)}, self});
  }
  void hear(Show& show) { feed.hear(image_of(show), self); }
  Told told(std::size_t room = 1000) {
    Told list;
    feed.tell([&](const std::string& path, const Row& row, const RowValue& value) {
      if (list.size() >= room) return false;
      std::string text = path;
      for (std::uint32_t i = 0; i < row.width; i++) text += " " + number_text(value.numbers[i]);
      list.push_back(std::move(text));
      return true;
    });
    return list;
  }
  Told news(Show& show) {
    hear(show);
    return told();
  }
};

struct Stage {
  SceneFile file{kEverything};
  Show show{file.path()};
  Hearer a{1};
  Hearer b{2};

  Stage() { show.send("/transport/pause"); }
  void follow(const std::string& path) {
    a.feed.add(path);
    b.feed.add(path);
    a.news(show);
    b.news(show);
  }
};

TEST(Feed, TellsTheValueAtFirstThenChangesOnly) {
  Stage stage;
  EXPECT_TRUE(stage.a.feed.add("/scene/wind"));
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 0"});
  EXPECT_EQ(stage.a.news(stage.show), Told{});
  stage.show.send("/scene/wind", 3);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 3"});
  EXPECT_EQ(stage.a.news(stage.show), Told{});
  // asked for again: told again
  EXPECT_TRUE(stage.a.feed.add("/scene/wind"));
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 3"});
  EXPECT_TRUE(stage.a.feed.remove("/scene/wind"));
  EXPECT_FALSE(stage.a.feed.remove("/scene/wind"));
  stage.show.send("/scene/wind", 4);
  EXPECT_EQ(stage.a.news(stage.show), Told{});
}

TEST(Feed, OneHandsChangeReachesTheOthersAndNotItself) {
  Stage stage;
  stage.follow("/scene/wind");
  stage.a.send(stage.show, "/scene/wind", 5);
  EXPECT_EQ(stage.a.news(stage.show), Told{});
  EXPECT_EQ(stage.b.news(stage.show), Told{"/scene/wind 5"});
  EXPECT_EQ(stage.b.news(stage.show), Told{});
  // and the same by a message that names things by arguments
  stage.follow("/physics/body/arm/part/hat/friction");
  stage.b.send(stage.show, "/physics/part/friction", "arm", 0.25);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/physics/body/arm/part/hat/friction 0.25"});
  EXPECT_EQ(stage.b.news(stage.show), Told{});
}

TEST(Feed, AMovingSliderHearsNothingOfItself) {
  Stage stage;
  stage.follow("/scene/wind");
  // values go on coming between images, and some images are not heard
  for (int i = 0; i < 40; i++) {
    stage.a.send(stage.show, "/scene/wind", 0.125 * i);
    if (i % 3 == 0) stage.show.ticks(1);
    if (i % 7 == 0) image_of(stage.show);
    EXPECT_EQ(stage.a.news(stage.show), Told{}) << i;
  }
  EXPECT_EQ(stage.b.news(stage.show), Told{"/scene/wind 4.875"}) << "only the newest";
}

TEST(Feed, TheLastOfTwoHandsWinsAndTheOtherHearsIt) {
  Stage stage;
  stage.follow("/scene/wind");
  stage.a.send(stage.show, "/scene/wind", 5);
  stage.b.send(stage.show, "/scene/wind", 7);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 7"});
  EXPECT_EQ(stage.b.news(stage.show), Told{});
}

TEST(Feed, WhatAnotherHandSetsBackIsTold) {
  Stage stage;
  stage.follow("/scene/wind");
  stage.a.send(stage.show, "/scene/wind", 5);
  stage.b.send(stage.show, "/scene/wind", 0);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 0"}) << "it believes 5, though 0 is what it was told";
  EXPECT_EQ(stage.b.news(stage.show), Told{}) << "it believes 0";
  stage.a.send(stage.show, "/scene/wind", 0);
  EXPECT_EQ(stage.a.news(stage.show), Told{});
  EXPECT_EQ(stage.b.news(stage.show), Told{});
}

TEST(Feed, WhatTheRangeMadeOfAValueIsTold) {
  Stage stage;
  stage.follow("/scene/wind");
  stage.a.send(stage.show, "/scene/wind", 99);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 10"}) << "it believes 99";
  stage.a.send(stage.show, "/scene/wind", 99);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 10"}) << "again, though nothing changed";
}

TEST(Feed, ScriptsAndRefusalsAreNoEcho) {
  const SceneFile file(R"(
params { { "x", 0, min = 0, max = 10 } }
osc:on("/double", function(v) params.x = 2 * v end)
)");
  Show show(file.path());
  Hearer a(1);
  a.feed.add("/scene/x");
  a.news(show);
  // a handler's doing is not the sender's own value
  a.send(show, "/double", 2);
  EXPECT_EQ(a.news(show), Told{"/scene/x 4"});
  a.send(show, "/scene/x", "nonsense");
  EXPECT_EQ(a.news(show), Told{});
  // set by itself, then changed by another back and forth: each change is news
  a.send(show, "/scene/x", 5);
  EXPECT_EQ(a.news(show), Told{});
  show.send("/scene/x", 6);
  EXPECT_EQ(a.news(show), Told{"/scene/x 6"});
  show.send("/scene/x", 5);
  EXPECT_EQ(a.news(show), Told{"/scene/x 5"});
}

TEST(Feed, PatternsFollowThingsThatComeAndGo) {
  Stage stage;
  stage.a.feed.add("/physics/body/*/part/free/friction");
  EXPECT_EQ(stage.a.news(stage.show), Told{"/physics/body/free/part/free/friction 0.5"});
  World& world = stage.show.engine.world();
  ASSERT_TRUE(world.copy_body(*world.find_body("free"), "other").ok());
  EXPECT_EQ(stage.a.news(stage.show), Told{"/physics/body/other/part/free/friction 0.5"});
  world.remove_body(*world.find_body("other"));
  EXPECT_EQ(stage.a.news(stage.show), Told{});
  stage.show.send("/physics/part/friction", "free", 0.75);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/physics/body/free/part/free/friction 0.75"});
}

TEST(Feed, PathsThatAreNotThereWait) {
  Stage stage;
  stage.a.feed.add("/physics/body/late/part/free/friction");
  stage.a.feed.add("/scene");
  stage.a.feed.add("/transport/step");
  stage.a.feed.add("nonsense");
  EXPECT_EQ(stage.a.news(stage.show), Told{});
  World& world = stage.show.engine.world();
  ASSERT_TRUE(world.copy_body(*world.find_body("free"), "late").ok());
  EXPECT_EQ(stage.a.news(stage.show), Told{"/physics/body/late/part/free/friction 0.5"});
}

TEST(Feed, AResetOfTheSameSceneIsNoNewsBeyondItsValues) {
  Stage stage;
  stage.follow("/scene/wind");
  stage.follow("/physics/body/arm/part/hat/friction");
  stage.show.send("/scene/wind", 2);
  EXPECT_EQ(stage.a.news(stage.show), Told{"/scene/wind 2"});
  stage.show.send("/transport/reset");
  EXPECT_EQ(stage.a.news(stage.show), Told{}) << "the performer's value is kept";
}

TEST(Feed, WhatFindsNoRoomComesNextTime) {
  Stage stage;
  stage.a.feed.add("/scene/*");
  stage.a.hear(stage.show);
  const Told first = stage.a.told(2);
  EXPECT_EQ(first.size(), 2u);
  Told rest = stage.a.told();
  rest.insert(rest.end(), first.begin(), first.end());
  std::sort(rest.begin(), rest.end());
  EXPECT_EQ(rest, (Told{"/scene/lively 1", "/scene/style 0", "/scene/where 0 0 1", "/scene/wind 0"}));
  EXPECT_EQ(stage.a.told(), Told{});
}

TEST(Feed, PathsAreBounded) {
  Feed feed;
  for (std::size_t i = 0; i < Feed::kMostPaths; i++) ASSERT_TRUE(feed.add("/p" + std::to_string(i)));
  EXPECT_FALSE(feed.add("/one/more"));
  EXPECT_TRUE(feed.add("/p7")) << "known already";
  EXPECT_EQ(feed.size(), Feed::kMostPaths);
}

}  // namespace
}  // namespace limber::engine_test

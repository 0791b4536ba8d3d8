// Change notifications of a client: the newest value if the client does not know it, once, and never its own writes.
#include "engine/output/feed.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

using SentMessages = std::vector<std::string>;

// a subscriber of a show
struct Subscriber {
  CommandOrigin self;
  Feed feed;

  explicit Subscriber(std::uint16_t port) : self{CommandSource::osc, 0x7f000001, port, true} {}

  template <class... A>
  void send(Show& show, std::string address, A&&... args) const {
    show.link.command_queue.push({{message(std::move(address), std::forward<A>(args)...)}, self});
  }
  void update(Show& show) { feed.update(make_value_snapshot(show), self); }
  SentMessages changes(std::size_t max_count = 1000) {
    SentMessages list;
    feed.send_changes([&](const std::string& path, const Property& property, const PropertyValue& value) {
      if (list.size() >= max_count) return false;
      std::string text = path;
      for (std::uint32_t i = 0; i < property.width; i++) text += " " + number_text(value.numbers[i]);
      list.push_back(std::move(text));
      return true;
    });
    return list;
  }
  SentMessages update_and_get_changes(Show& show) {
    update(show);
    return changes();
  }
};

struct TwoSubscribers {
  SceneFile file{kEverything};
  Show show{file.path()};
  Subscriber a{1};
  Subscriber b{2};

  TwoSubscribers() { show.send("/transport/pause"); }
  void subscribe(const std::string& path) {
    a.feed.add(path);
    b.feed.add(path);
    a.update_and_get_changes(show);
    b.update_and_get_changes(show);
  }
};

TEST(Feed, SendsTheValueFirstThenChangesOnly) {
  TwoSubscribers clients;
  EXPECT_TRUE(clients.a.feed.add("/scene/wind"));
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 0"});
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
  clients.show.send("/scene/wind", 3);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 3"});
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
  // a repeated subscription sends the value again
  EXPECT_TRUE(clients.a.feed.add("/scene/wind"));
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 3"});
  EXPECT_TRUE(clients.a.feed.remove("/scene/wind"));
  EXPECT_FALSE(clients.a.feed.remove("/scene/wind"));
  clients.show.send("/scene/wind", 4);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
}

TEST(Feed, AChangeIsSentToTheOtherClientsOnly) {
  TwoSubscribers clients;
  clients.subscribe("/scene/wind");
  clients.a.send(clients.show, "/scene/wind", 5);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{"/scene/wind 5"});
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{});
  // and by a legacy message with names as arguments
  clients.subscribe("/physics/body/arm/part/hat/friction");
  clients.b.send(clients.show, "/physics/part/friction", "arm", 0.25);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/physics/body/arm/part/hat/friction 0.25"});
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{});
}

TEST(Feed, AMovingSliderIsNotEchoed) {
  TwoSubscribers clients;
  clients.subscribe("/scene/wind");
  // values arrive between snapshots, and some snapshots are skipped
  for (int i = 0; i < 40; i++) {
    clients.a.send(clients.show, "/scene/wind", 0.125 * i);
    if (i % 3 == 0) clients.show.ticks(1);
    if (i % 7 == 0) make_value_snapshot(clients.show);
    EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{}) << i;
  }
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{"/scene/wind 4.875"}) << "only the newest";
}

TEST(Feed, TheLastOfTwoWritersWinsAndTheOtherIsNotified) {
  TwoSubscribers clients;
  clients.subscribe("/scene/wind");
  clients.a.send(clients.show, "/scene/wind", 5);
  clients.b.send(clients.show, "/scene/wind", 7);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 7"});
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{});
}

TEST(Feed, AValueSetBackByAnotherClientIsSent) {
  TwoSubscribers clients;
  clients.subscribe("/scene/wind");
  clients.a.send(clients.show, "/scene/wind", 5);
  clients.b.send(clients.show, "/scene/wind", 0);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 0"})
      << "the client assumes 5, though 0 was sent to it";
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{}) << "the client assumes 0";
  clients.a.send(clients.show, "/scene/wind", 0);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
  EXPECT_EQ(clients.b.update_and_get_changes(clients.show), SentMessages{});
}

TEST(Feed, AClampedValueIsSentToItsWriter) {
  TwoSubscribers clients;
  clients.subscribe("/scene/wind");
  clients.a.send(clients.show, "/scene/wind", 99);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 10"}) << "the client assumes 99";
  clients.a.send(clients.show, "/scene/wind", 99);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 10"})
      << "again, though nothing changed";
}

TEST(Feed, WritesOfScriptsAndRejectedValuesAreNotOwnWrites) {
  const SceneFile file(R"(
params { { "x", 0, min = 0, max = 10 } }
osc:on("/double", function(v) params.x = 2 * v end)
)");
  Show show(file.path());
  Subscriber a(1);
  a.feed.add("/scene/x");
  a.update_and_get_changes(show);
  // a write by a handler is not the sender's own write
  a.send(show, "/double", 2);
  EXPECT_EQ(a.update_and_get_changes(show), SentMessages{"/scene/x 4"});
  a.send(show, "/scene/x", "nonsense");
  EXPECT_EQ(a.update_and_get_changes(show), SentMessages{});
  // set by the client, then changed by another and changed back: each change is sent
  a.send(show, "/scene/x", 5);
  EXPECT_EQ(a.update_and_get_changes(show), SentMessages{});
  show.send("/scene/x", 6);
  EXPECT_EQ(a.update_and_get_changes(show), SentMessages{"/scene/x 6"});
  show.send("/scene/x", 5);
  EXPECT_EQ(a.update_and_get_changes(show), SentMessages{"/scene/x 5"});
}

TEST(Feed, PatternsFollowAddedAndRemovedObjects) {
  TwoSubscribers clients;
  clients.a.feed.add("/physics/body/*/part/free/friction");
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/physics/body/free/part/free/friction 0.5"});
  sim::World& world = clients.show.engine.world();
  ASSERT_TRUE(world.copy_body(*world.find_body("free"), "other").ok());
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/physics/body/other/part/free/friction 0.5"});
  world.remove_body(*world.find_body("other"));
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
  clients.show.send("/physics/part/friction", "free", 0.75);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/physics/body/free/part/free/friction 0.75"});
}

TEST(Feed, PathsWithoutAMatchWait) {
  TwoSubscribers clients;
  clients.a.feed.add("/physics/body/late/part/free/friction");
  clients.a.feed.add("/scene");
  clients.a.feed.add("/transport/step");
  clients.a.feed.add("nonsense");
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{});
  sim::World& world = clients.show.engine.world();
  ASSERT_TRUE(world.copy_body(*world.find_body("free"), "late").ok());
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/physics/body/late/part/free/friction 0.5"});
}

TEST(Feed, AResetSendsChangedValuesOnly) {
  TwoSubscribers clients;
  clients.subscribe("/scene/wind");
  clients.subscribe("/physics/body/arm/part/hat/friction");
  clients.show.send("/scene/wind", 2);
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{"/scene/wind 2"});
  clients.show.send("/transport/reset");
  EXPECT_EQ(clients.a.update_and_get_changes(clients.show), SentMessages{}) << "the override stays";
}

TEST(Feed, AValueThatDoesNotFitIsSentNextTime) {
  TwoSubscribers clients;
  clients.a.feed.add("/scene/*");
  clients.a.update(clients.show);
  const SentMessages first = clients.a.changes(2);
  EXPECT_EQ(first.size(), 2u);
  SentMessages rest = clients.a.changes();
  rest.insert(rest.end(), first.begin(), first.end());
  std::sort(rest.begin(), rest.end());
  EXPECT_EQ(rest, (SentMessages{"/scene/lively 1", "/scene/style 0", "/scene/where 0 0 1", "/scene/wind 0"}));
  EXPECT_EQ(clients.a.changes(), SentMessages{});
}

TEST(Feed, LimitsTheNumberOfPaths) {
  Feed feed;
  for (std::size_t i = 0; i < Feed::kMaxPaths; i++) ASSERT_TRUE(feed.add("/p" + std::to_string(i)));
  EXPECT_FALSE(feed.add("/one/more"));
  EXPECT_TRUE(feed.add("/p7")) << "known already";
  EXPECT_EQ(feed.size(), Feed::kMaxPaths);
}

}  // namespace
}  // namespace limber::engine::test

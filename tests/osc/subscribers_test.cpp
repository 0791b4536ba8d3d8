// Subscriptions by UDP: to paths and patterns at a rate, to streams, renewed or lapsed; what is refused.
#include "osc/subscribers.h"

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "osc/osc_test_tools.h"

namespace limber::osc_test {
namespace {

using engine_test::message;
using Told = std::vector<std::string>;

struct Desk {
  engine_test::SceneFile file{engine_test::kEverything};
  engine_test::Show show{file.path()};
  HandClock hand;
  NetClock clock = hand.clock();
  std::vector<Outgoing> sent;
  Subscribers subscribers{show.link, clock, [this](const Outgoing& out) { sent.push_back(out); }};
  Origin one{Hand::osc, 0x7f000001, 5001};
  Origin two{Hand::osc, 0x7f000001, 5002};

  Desk() { show.send("/transport/pause"); }
  template <class... A>
  std::string subscribe(const Origin& who, A&&... args) {
    const Result<void> done = subscribers.take(message("/subscribe", std::forward<A>(args)...), who);
    return done ? "" : done.error();
  }
  // what goes out in this much time, work being done every 5 ms as the bell and the waits have it
  Told after(double seconds) {
    sent.clear();
    for (double t = 0; t < seconds - 1e-9; t += 0.005) {
      hand.turn(0.005);
      subscribers.work();
      engine_test::image_of(show);
      subscribers.work();
    }
    Told told;
    for (const Outgoing& out : sent)
      told.push_back(std::to_string(out.origin.port) + " " + engine_test::text_of(out.message));
    return told;
  }
};

TEST(Subscribers, ChangesComeAtTheRateTheNewestOnly) {
  Desk desk;
  EXPECT_EQ(desk.subscribe(desk.one, "/scene/wind", 10), "");
  EXPECT_EQ(desk.after(0.05), Told{"5001 /scene/wind 0"});
  int told = 0;
  std::string last;
  for (int i = 1; i <= 200; i++) {
    desk.show.send("/scene/wind", 0.01 * i);
    const Told now = desk.after(0.005);
    told += static_cast<int>(now.size());
    if (!now.empty()) last = now.back();
  }
  EXPECT_GE(told, 9);
  EXPECT_LE(told, 11) << "one second at 10 Hz";
  EXPECT_LE(desk.after(0.1).size(), 1u);
  EXPECT_EQ(desk.after(1), Told{}) << "nothing changes, nothing comes";
}

TEST(Subscribers, WhatOneSetsTheOtherHears) {
  Desk desk;
  desk.subscribe(desk.one, "/scene/wind", 50);
  desk.subscribe(desk.two, "/scene/wind", 50);
  desk.after(0.1);
  Origin origin = desk.one;
  EXPECT_TRUE(desk.subscribers.follows(origin));
  EXPECT_FALSE(desk.subscribers.follows({Hand::osc, 0x7f000001, 9}));
  origin.follows = true;
  desk.show.link.inbox.push({{message("/scene/wind", 4)}, origin});
  EXPECT_EQ(desk.after(0.1), Told{"5002 /scene/wind 4"});
}

TEST(Subscribers, LapseAfterThirtySecondsUnlessRenewed) {
  Desk desk;
  desk.subscribe(desk.one, "/scene/wind", 1);
  desk.subscribe(desk.two, "/scene/wind", 1);
  desk.after(0.01);
  desk.hand.turn(20);
  desk.subscribe(desk.two, "/scene/wind", 1);
  desk.hand.turn(11);
  desk.subscribers.work();
  EXPECT_FALSE(desk.subscribers.follows(desk.one));
  EXPECT_TRUE(desk.subscribers.follows(desk.two));
  ASSERT_TRUE(desk.subscribers.take(message("/unsubscribe", "/scene/wind"), desk.two).ok());
  EXPECT_FALSE(desk.subscribers.follows(desk.two));
  EXPECT_FALSE(desk.subscribers.wait()) << "nothing is left to wait for";
}

TEST(Subscribers, StreamsGoToTheSenderAlone) {
  Desk desk;
  EXPECT_EQ(desk.subscribe(desk.one, "pos", 30), "");
  EXPECT_EQ(desk.subscribe(desk.one, "/physics/joint/relrot", 5), "");
  EXPECT_TRUE(desk.subscribers.take_news());
  EXPECT_FALSE(desk.subscribers.take_news());
  const std::vector<Target> targets = desk.subscribers.targets();
  ASSERT_EQ(targets.size(), 2u);
  for (const Target& t : targets) EXPECT_EQ(t.at, (Endpoint{0x7f000001, 5001}));
  EXPECT_TRUE(targets[0].wish.pos && !targets[0].wish.rot && !targets[0].wish.relrot);
  EXPECT_EQ(targets[0].wish.rate, 30);
  EXPECT_TRUE(targets[1].wish.relrot && !targets[1].wish.pos);
  // the same again is a renewal; another rate is news
  desk.subscribe(desk.one, "pos", 30);
  EXPECT_FALSE(desk.subscribers.take_news());
  desk.subscribe(desk.one, "/physics/joint/pos", 10);
  EXPECT_TRUE(desk.subscribers.take_news());
  EXPECT_EQ(desk.subscribers.targets().size(), 2u);
  EXPECT_EQ(desk.subscribers.ends(), (std::vector<Endpoint>{{0x7f000001, 5001}}));
  ASSERT_TRUE(desk.subscribers.take(message("/unsubscribe"), desk.one).ok());
  EXPECT_TRUE(desk.subscribers.targets().empty());
  EXPECT_TRUE(desk.subscribers.take_news());
}

TEST(Subscribers, AWrongPathIsSaidOnceAndWaitedFor) {
  Desk desk;
  desk.subscribe(desk.one, "/scene/wimd", 50);
  desk.subscribe(desk.one, "/scene", 50);
  EXPECT_EQ(desk.after(0.2),
            (Told{"5001 /error /subscribe there is no 'wimd' in /scene; did you mean 'wind'?; it is waited for",
                  "5001 /error /subscribe '/scene' is no value; it is waited for"}));
}

TEST(Subscribers, WhatIsNoneIsRefused) {
  Desk desk;
  const std::string form =
      "takes a path, a pattern or a stream (pos, rot, relrot, relpos), and how often a second: 0.1 to 1000";
  EXPECT_EQ(desk.subscribe(desk.one), form);
  EXPECT_EQ(desk.subscribe(desk.one, 3, 3), form);
  EXPECT_EQ(desk.subscribe(desk.one, "poz", 3), form);
  EXPECT_EQ(desk.subscribe(desk.one, "pos", 0), form);
  EXPECT_EQ(desk.subscribe(desk.one, "/scene/wind", 1001), form);
  EXPECT_EQ(desk.subscribe(desk.one, "/scene/wind", std::nan("")), form);
  EXPECT_EQ(desk.subscribe(desk.one, "/scene/wind", "often"), form);
  EXPECT_EQ(desk.subscribe(Origin{Hand::query, 1, 1}, "/scene/wind", 1),
            R"(is for senders by UDP; here it is {"COMMAND":"LISTEN","DATA":path})");
  EXPECT_FALSE(desk.subscribers.take(message("/unsubscribe", 1), desk.one).ok());
  EXPECT_TRUE(desk.subscribers.take(message("/unsubscribe", "/never"), desk.one).ok());
  EXPECT_FALSE(desk.subscribers.wait());
}

TEST(Subscribers, AreBounded) {
  Desk desk;
  for (std::size_t i = 0; i < Subscribers::kMost; i++) {
    const Origin who{Hand::osc, 1, static_cast<std::uint16_t>(i + 1)};
    EXPECT_EQ(desk.subscribe(who, "/scene/wind", 1), "");
  }
  EXPECT_EQ(desk.subscribe(desk.one, "/scene/wind", 1), "64 have subscribed already; no more can");
  const Origin first{Hand::osc, 1, 1};
  for (std::size_t i = 1; i < Subscribers::kMostEach; i++)
    EXPECT_EQ(desk.subscribe(first, "/p" + std::to_string(i), 1), "");
  EXPECT_EQ(desk.subscribe(first, "/one/more", 1), "256 subscriptions are the most for one");
}

}  // namespace
}  // namespace limber::osc_test

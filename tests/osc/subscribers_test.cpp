// Subscriptions by UDP: to paths and patterns at a rate, to streams, renewed or lapsed; what is refused.
#include "osc/subscribers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

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
  SendLimits each = SendBudget::kEach, all = SendBudget::kAll;
  Subscribers subscribers{show.link, clock, [this](const Outgoing& out) { return send(out); }, each, all};
  int slices = 0;
  Origin one{Hand::osc, 0x7f000001, 5001};
  Origin two{Hand::osc, 0x7f000001, 5002};

  Desk() { show.send("/transport/pause"); }
  /// Limits for each sender and for all, values per second.
  Desk(double values_each, double values_all) : each{1e9, values_each}, all{1e9, values_all} {}
  bool send(const Outgoing& out) {
    const bool value = out.to == Outgoing::To::sender;
    if (value && !subscribers.spend({out.origin.ip, out.origin.port}, 40, 1)) return false;
    sent.push_back(out);
    return true;
  }
  // all slices
  void work() {
    do {
      subscribers.work();
      slices++;
    } while (subscribers.wait() == 0);
  }
  template <class... A>
  std::string subscribe(const Origin& who, A&&... args) {
    const Result<void> done = subscribers.take(message("/subscribe", std::forward<A>(args)...), who);
    return done ? "" : done.error();
  }
  // what goes out in this much time, work being done every step as the bell and the waits have it
  Told after(double seconds, double step = 0.005) {
    sent.clear();
    for (double t = 0; t < seconds - 1e-9; t += step) {
      hand.turn(step);
      work();
      engine_test::image_of(show);
      work();
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

TEST(Subscribers, OverlappingPathsOfOneSenderAreMerged) {
  Desk desk;
  desk.subscribe(desk.one, "/scene/*", 10);
  desk.subscribe(desk.one, "/scene/w*", 20);
  desk.subscribe(desk.one, "/scene/wind", 100);
  Told first = desk.after(0.3);
  std::ranges::sort(first);
  EXPECT_EQ(first,
            (Told{"5001 /scene/lively 1", "5001 /scene/style 0", "5001 /scene/where 0 0 1", "5001 /scene/wind 0"}))
      << "each value once";
  // at the highest rate of those that reach it
  std::size_t winds = 0, wheres = 0;
  for (int i = 0; i < 200; i++) {
    desk.show.send("/scene/wind", 0.01 * i);
    desk.show.send("/scene/where", 0.001 * i, 0, 0);
    for (const std::string& told : desk.after(0.005)) {
      winds += told.starts_with("5001 /scene/wind ") ? 1 : 0;
      wheres += told.starts_with("5001 /scene/where ") ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(winds), 100, 3);
  EXPECT_NEAR(static_cast<double>(wheres), 20, 2);
  // without the fastest one the next has the value, and nothing is told twice
  ASSERT_TRUE(desk.subscribers.take(message("/unsubscribe", "/scene/wind"), desk.one).ok());
  EXPECT_EQ(desk.after(0.5), Told{});
  desk.show.send("/scene/wind", 9);
  EXPECT_EQ(desk.after(0.1), Told{"5001 /scene/wind 9"});
}

// how many values each of two got
std::pair<std::size_t, std::size_t> values_of(const Told& told) {
  const auto of = [&](const char* who) {
    return static_cast<std::size_t>(std::ranges::count_if(told, [&](const std::string& line) {
      return line.starts_with(who) && line.find("/subscription/") == std::string::npos;
    }));
  };
  return {of("5001"), of("5002")};
}

TEST(Subscribers, AGreedySenderGetsItsShareAndTakesNothingFromOthers) {
  Desk desk(1000, 1500);
  for (int i = 0; i < 250; i++)
    desk.subscribe(desk.one, "//*" + std::string(static_cast<std::size_t>(i % 3), '*'), 1000);
  for (std::size_t i = 0; i < 200; i++) desk.subscribe(desk.one, "/physics" + std::string(i, '/') + "/*", 1000);
  desk.subscribe(desk.two, "/physics/sim/tick", 50);
  desk.after(0.5, 0.02);  // the burst, and all values once
  const auto [greedy, modest] = values_of(desk.after(2, 0.02));
  EXPECT_LE(greedy, 2050u);
  EXPECT_GE(greedy, 1900u) << "a thousand a second is its limit";
  EXPECT_GE(modest, 95u) << "fifty a second, all of them";
}

TEST(Subscribers, AReductionIsReportedToTheSubscriberAndInHealth) {
  Desk desk(300, 300);
  desk.subscribe(desk.one, "//*", 200);
  const Told told = desk.after(4.5, 0.05);
  const auto report = [](const std::string& line) { return line.starts_with("5001 /subscription/"); };
  const auto reports = std::ranges::count_if(told, report);
  ASSERT_EQ(reports, 1) << "the first window is reported, the second is the same";
  const std::string line = *std::ranges::find_if(told, report);
  double values = 0, bytes = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "5001 /subscription/reduced %lf %lf", &values, &bytes), 2) << line;
  EXPECT_NEAR(values, 315, 10) << "the limit and the burst, over two seconds";
  EXPECT_NEAR(bytes, 40 * values, 100);
  EXPECT_EQ(desk.show.link.health.count(HealthItem::reduced), 1u);
  ASSERT_TRUE(desk.subscribers.take(message("/unsubscribe"), desk.one).ok());
  desk.subscribe(desk.one, "/scene/wind", 200);
  const Told after = desk.after(4.5, 0.05);
  EXPECT_EQ(std::ranges::count_if(after, report), 0) << "it has begun again, and is not reduced";
  EXPECT_EQ(desk.show.link.health.count(HealthItem::reduced), 0u);
}

TEST(Subscribers, OneCallOfWorkSendsASlice) {
  Desk desk;
  for (int i = 0; i < 32; i++) desk.subscribe({Hand::osc, 0x7f000001, static_cast<std::uint16_t>(6000 + i)}, "//*", 60);
  std::size_t most = 0, sent = 0;
  for (int i = 0; i < 4; i++) {
    desk.hand.turn(0.02);
    desk.subscribers.work();
    engine_test::image_of(desk.show);
    do {
      const std::size_t before = desk.sent.size();
      desk.subscribers.work();
      most = std::max(most, desk.sent.size() - before);
    } while (desk.subscribers.wait() == 0);
    sent = desk.sent.size();
  }
  EXPECT_GT(sent, 32u * 100) << "everybody is told everything";
  EXPECT_LE(most, static_cast<std::size_t>(Subscribers::kSlice));
}

TEST(Subscribers, AskingForTooManyValuesIsReported) {
  Desk desk;
  const engine_test::SceneFile file(R"(
    for i = 1, 200 do sim:add_body("b" .. i):add_part("p", sim:add_sphere_shape("s" .. i, 0.1), { mass = 1 }) end)");
  engine_test::Show show(file.path());
  std::vector<Outgoing> sent;
  Subscribers subscribers(show.link, desk.clock, [&](const Outgoing& out) {
    sent.push_back(out);
    return true;
  });
  ASSERT_TRUE(subscribers.take(message("/subscribe", "//*", 1), desk.one).ok());
  subscribers.work();
  engine_test::image_of(show);
  do subscribers.work();
  while (subscribers.wait() == 0);
  std::size_t values = 0;
  Told errors;
  for (const Outgoing& out : sent) {
    if (out.to == Outgoing::To::error) errors.push_back(engine_test::text_of(out.message));
    values += out.to == Outgoing::To::sender ? 1 : 0;
  }
  EXPECT_EQ(errors, Told{"/error /subscribe reaches more than 4096 values; the others are not sent"});
  EXPECT_LE(values, Feed::kMostValues);
  EXPECT_GE(values, Feed::kMostValues / 2);
}

}  // namespace
}  // namespace limber::osc_test

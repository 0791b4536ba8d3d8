// Subscriptions by UDP: paths and patterns at a rate, streams, renewal and expiry, rejected requests.
#include "net/osc/subscribers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "osc/osc_test_tools.h"

namespace limber::osc::test {
namespace {

using engine::test::message;
using SentMessages = std::vector<std::string>;

struct SubscribersFixture {
  engine::test::SceneFile file{engine::test::kEverything};
  engine::test::Show show{file.path()};
  ManualClock manual_clock;
  NetClock clock = manual_clock.clock();
  std::vector<engine::Outgoing> sent;
  SendLimits per_subscriber = SendBudget::kPerSubscriber, total = SendBudget::kTotal;
  Subscribers subscribers{show.link, clock, [this](const engine::Outgoing& out) { return send(out); }, per_subscriber,
                          total};
  int slices = 0;
  CommandOrigin first{CommandSource::osc, 0x7f000001, 5001};
  CommandOrigin second{CommandSource::osc, 0x7f000001, 5002};

  SubscribersFixture() { show.send("/transport/pause"); }
  /// Limits per sender and in total, values per second.
  SubscribersFixture(double values_each, double values_all)
      : per_subscriber{1e9, values_each}, total{1e9, values_all} {}
  bool send(const engine::Outgoing& out) {
    const bool value = out.destination == engine::Outgoing::Destination::reply;
    if (value && !subscribers.try_consume({out.origin.ip, out.origin.port}, 40, 1)) return false;
    sent.push_back(out);
    return true;
  }
  // Runs all slices.
  void work() {
    do {
      subscribers.work();
      slices++;
    } while (subscribers.timeout() == 0);
  }
  template <class... A>
  std::string subscribe(const CommandOrigin& origin, A&&... args) {
    const Result<void> done = subscribers.handle(message("/subscribe", std::forward<A>(args)...), origin);
    return done ? "" : done.error();
  }
  // Returns the messages sent within this time; work() is called in each step, as on wake-ups and timeouts.
  SentMessages messages_after(double seconds, double step = 0.005) {
    sent.clear();
    for (double t = 0; t < seconds - 1e-9; t += step) {
      manual_clock.advance(step);
      work();
      engine::test::make_value_snapshot(show);
      work();
    }
    SentMessages lines;
    for (const engine::Outgoing& out : sent)
      lines.push_back(std::to_string(out.origin.port) + " " + engine::test::text_of(out.message));
    return lines;
  }
};

TEST(Subscribers, SendLatestValueAtRate) {
  SubscribersFixture fixture;
  EXPECT_EQ(fixture.subscribe(fixture.first, "/scene/wind", 10), "");
  EXPECT_EQ(fixture.messages_after(0.05), SentMessages{"5001 /scene/wind 0"});
  int count = 0;
  std::string last;
  for (int i = 1; i <= 200; i++) {
    fixture.show.send("/scene/wind", 0.01 * i);
    const SentMessages now = fixture.messages_after(0.005);
    count += static_cast<int>(now.size());
    if (!now.empty()) last = now.back();
  }
  EXPECT_GE(count, 9);
  EXPECT_LE(count, 11) << "one second at 10 Hz";
  EXPECT_LE(fixture.messages_after(0.1).size(), 1u);
  EXPECT_EQ(fixture.messages_after(1), SentMessages{}) << "nothing changes, nothing comes";
}

TEST(Subscribers, ReceiveChangesOfOthersOnly) {
  SubscribersFixture fixture;
  fixture.subscribe(fixture.first, "/scene/wind", 50);
  fixture.subscribe(fixture.second, "/scene/wind", 50);
  fixture.messages_after(0.1);
  CommandOrigin origin = fixture.first;
  EXPECT_TRUE(fixture.subscribers.is_subscriber(origin));
  EXPECT_FALSE(fixture.subscribers.is_subscriber({CommandSource::osc, 0x7f000001, 9}));
  origin.is_subscriber = true;
  fixture.show.link.command_queue.push({{message("/scene/wind", 4)}, origin});
  EXPECT_EQ(fixture.messages_after(0.1), SentMessages{"5002 /scene/wind 4"});
}

TEST(Subscribers, ExpireUnlessRenewed) {
  SubscribersFixture fixture;
  fixture.subscribe(fixture.first, "/scene/wind", 1);
  fixture.subscribe(fixture.second, "/scene/wind", 1);
  fixture.messages_after(0.01);
  fixture.manual_clock.advance(20);
  fixture.subscribe(fixture.second, "/scene/wind", 1);
  fixture.manual_clock.advance(11);
  fixture.subscribers.work();
  EXPECT_FALSE(fixture.subscribers.is_subscriber(fixture.first));
  EXPECT_TRUE(fixture.subscribers.is_subscriber(fixture.second));
  ASSERT_TRUE(fixture.subscribers.handle(message("/unsubscribe", "/scene/wind"), fixture.second).ok());
  EXPECT_FALSE(fixture.subscribers.is_subscriber(fixture.second));
  EXPECT_FALSE(fixture.subscribers.timeout()) << "nothing is left to wait for";
}

TEST(Subscribers, StreamToSenderOnly) {
  SubscribersFixture fixture;
  EXPECT_EQ(fixture.subscribe(fixture.first, "pos", 30), "");
  EXPECT_EQ(fixture.subscribe(fixture.first, "/physics/joint/relrot", 5), "");
  EXPECT_TRUE(fixture.subscribers.consume_changed());
  EXPECT_FALSE(fixture.subscribers.consume_changed());
  const std::vector<ResolvedTarget> targets = fixture.subscribers.targets();
  ASSERT_EQ(targets.size(), 2u);
  for (const ResolvedTarget& t : targets) EXPECT_EQ(t.endpoint, (Endpoint{0x7f000001, 5001}));
  EXPECT_TRUE(targets[0].config.pos && !targets[0].config.rot && !targets[0].config.relrot);
  EXPECT_EQ(targets[0].config.rate, 30);
  EXPECT_TRUE(targets[1].config.relrot && !targets[1].config.pos);
  // the same subscription is a renewal; another rate is a change
  fixture.subscribe(fixture.first, "pos", 30);
  EXPECT_FALSE(fixture.subscribers.consume_changed());
  fixture.subscribe(fixture.first, "/physics/joint/pos", 10);
  EXPECT_TRUE(fixture.subscribers.consume_changed());
  EXPECT_EQ(fixture.subscribers.targets().size(), 2u);
  EXPECT_EQ(fixture.subscribers.endpoints(), (std::vector<Endpoint>{{0x7f000001, 5001}}));
  ASSERT_TRUE(fixture.subscribers.handle(message("/unsubscribe"), fixture.first).ok());
  EXPECT_TRUE(fixture.subscribers.targets().empty());
  EXPECT_TRUE(fixture.subscribers.consume_changed());
}

TEST(Subscribers, ReportWrongPathOnce) {
  SubscribersFixture fixture;
  fixture.subscribe(fixture.first, "/scene/wimd", 50);
  fixture.subscribe(fixture.first, "/scene", 50);
  EXPECT_EQ(fixture.messages_after(0.2),
            (SentMessages{"5001 /error /subscribe there is no 'wimd' in /scene; did you mean 'wind'?; waiting for it",
                          "5001 /error /subscribe '/scene' is not a property; waiting for it"}));
}

TEST(Subscribers, RejectInvalidRequests) {
  SubscribersFixture fixture;
  const std::string form =
      "takes a path, a pattern or a stream (pos, rot, relrot, relpos), and a rate from 0.1 to 1000 per second";
  EXPECT_EQ(fixture.subscribe(fixture.first), form);
  EXPECT_EQ(fixture.subscribe(fixture.first, 3, 3), form);
  EXPECT_EQ(fixture.subscribe(fixture.first, "poz", 3), form);
  EXPECT_EQ(fixture.subscribe(fixture.first, "pos", 0), form);
  EXPECT_EQ(fixture.subscribe(fixture.first, "/scene/wind", 1001), form);
  EXPECT_EQ(fixture.subscribe(fixture.first, "/scene/wind", std::nan("")), form);
  EXPECT_EQ(fixture.subscribe(fixture.first, "/scene/wind", "often"), form);
  EXPECT_EQ(fixture.subscribe(CommandOrigin{CommandSource::oscquery, 1, 1}, "/scene/wind", 1),
            R"(is for UDP only; use {"COMMAND":"LISTEN","DATA":path} here)");
  EXPECT_FALSE(fixture.subscribers.handle(message("/unsubscribe", 1), fixture.first).ok());
  EXPECT_TRUE(fixture.subscribers.handle(message("/unsubscribe", "/never"), fixture.first).ok());
  EXPECT_FALSE(fixture.subscribers.timeout());
}

TEST(Subscribers, AreLimited) {
  SubscribersFixture fixture;
  for (std::size_t i = 0; i < Subscribers::kMaxSubscribers; i++) {
    const CommandOrigin sender{CommandSource::osc, 1, static_cast<std::uint16_t>(i + 1)};
    EXPECT_EQ(fixture.subscribe(sender, "/scene/wind", 1), "");
  }
  EXPECT_EQ(fixture.subscribe(fixture.first, "/scene/wind", 1), "too many subscribers; the limit is 64");
  const CommandOrigin first{CommandSource::osc, 1, 1};
  for (std::size_t i = 1; i < Subscribers::kMaxSubscriptions; i++)
    EXPECT_EQ(fixture.subscribe(first, "/p" + std::to_string(i), 1), "");
  EXPECT_EQ(fixture.subscribe(first, "/one/more", 1), "too many subscriptions; the limit per sender is 256");
}

TEST(Subscribers, MergeOverlappingPaths) {
  SubscribersFixture fixture;
  fixture.subscribe(fixture.first, "/scene/*", 10);
  fixture.subscribe(fixture.first, "/scene/w*", 20);
  fixture.subscribe(fixture.first, "/scene/wind", 100);
  SentMessages first = fixture.messages_after(0.3);
  std::ranges::sort(first);
  EXPECT_EQ(first, (SentMessages{"5001 /scene/lively 1", "5001 /scene/style 0", "5001 /scene/where 0 0 1",
                                 "5001 /scene/wind 0"}))
      << "each value once";
  // at the highest rate of the matching subscriptions
  std::size_t winds = 0, wheres = 0;
  for (int i = 0; i < 200; i++) {
    fixture.show.send("/scene/wind", 0.01 * i);
    fixture.show.send("/scene/where", 0.001 * i, 0, 0);
    for (const std::string& line : fixture.messages_after(0.005)) {
      winds += line.starts_with("5001 /scene/wind ") ? 1 : 0;
      wheres += line.starts_with("5001 /scene/where ") ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(winds), 100, 3);
  EXPECT_NEAR(static_cast<double>(wheres), 20, 2);
  // without the fastest subscription the next one sends the value, and nothing is sent twice
  ASSERT_TRUE(fixture.subscribers.handle(message("/unsubscribe", "/scene/wind"), fixture.first).ok());
  EXPECT_EQ(fixture.messages_after(0.5), SentMessages{});
  fixture.show.send("/scene/wind", 9);
  EXPECT_EQ(fixture.messages_after(0.1), SentMessages{"5001 /scene/wind 9"});
}

// Returns the number of values sent to each of the two senders.
std::pair<std::size_t, std::size_t> values_of(const SentMessages& lines) {
  const auto of = [&](const char* port) {
    return static_cast<std::size_t>(std::ranges::count_if(lines, [&](const std::string& line) {
      return line.starts_with(port) && line.find("/subscription/") == std::string::npos;
    }));
  };
  return {of("5001"), of("5002")};
}

TEST(Subscribers, ShareBudgetFairly) {
  SubscribersFixture fixture(1000, 1500);
  for (int i = 0; i < 250; i++)
    fixture.subscribe(fixture.first, "//*" + std::string(static_cast<std::size_t>(i % 3), '*'), 1000);
  for (std::size_t i = 0; i < 200; i++) fixture.subscribe(fixture.first, "/physics" + std::string(i, '/') + "/*", 1000);
  fixture.subscribe(fixture.second, "/physics/sim/tick", 50);
  fixture.messages_after(0.5, 0.02);  // skip the burst and the initial values
  const auto [greedy, modest] = values_of(fixture.messages_after(2, 0.02));
  EXPECT_LE(greedy, 2050u);
  EXPECT_GE(greedy, 1900u) << "a thousand a second is its limit";
  EXPECT_GE(modest, 95u) << "fifty a second, all of them";
}

TEST(Subscribers, ReportReductions) {
  SubscribersFixture fixture(300, 300);
  fixture.subscribe(fixture.first, "//*", 200);
  const SentMessages lines = fixture.messages_after(4.5, 0.05);
  const auto report = [](const std::string& line) { return line.starts_with("5001 /subscription/"); };
  const auto reports = std::ranges::count_if(lines, report);
  ASSERT_EQ(reports, 1) << "the first window is reported, the second is the same";
  const std::string line = *std::ranges::find_if(lines, report);
  double values = 0, bytes = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "5001 /subscription/reduced %lf %lf", &values, &bytes), 2) << line;
  EXPECT_NEAR(values, 315, 10) << "the limit and the burst, over two seconds";
  EXPECT_NEAR(bytes, 40 * values, 100);
  EXPECT_EQ(fixture.show.link.health.count(engine::HealthItem::reduced), 1u);
  ASSERT_TRUE(fixture.subscribers.handle(message("/unsubscribe"), fixture.first).ok());
  fixture.subscribe(fixture.first, "/scene/wind", 200);
  const SentMessages after = fixture.messages_after(4.5, 0.05);
  EXPECT_EQ(std::ranges::count_if(after, report), 0) << "it has begun again, and is not reduced";
  EXPECT_EQ(fixture.show.link.health.count(engine::HealthItem::reduced), 0u);
}

TEST(Subscribers, WorkInSlices) {
  SubscribersFixture fixture;
  for (int i = 0; i < 32; i++)
    fixture.subscribe({CommandSource::osc, 0x7f000001, static_cast<std::uint16_t>(6000 + i)}, "//*", 60);
  std::size_t max_per_slice = 0, sent = 0;
  for (int i = 0; i < 4; i++) {
    fixture.manual_clock.advance(0.02);
    fixture.subscribers.work();
    engine::test::make_value_snapshot(fixture.show);
    do {
      const std::size_t before = fixture.sent.size();
      fixture.subscribers.work();
      max_per_slice = std::max(max_per_slice, fixture.sent.size() - before);
    } while (fixture.subscribers.timeout() == 0);
    sent = fixture.sent.size();
  }
  EXPECT_GT(sent, 32u * 100) << "all values are sent";
  EXPECT_LE(max_per_slice, static_cast<std::size_t>(Subscribers::kValuesPerSlice));
}

TEST(Subscribers, ReportTooManyValues) {
  SubscribersFixture fixture;
  const engine::test::SceneFile file(R"(
    for i = 1, 200 do sim:add_body("b" .. i):add_part("p", sim:add_sphere_shape("s" .. i, 0.1), { mass = 1 }) end)");
  engine::test::Show show(file.path());
  std::vector<engine::Outgoing> sent;
  Subscribers subscribers(show.link, fixture.clock, [&](const engine::Outgoing& out) {
    sent.push_back(out);
    return true;
  });
  ASSERT_TRUE(subscribers.handle(message("/subscribe", "//*", 1), fixture.first).ok());
  subscribers.work();
  engine::test::make_value_snapshot(show);
  do subscribers.work();
  while (subscribers.timeout() == 0);
  std::size_t values = 0;
  SentMessages errors;
  for (const engine::Outgoing& out : sent) {
    if (out.destination == engine::Outgoing::Destination::error) errors.push_back(engine::test::text_of(out.message));
    values += out.destination == engine::Outgoing::Destination::reply ? 1 : 0;
  }
  EXPECT_EQ(errors, SentMessages{"/error /subscribe matches more than 4096 values; the others are not sent"});
  EXPECT_LE(values, engine::Feed::kMaxValues);
  EXPECT_GE(values, engine::Feed::kMaxValues / 2);
}

}  // namespace
}  // namespace limber::osc::test

// Requests wait for a value snapshot until a timeout; clients are updated once per tick.
#include "net/oscquery/hub.h"

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/image_of.h"
#include "oscquery/fake_doors.h"

namespace limber::oscquery::test {
namespace {

using Frames = std::vector<std::string>;

double current_time = 100;
double fake_time() { return current_time; }

struct FrameSink : ClientSink {
  Frames frames;
  void send(bool, std::string frame) override { frames.push_back(std::move(frame)); }
  std::size_t queued_bytes() const override { return 0; }
  Frames consume_frames() { return std::exchange(frames, {}); }
};

struct QueryHubFixture {
  engine::test::SceneFile file{engine::test::kEverything};
  engine::test::Show show{file.path()};
  QueryHost host = fake_query_host();
  QueryHub hub{show.link, host, {}, &fake_time};
  std::vector<HttpResponse> responses;

  QueryHubFixture() { show.send("/transport/pause"); }
  void request(const std::string& target) {
    HttpRequest request;
    request.method = "GET";
    request.target = target;
    request.host = "localhost";
    hub.handle_request(request, [this](HttpResponse response) { responses.push_back(std::move(response)); });
  }
  // Runs the engine until it has made the requested snapshot, and notifies the hub.
  void make_snapshot() {
    const std::uint64_t ask = show.link.value_snapshot_requests.load();
    for (int i = 0; i < 1000000; i++) {
      show.ticks(1);
      const auto snapshot = show.link.value_snapshots.read();
      if (snapshot != nullptr && snapshot->request >= ask) break;
    }
    hub.on_link_event();
  }
};

TEST(QueryHub, RequestWaitsForNewerSnapshot) {
  QueryHubFixture fixture;
  engine::test::make_value_snapshot(fixture.show);
  fixture.show.send("/scene/wind", 7);
  fixture.request("/scene/wind?VALUE");
  fixture.hub.on_link_event();
  EXPECT_TRUE(fixture.responses.empty()) << "the existing snapshot is too old";
  EXPECT_TRUE(fixture.hub.busy());
  fixture.make_snapshot();
  ASSERT_EQ(fixture.responses.size(), 1u);
  EXPECT_EQ(fixture.responses[0].body, R"({"VALUE":[7]})");
  EXPECT_FALSE(fixture.hub.busy());
}

TEST(QueryHub, RespondsImmediatelyWithoutTree) {
  QueryHubFixture fixture;
  fixture.request("/?HOST_INFO");
  fixture.request("/?NONSENSE");
  ASSERT_EQ(fixture.responses.size(), 2u);
  EXPECT_EQ(fixture.responses[0].status, 200);
  EXPECT_EQ(fixture.responses[1].status, 400);
  EXPECT_EQ(fixture.show.link.value_snapshot_requests.load(), 0u);
}

TEST(QueryHub, RequestTimesOut) {
  QueryHubFixture fixture;
  fixture.request("/scene/wind?VALUE");
  current_time += QueryHub::kRequestTimeout - 0.01;
  fixture.hub.update();
  EXPECT_TRUE(fixture.responses.empty());
  current_time += 0.02;
  fixture.hub.update();
  ASSERT_EQ(fixture.responses.size(), 1u);
  EXPECT_EQ(fixture.responses[0].status, 503);
  // an older snapshot is better than no response
  engine::test::make_value_snapshot(fixture.show);
  fixture.request("/scene/wind?VALUE");
  current_time += QueryHub::kRequestTimeout + 0.01;
  fixture.hub.update();
  ASSERT_EQ(fixture.responses.size(), 2u);
  EXPECT_EQ(fixture.responses[1].body, R"({"VALUE":[0]})");
}

TEST(QueryHub, LimitsPendingRequests) {
  QueryHubFixture fixture;
  for (std::size_t i = 0; i < QueryHub::kMaxRequests; i++) fixture.request("/scene/wind?VALUE");
  EXPECT_TRUE(fixture.responses.empty());
  fixture.request("/scene/wind?VALUE");
  ASSERT_EQ(fixture.responses.size(), 1u);
  EXPECT_EQ(fixture.responses[0].status, 503);
  fixture.make_snapshot();
  EXPECT_EQ(fixture.responses.size(), QueryHub::kMaxRequests + 1);
}

TEST(QueryHub, UpdatesClientsOncePerTick) {
  QueryHubFixture fixture;
  FrameSink line;
  QueryClient client({CommandSource::oscquery, 1, 1}, line, fixture.hub.host());
  fixture.hub.add_client(client);
  client.on_text(R"({"COMMAND":"LISTEN","DATA":"/scene/wind"})");
  fixture.make_snapshot();
  EXPECT_EQ(line.consume_frames(), Frames{"/scene/wind f 0"});
  // snapshots requested by others are not sent to clients
  fixture.show.send("/scene/wind", 1);
  engine::test::make_value_snapshot(fixture.show);
  fixture.hub.on_link_event();
  EXPECT_EQ(line.consume_frames(), Frames{});
  const std::uint64_t asks = fixture.show.link.value_snapshot_requests.load();
  current_time += QueryHub::kUpdateInterval;
  fixture.hub.update();
  fixture.hub.update();
  EXPECT_EQ(fixture.show.link.value_snapshot_requests.load(), asks + 1) << "one is on its way";
  fixture.make_snapshot();
  EXPECT_EQ(line.consume_frames(), Frames{"/scene/wind f 1"});
  fixture.hub.remove_client(client);
  EXPECT_FALSE(fixture.hub.busy());
}

TEST(QueryHub, IdleClientsRequestFewSnapshots) {
  QueryHubFixture fixture;
  FrameSink line;
  QueryClient client({CommandSource::oscquery, 1, 1}, line, fixture.hub.host());
  fixture.hub.add_client(client);
  const std::uint64_t asks = fixture.show.link.value_snapshot_requests.load();
  for (int i = 0; i < 60; i++) {
    current_time += QueryHub::kUpdateInterval;
    fixture.hub.update();
    fixture.make_snapshot();
  }
  EXPECT_LE(fixture.show.link.value_snapshot_requests.load() - asks, 11u) << "2 s, five a second";
  // they get path events nevertheless
  ASSERT_TRUE(fixture.show.engine.world().add_body("new").ok());
  for (int i = 0; i < 7; i++) {
    current_time += QueryHub::kUpdateInterval;
    fixture.hub.update();
    fixture.make_snapshot();
  }
  EXPECT_EQ(line.consume_frames(), Frames{R"({"COMMAND":"PATH_ADDED","DATA":"/physics/body/new"})"});
  fixture.hub.remove_client(client);
}

// A client that requests values repeatedly must not delay those of others.
TEST(QueryHub, RepeatedRequestsDoNotDelayPendingOne) {
  QueryHubFixture fixture;
  FrameSink line;
  QueryClient client({CommandSource::oscquery, 1, 1}, line, fixture.hub.host());
  fixture.hub.add_client(client);
  client.on_text(R"({"COMMAND":"LISTEN","DATA":"/scene/wind"})");
  const std::uint64_t ask = fixture.show.link.value_snapshot_requests.load();
  for (int i = 0; i < 100; i++) fixture.hub.request_values();
  EXPECT_EQ(fixture.show.link.value_snapshot_requests.load(), ask);
  fixture.make_snapshot();
  EXPECT_EQ(line.consume_frames(), Frames{"/scene/wind f 0"});
  EXPECT_EQ(fixture.show.link.value_snapshot_requests.load(), ask + 1) << "one more for all requests";
  fixture.hub.remove_client(client);
}

TEST(QueryHub, SendsRepliesToOrigin) {
  QueryHubFixture fixture;
  FrameSink one;
  FrameSink two;
  QueryClient first({CommandSource::oscquery, 1, 1}, one, fixture.hub.host());
  QueryClient second({CommandSource::oscquery, 1, 2}, two, fixture.hub.host());
  fixture.hub.add_client(first);
  fixture.hub.add_client(second);
  fixture.show.link.command_queue.push({{engine::test::message("/get", "/scene/wind")}, second.origin()});
  fixture.show.link.command_queue.push({{engine::test::message("/scene/wind", "much")}, first.origin()});
  fixture.show.link.command_queue.push(
      {{engine::test::message("/get", "/scene/wind")}, {CommandSource::oscquery, 1, 3}});
  fixture.show.ticks(1);
  fixture.hub.on_link_event();
  EXPECT_EQ(two.consume_frames(), Frames{"/scene/wind  0"});
  EXPECT_EQ(one.consume_frames(), Frames{"/error  /scene/wind takes 1 number, not 'much'"});
  fixture.hub.remove_client(first);
  fixture.hub.remove_client(second);
}

}  // namespace
}  // namespace limber::oscquery::test

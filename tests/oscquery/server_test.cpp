// The server on real sockets: HTTP and WebSocket on one port; malformed, slow and excessive clients; ports in use.
#include "net/oscquery/server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include <nlohmann/json.hpp>

#include "base/log/log.h"
#include "engine/everything.h"
#include "engine/show.h"
#include "oscquery/fake_doors.h"
#include "oscquery/web_client.h"

namespace limber::oscquery::test {
namespace {

using nlohmann::json;

// A running engine with the server in front of it. Packets of clients are "address number" and set that value.
struct ServerFixture {
  engine::test::SceneFile file{engine::test::kEverything};
  engine::EngineLink link;
  engine::Engine engine{link, options(file.path())};
  QueryServer server{link, host()};
  std::thread sim;

  explicit ServerFixture(bool plays = true) {
    EXPECT_TRUE(engine.start().ok());
    const Result<void> started = server.start({"127.0.0.1", 0});
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error());
    if (plays) sim = std::thread([this] { engine.run(); });
  }
  ~ServerFixture() {
    engine.stop();
    if (sim.joinable()) sim.join();
    server.stop();
  }
  static engine::EngineOptions options(const std::string& scene) {
    engine::EngineOptions options;
    options.scene = scene;
    return options;
  }
  QueryHost host() {
    QueryHost fake = fake_query_host();
    fake.process = [this](const CommandOrigin& origin, const std::string& packet) {
      const std::size_t space = packet.find(' ');
      link.command_queue.push(
          {{engine::test::message(packet.substr(0, space), std::atof(packet.c_str() + space))}, origin});
      link.wake_engine();
    };
    return fake;
  }
  WebClient client() const { return WebClient(server.port()); }
  WebClient web_socket() const {
    WebClient client(server.port());
    EXPECT_EQ(client.upgrade().status, 101);
    return client;
  }
};

TEST(QueryServer, ReusesHttpConnection) {
  const ServerFixture fixture;
  WebClient client = fixture.client();
  for (int i = 0; i < 3; i++) {
    const Reply value = client.get("/scene/where?VALUE");
    EXPECT_EQ(value.status, 200);
    EXPECT_EQ(value.body, R"({"VALUE":[0,0,1]})");
    EXPECT_TRUE(value.has_header("Content-Type: application/json"));
    EXPECT_TRUE(value.has_header("X-Content-Type-Options: nosniff"));
  }
  EXPECT_EQ(json::parse(client.get("/").body)["CONTENTS"]["scene"]["CONTENTS"].size(), 4u);
  EXPECT_EQ(client.get("/scene/wind?UNIT").status, 200);
  EXPECT_EQ(client.get("/transport/play?VALUE").status, 204);
  EXPECT_EQ(client.get("/nowhere").status, 404);
  const Reply head = client.get("/?HOST_INFO", "", "HEAD");
  EXPECT_EQ(head.status, 200);
  EXPECT_TRUE(head.body.empty());
  EXPECT_EQ(client.get("/", "", "DELETE").status, 405);
  const Reply page = client.get("/", "Accept: text/html\r\n");
  EXPECT_TRUE(page.has_header("Content-Security-Policy: default-src 'none'"));
  const Reply last = client.get("/scene/wind?VALUE", "Connection: close\r\n");
  EXPECT_EQ(last.status, 200);
  EXPECT_TRUE(client.is_closed());
}

TEST(QueryServer, WebSocketListensAndSets) {
  const ServerFixture fixture;
  WebClient one = fixture.client();
  const Reply upgraded = one.upgrade();
  EXPECT_EQ(upgraded.status, 101);
  EXPECT_TRUE(upgraded.has_header("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo="));
  WebClient two = fixture.web_socket();
  for (WebClient* client : {&one, &two}) {
    client->listen("/scene/wind");
    EXPECT_EQ(client->receive(2, "/scene/wind").payload, "/scene/wind f 0");
  }
  one.binary("/scene/wind 4");
  EXPECT_EQ(two.receive(2, "").payload, "/scene/wind f 4");
  // frames are ordered, so this value would arrive after an echo of the earlier one
  two.binary("/scene/wind 5");
  EXPECT_EQ(one.receive(2, "").payload, "/scene/wind f 5");
  EXPECT_EQ(two.until_pong("a"), std::vector<std::string>{});
  EXPECT_EQ(one.until_pong("b"), std::vector<std::string>{});
  // HTTP and the other WebSocket agree
  EXPECT_EQ(fixture.client().get("/scene/wind?VALUE").body, R"({"VALUE":[5]})");
}

// Runs the engine's ticks during its lifetime.
class EngineTicks {
 public:
  explicit EngineTicks(engine::Engine& engine)
      : thread_([this, &engine] {
          while (!stop_) engine.tick();
        }) {}
  ~EngineTicks() {
    stop_ = true;
    thread_.join();
  }
  EngineTicks(const EngineTicks&) = delete;
  EngineTicks& operator=(const EngineTicks&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(QueryServer, ReportsAddedAndRemovedBodies) {
  ServerFixture fixture(false);
  sim::World& world = fixture.engine.world();
  WebClient client = fixture.web_socket();
  client.listen("/scene/wind");
  {
    const EngineTicks ticks(fixture.engine);
    EXPECT_EQ(client.receive(2, "/scene/wind").opcode, 2);
  }
  ASSERT_TRUE(world.copy_body(*world.find_body("free"), "late").ok());
  {
    const EngineTicks ticks(fixture.engine);
    EXPECT_EQ(client.receive(1, "PATH_").payload, R"({"COMMAND":"PATH_ADDED","DATA":"/physics/body/late"})");
    client.listen("/physics/body/late/part/free/friction");
    EXPECT_EQ(client.receive(2, "late").payload, "/physics/body/late/part/free/friction f 0.5");
  }
  world.remove_body(*world.find_body("late"));
  const EngineTicks ticks(fixture.engine);
  EXPECT_EQ(client.receive(1, "PATH_").payload, R"({"COMMAND":"PATH_REMOVED","DATA":"/physics/body/late"})");
}

TEST(QueryServer, RejectsUnknownOrigins) {
  const ServerFixture fixture;
  WebClient client = fixture.client();
  EXPECT_EQ(client.get("/scene", "Origin: http://evil.example\r\n").status, 403);
  EXPECT_EQ(client.upgrade("Origin: http://evil.example\r\n").status, 403);
  WebClient named = fixture.client();
  named.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(named.reply().status, 403);
  WebClient own = fixture.client();
  EXPECT_EQ(own.upgrade("Origin: http://" + own.host() + "\r\n").status, 101);
}

TEST(QueryServer, InvalidInputClosesOnlyItsConnection) {
  const ServerFixture fixture;
  WebClient good = fixture.web_socket();
  good.listen("/scene/wind");
  EXPECT_EQ(good.receive(2, "/scene/wind").opcode, 2);
  struct Bad {
    std::string bytes;
    int status;  // 0: no response
  };
  const std::vector<Bad> bad = {
      {"\r\n\r\n\r\n", 400},
      {"nonsense\r\n\r\n", 400},
      {std::string("\0\1\2\3\xff\r\n\r\n", 9), 400},
      {"GET / HTTP/9.9\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\n\r\n", 400},
      {"GET /scene HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello", 413},
      {"GET /scene HTTP/1.1\r\nHost: localhost\r\nContent-Length: x\r\n\r\n", 400},
      {"GET /scene HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20000, 'x'), 431},
      {"GET /" + std::string(20000, 'x'), 431},
      {"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n", 400},
      {"#bundle", 0},
  };
  for (const Bad& b : bad) {
    WebClient client = fixture.client();
    client.send(b.bytes);
    if (b.status == 0) {
      client.close();
    } else {
      EXPECT_EQ(client.reply().status, b.status) << b.bytes.substr(0, 60);
    }
  }
  // frames that violate the protocol close the connection
  const auto ends = [&](const std::function<void(const WebClient&)>& sin) {
    WebClient client = fixture.web_socket();
    sin(client);
    return client.is_closed();
  };
  EXPECT_TRUE(ends([](const WebClient& c) { c.frame(3, "no such opcode"); }));
  EXPECT_TRUE(ends([](const WebClient& c) { c.send("\x81\x05hello"); })) << "not masked";
  EXPECT_TRUE(ends([](const WebClient& c) { c.text("\xff\xfe is no UTF-8"); }));
  EXPECT_TRUE(ends([](const WebClient& c) { c.frame(0, "the rest of nothing"); }));
  EXPECT_TRUE(ends([](const WebClient& c) { c.binary(std::string(70000, 'x')); })) << "too large";
  EXPECT_TRUE(ends([](const WebClient& c) { c.frame(9, std::string(200, 'x')); })) << "a ping is short";
  // text that is no command and packets that are no OSC do not
  WebClient odd = fixture.web_socket();
  for (const char* text : {"", "{", "[[[[", "{\"COMMAND\":7}"}) odd.text(text);
  odd.frame(1, "{\"COMM", false);
  odd.frame(0, "AND\":\"LISTEN\",\"DATA\":\"/scene/lively\"}");
  EXPECT_EQ(odd.receive(2, "").payload, "/scene/lively T 1") << "in pieces, as is allowed";
  good.binary("/scene/lively 0");
  EXPECT_EQ(odd.receive(2, "").payload, "/scene/lively T 0");
}

// True if the server drops a client that reads nothing, detected by sending to it.
bool is_dropped(const WebClient& client) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
  while (std::chrono::steady_clock::now() < until) {
    if (!client.frame(9, "x")) return true;
    pollfd p{client.fd(), POLLRDHUP, 0};
    if (poll(&p, 1, 20) > 0) return true;
  }
  return false;
}

// A client that receives nothing is dropped, and delays no other client meanwhile.
TEST(QueryServer, DropsSlowClient) {
  const ServerFixture fixture;
  WebClient slow(fixture.server.port(), 4096);
  ASSERT_EQ(slow.upgrade().status, 101);
  slow.listen("//*");  // includes values that change all the time
  WebClient good = fixture.web_socket();
  good.listen("/scene/wind");
  EXPECT_EQ(good.receive(2, "/scene/wind").opcode, 2);
  bool dropped = false;
  std::thread waits([&] { dropped = is_dropped(slow); });
  for (int i = 1; i <= 20; i++) {
    WebClient other = fixture.web_socket();
    other.binary("/scene/wind " + std::to_string(0.25 * i));
    EXPECT_EQ(good.receive(2, "").payload, "/scene/wind f " + number_text(0.25 * i));
  }
  waits.join();
  EXPECT_TRUE(dropped);
  good.binary("/scene/wind 9");
  EXPECT_EQ(good.until_pong("still here"), std::vector<std::string>{});
}

TEST(QueryServer, LimitsConnections) {
  const ServerFixture fixture;
  std::vector<WebClient> idle;
  idle.reserve(256);
  for (int i = 0; i < 256; i++) idle.emplace_back(fixture.server.port(), 0, 1 + static_cast<std::uint32_t>(i) / 64);
  WebClient late(fixture.server.port(), 0, 9);
  EXPECT_EQ(late.reply().status, 503) << "rejected with a status";
  EXPECT_TRUE(late.is_closed());
  EXPECT_EQ(idle.back().get("/scene/wind?VALUE").status, 200) << "accepted clients are served";
  idle.clear();
  // connections are available again as soon as the server notices that
  for (int tries = 0; tries < 100; tries++) {
    WebClient next = fixture.client();
    const Reply reply = next.get("/scene/wind?VALUE");
    if (reply.status == 200) return;
    EXPECT_EQ(reply.status, 503);
  }
  ADD_FAILURE() << "no more clients are accepted";
}

TEST(QueryServer, LimitsConnectionsPerAddress) {
  const ServerFixture fixture;
  std::vector<WebClient> greedy;
  greedy.reserve(100);
  for (int i = 0; i < 100; i++) greedy.emplace_back(fixture.server.port(), 0, 2);
  // all requests before the first response: the server closes connections that send none for ten seconds
  const std::string request = "GET /?HOST_INFO HTTP/1.1\r\nHost: " + greedy[0].host() + "\r\n\r\n";
  for (const WebClient& client : greedy) client.send(request);
  int served = 0;
  for (WebClient& client : greedy) served += client.reply().status == 200;
  EXPECT_EQ(served, 64);
  EXPECT_EQ(fixture.client().get("/scene/wind?VALUE").status, 200);
}

TEST(QueryServer, RejectedConnectionsDoNotCount) {
  const ServerFixture fixture;
  std::vector<WebClient> greedy;
  greedy.reserve(300);
  for (int i = 0; i < 300; i++) greedy.emplace_back(fixture.server.port(), 0, 2);
  EXPECT_EQ(fixture.client().get("/scene/wind?VALUE").status, 200);
}

TEST(QueryServer, RespondsWithoutRunningEngine) {
  const ServerFixture fixture(false);
  WebClient client = fixture.client();
  EXPECT_EQ(client.get("/?HOST_INFO").status, 200);
  EXPECT_EQ(client.get("/scene/wind?VALUE").status, 503);
}

TEST(QueryServer, ReportsPortInUseWithCorrection) {
  const ServerFixture fixture;
  engine::EngineLink link;
  QueryServer second(link, fake_query_host());
  const std::uint16_t port = fixture.server.port();
  const Result<void> second_start = second.start({"127.0.0.1", port});
  ASSERT_FALSE(second_start.ok());
  EXPECT_EQ(second_start.error(),
            "OSCQuery can't listen on 127.0.0.1:" + std::to_string(port) +
                " (TCP): Address already in use. Choose another port with --query [ADDR:]PORT, or "
                "continue without it with --query off or --osc-optional");
  EXPECT_EQ(second.port(), 0);
  const Result<void> nowhere = second.start({"203.0.113.7", port});
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().find("203.0.113.7"), std::string::npos);
}

TEST(QueryServer, StopsWithClientsAndRestarts) {
  engine::EngineLink link;
  QueryServer server(link, fake_query_host());
  for (int i = 0; i < 3; i++) {
    ASSERT_TRUE(server.start({"127.0.0.1", 0}).ok());
    WebClient idle(server.port());
    WebClient listening(server.port());
    EXPECT_EQ(listening.upgrade().status, 101);
    listening.listen("/scene/wind");
    listening.until_pong("x");
    WebClient waiting(server.port());
    const std::uint64_t asked = link.value_snapshot_requests;
    waiting.send("GET /scene HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
    while (link.value_snapshot_requests == asked && std::chrono::steady_clock::now() < late) std::this_thread::yield();
    ASSERT_NE(link.value_snapshot_requests, asked);  // it waits for a snapshot now
    server.stop();
    EXPECT_TRUE(listening.is_closed());
    EXPECT_TRUE(idle.is_closed());
    link.wake_query();
  }
}

TEST(QueryServer, WarnsIfOpenToTheNetwork) {
  log_to_stderr(false);
  engine::EngineLink link;
  QueryServer server(link, fake_query_host());
  const std::uint64_t before = log_count(LogLevel::warning);
  ASSERT_TRUE(server.start({"0.0.0.0", 0}).ok());
  EXPECT_EQ(log_count(LogLevel::warning), before + 1);
  log_to_stderr(true);
}

TEST(QueryServer, AcceptsAllowedAddressesOnly) {
  engine::EngineLink link;
  QueryHost fake = fake_query_host();
  fake.is_allowed = [](const system::IpAddress& ip) { return !ip.is_loopback(); };
  QueryServer server(link, fake);
  ASSERT_TRUE(server.start({"127.0.0.1", 0}).ok());
  WebClient client(server.port());
  const Reply reply = client.reply();
  EXPECT_EQ(reply.status, 403);
  EXPECT_TRUE(client.is_closed());
}

}  // namespace
}  // namespace limber::oscquery::test

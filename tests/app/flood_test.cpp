// Twenty thousand datagrams per simulated second, valid, invalid and mutated, from four senders, while subscribers are
// dead and WebSocket clients don't read: all are counted, memory doesn't grow, no tick is lost, and well-behaved
// clients are served.
#include <malloc.h>

#include <chrono>
#include <thread>

#include "app/flood.h"
#include "app/show/query_host.h"
#include "base/log/log.h"
#include "engine/show.h"
#include "net/osc/packets/decode.h"
#include "oscquery/web_client.h"
#include "support/skip.h"

namespace limber::app::test {
namespace {

using namespace osc::test;
using oscquery::test::WebClient;

constexpr int kTicks = 180;           // 3 s of simulated time
constexpr int kWarmUp = 60;           // ticks before memory is measured
constexpr int kPerTick = 334;         // 20 040 a second
constexpr int kBatch = 100;           // datagrams that every kernel buffers
constexpr double kMaxGrowth = 1.5e6;  // bytes; up to 1 MiB may be queued for a client that doesn't read

osc::OscOptions only_in() {
  osc::OscOptions options;
  options.in = *osc::parse_osc_in("0");
  options.out.emplace();
  return options;
}

double heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// the whole program except its window; the test runs the ticks
struct FloodFixture {
  engine::test::SceneFile file{kFloodScene};
  engine::EngineLink link;
  engine::Engine engine{link, engine::test::fast_options(file.path())};
  osc::Network network{link, only_in(), engine::transient_offsets()};
  oscquery::QueryServer query{link, query_host(network, {})};
  system::Endpoint endpoint;
  int ticks = 0;

  FloodFixture() {
    EXPECT_TRUE(engine.start().ok());
    EXPECT_TRUE(network.start().ok());
    EXPECT_TRUE(query.start({"127.0.0.1", 0}).ok());
    endpoint = network.bound().at(0);
  }
  ~FloodFixture() {
    query.stop();
    network.stop();
  }

  void tick() {
    engine.tick();
    ticks++;
  }
  // datagrams that the network thread has processed
  std::uint64_t processed() const {
    const engine::Counters& c = link.counters;
    return c.received + c.malformed + c.denied + c.dropped_kernel;
  }
  bool wait_until_processed(std::uint64_t count) const {
    const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
    while (processed() < count) {
      if (std::chrono::steady_clock::now() > late) return false;
      std::this_thread::yield();
    }
    return true;
  }
  // runs ticks until the client has received a message with that address
  std::optional<Message> wait_for_reply(const Client& client, std::string_view address) {
    const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
    while (std::chrono::steady_clock::now() < late) {
      tick();
      for (auto bytes = client.receive(1); bytes; bytes = client.receive(0)) {
        const Result<osc::Decoded> decoded = osc::decode_packet(bytes->data(), bytes->size());
        if (decoded && decoded->messages.at(0).address == address) return decoded->messages[0];
      }
    }
    return std::nullopt;
  }
};

// clients that subscribe and close their socket: packets to them are refused
std::uint64_t dead_subscribers(const system::Endpoint& end) {
  std::uint64_t sent = 0;
  for (int i = 0; i < 8; i++) {
    const Client closed;
    for (const char* path : {"pos", "rot", "/scene/wind", "//*"}) {
      closed.send(end, Bytes().text("/subscribe").text(",sf").text(path).f(500).str());
      sent++;
    }
  }
  return sent;
}

std::vector<WebClient> unread_clients(std::uint16_t port) {
  std::vector<WebClient> unread;
  for (const char* path : {"//*", "/scene/wind", "/physics/body/arm/part/tip/position", "/osc/received"}) {
    unread.emplace_back(port, 4096);
    EXPECT_EQ(unread.back().upgrade().status, 101);
    unread.back().listen(path);
  }
  return unread;
}

// a client that sets and queries a value during the flood: each value is set, each query answered, in order
class Requester {
 public:
  explicit Requester(FloodFixture& fixture) : fixture_(fixture) {}

  std::uint64_t send() {
    value_++;
    client_.send(fixture_.endpoint, one_float("/scene/wind", value_));
    client_.send(fixture_.endpoint, Bytes().text("/get").text(",s").text("/scene/wind").str());
    client_.send(fixture_.endpoint, Bytes().text("/ping").str());
    return 3;
  }
  void expect_reply() {
    const std::optional<Message> reply = fixture_.wait_for_reply(client_, "/scene/wind");
    ASSERT_TRUE(reply) << "value " << value_ << " was not answered";
    EXPECT_EQ(reply->args.at(0).number, value_);
  }

 private:
  FloodFixture& fixture_;
  Client client_;
  float value_ = 0;
};

// the totals after all datagrams have been processed
FloodSum sum_of(FloodFixture& fixture, std::uint64_t sent, std::uint64_t others) {
  const Client client;
  client.send(fixture.endpoint, Bytes().text("/count").str());
  const std::optional<Message> count = fixture.wait_for_reply(client, "/count");
  EXPECT_TRUE(count);
  const engine::Counters& c = fixture.link.counters;
  FloodSum sum;
  sum.sent = sent;
  sum.values = Flood::count_of(Flood::Kind::value, sent);
  sum.hits = count ? static_cast<std::uint64_t>(count->args.at(0).number) : 0;
  sum.mutants = count ? static_cast<std::uint64_t>(count->args.at(1).number) : 0;
  sum.unknown = c.unknown;
  sum.rejected = c.refused;
  sum.malformed = c.malformed;
  sum.dropped = c.dropped;
  sum.dropped_kernel = c.dropped_kernel;
  EXPECT_EQ(c.received + c.malformed + c.dropped_kernel, sent + others + 1);
  return sum;
}

TEST(Flood, CountsEveryDatagram) {
  log_to_stderr(false);
  FloodFixture fixture;
  const double none = 0;  // the history stores incoming messages, within its own limit
  ASSERT_TRUE(fixture.engine.store().set(fixture.engine.world().id(), "history", {&none, 1}).ok());
  std::uint64_t others = dead_subscribers(fixture.endpoint);
  const std::vector<WebClient> unread = unread_clients(fixture.query.port());
  WebClient listener(fixture.query.port());
  ASSERT_EQ(listener.upgrade().status, 101);
  listener.listen("/scene/wind");
  const std::array<Client, 4> senders;
  Requester asker(fixture);
  Flood flood(1);
  std::uint64_t sent = 0;
  double heap_then = 0;
  for (int i = 0; i < kWarmUp + kTicks; i++) {
    if (i == kWarmUp) heap_then = heap();
    for (int n = 0; n < kPerTick; n++) {
      senders[sent % senders.size()].send(fixture.endpoint, flood.next());
      sent++;
      if (n == kPerTick / 2) others += asker.send();
      if (n % kBatch == kBatch - 1) {
        ASSERT_TRUE(fixture.wait_until_processed(sent + others));
      }
    }
    ASSERT_TRUE(fixture.wait_until_processed(sent + others));
    asker.expect_reply();
    if (HasFatalFailure()) return;
  }
  EXPECT_LT(heap(), heap_then + kMaxGrowth);

  const FloodSum sum = sum_of(fixture, sent, others);
  EXPECT_EQ(sum.total(), sent);
  EXPECT_EQ(sum.hits, Flood::count_of(Flood::Kind::hit, sent));
  EXPECT_EQ(sum.dropped + sum.dropped_kernel, 0u) << "paced, nothing is lost";
  EXPECT_GT(sum.mutants, 0u);
  EXPECT_GT(sum.malformed, Flood::count_of(Flood::Kind::malformed, sent)) << "some mutants are no OSC";
  EXPECT_GE(sum.unknown, Flood::count_of(Flood::Kind::unknown, sent));
  EXPECT_GE(sum.rejected, Flood::count_of(Flood::Kind::rejected, sent));
  // no tick is lost, and time advances with the ticks
  EXPECT_EQ(fixture.engine.world().tick(), static_cast<std::uint64_t>(fixture.ticks));
  EXPECT_NEAR(fixture.engine.world().time(), fixture.ticks / 60.0, 1e-9);
  EXPECT_EQ(fixture.engine.world().stability().events(), 0u);
  // the WebSocket client receives the latest value
  const std::string newest = one_float("/scene/wind", kWarmUp + kTicks);
  std::string heard;
  for (int tries = 0; tries < kTimeoutMs && heard != newest; tries++) {
    fixture.tick();
    const oscquery::test::Frame frame = listener.receive(1);
    if (frame.opcode == 2) heard = frame.payload;
  }
  EXPECT_EQ(heard, newest);
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::app::test

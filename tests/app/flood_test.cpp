// Twenty thousand datagrams a second of stage time, good, bad and mutated, by four senders, while subscribers are dead
// and WebSockets never read: everything is counted, nothing grows, every tick happens, who behaves is served.
#include <malloc.h>

#include <chrono>
#include <thread>

#include "app/flood.h"
#include "app/query_doors.h"
#include "base/log.h"
#include "engine/show.h"
#include "osc/decode.h"
#include "query/web_client.h"

namespace limber::app_test {
namespace {

using namespace osc_test;
using query_test::WebClient;

constexpr int kTicks = 180;           // 3 s of stage time
constexpr int kWarmUp = 60;           // ticks before memory is looked at
constexpr int kEachTick = 334;        // 20 040 a second
constexpr int kAtATime = 100;         // datagrams that every kernel keeps for us
constexpr double kMostGrown = 1.5e6;  // bytes; a client that never reads may have 1 MiB waiting for it

OscOptions only_in() {
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out.emplace();
  return options;
}

double heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// the whole program but its window, ticked by hand
struct FloodedStage {
  engine_test::SceneFile file{kFloodScene};
  EngineLink link;
  Engine engine{link, engine_test::fast_options(file.path())};
  Network network{link, only_in(), live_offsets()};
  QueryServer query{link, query_doors(network, {})};
  Endpoint end;
  int ticks = 0;

  FloodedStage() {
    EXPECT_TRUE(engine.start().ok());
    EXPECT_TRUE(network.start().ok());
    EXPECT_TRUE(query.start({"127.0.0.1", 0}).ok());
    end = network.bound().at(0);
  }
  ~FloodedStage() {
    query.stop();
    network.stop();
  }

  void tick() {
    engine.tick();
    ticks++;
  }
  // datagrams of which the network thread knows what they were
  std::uint64_t taken() const {
    const Counters& c = link.counters;
    return c.received + c.malformed + c.denied + c.dropped_kernel;
  }
  bool until_taken(std::uint64_t count) const {
    const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatienceMs);
    while (taken() < count) {
      if (std::chrono::steady_clock::now() > late) return false;
      std::this_thread::yield();
    }
    return true;
  }
  // ticks until the client has heard a message of that address
  std::optional<Message> answer(const Client& client, std::string_view address) {
    const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatienceMs);
    while (std::chrono::steady_clock::now() < late) {
      tick();
      for (auto bytes = client.receive(1); bytes; bytes = client.receive(0)) {
        const Result<Decoded> decoded = decode_packet(bytes->data(), bytes->size());
        if (decoded && decoded->messages.at(0).address == address) return decoded->messages[0];
      }
    }
    return std::nullopt;
  }
};

// subscribed and gone: what is sent to them comes back as refused
std::uint64_t dead_subscribers(const Endpoint& end) {
  std::uint64_t sent = 0;
  for (int i = 0; i < 8; i++) {
    const Client gone;
    for (const char* what : {"pos", "rot", "/scene/wind", "//*"}) {
      gone.send(end, Bytes().text("/subscribe").text(",sf").text(what).f(500).str());
      sent++;
    }
  }
  return sent;
}

std::vector<WebClient> deaf_listeners(std::uint16_t port) {
  std::vector<WebClient> deaf;
  for (const char* path : {"//*", "/scene/wind", "/physics/body/arm/part/tip/position", "/osc/received"}) {
    deaf.emplace_back(port, 4096);
    EXPECT_EQ(deaf.back().upgrade().status, 101);
    deaf.back().listen(path);
  }
  return deaf;
}

// one who plays and asks amid the flood: each value is set, each question answered, in order
class Asker {
 public:
  explicit Asker(FloodedStage& stage) : stage_(stage) {}

  std::uint64_t turn() {
    value_++;
    client_.send(stage_.end, one_float("/scene/wind", value_));
    client_.send(stage_.end, Bytes().text("/get").text(",s").text("/scene/wind").str());
    client_.send(stage_.end, Bytes().text("/ping").str());
    return 3;
  }
  void hear() {
    const std::optional<Message> said = stage_.answer(client_, "/scene/wind");
    ASSERT_TRUE(said) << "value " << value_ << " was not answered";
    EXPECT_EQ(said->args.at(0).number, value_);
  }

 private:
  FloodedStage& stage_;
  Client client_;
  float value_ = 0;
};

// all that a flood of datagrams was, when all of it has been carried out
FloodSum sum_of(FloodedStage& stage, std::uint64_t sent, std::uint64_t others) {
  const Client client;
  client.send(stage.end, Bytes().text("/count").str());
  const std::optional<Message> count = stage.answer(client, "/count");
  EXPECT_TRUE(count);
  const Counters& c = stage.link.counters;
  FloodSum sum;
  sum.sent = sent;
  sum.values = Flood::count_of(Flood::Kind::value, sent);
  sum.hits = count ? static_cast<std::uint64_t>(count->args.at(0).number) : 0;
  sum.mutants = count ? static_cast<std::uint64_t>(count->args.at(1).number) : 0;
  sum.unknown = c.unknown;
  sum.refused = c.refused;
  sum.malformed = c.malformed;
  sum.dropped = c.dropped;
  sum.dropped_kernel = c.dropped_kernel;
  EXPECT_EQ(c.received + c.malformed + c.dropped_kernel, sent + others + 1);
  return sum;
}

TEST(Flood, TwentyThousandASecondOfEveryKind) {
  log_to_stderr(false);
  FloodedStage stage;
  const double none = 0;  // history keeps what comes in, within bounds of its own
  ASSERT_TRUE(stage.engine.store().set(stage.engine.world().id(), "history", {&none, 1}).ok());
  std::uint64_t others = dead_subscribers(stage.end);
  const std::vector<WebClient> deaf = deaf_listeners(stage.query.port());
  WebClient listener(stage.query.port());
  ASSERT_EQ(listener.upgrade().status, 101);
  listener.listen("/scene/wind");
  const std::array<Client, 4> senders;
  Asker asker(stage);
  Flood flood(1);
  std::uint64_t sent = 0;
  double heap_then = 0;
  for (int i = 0; i < kWarmUp + kTicks; i++) {
    if (i == kWarmUp) heap_then = heap();
    for (int n = 0; n < kEachTick; n++) {
      senders[sent % senders.size()].send(stage.end, flood.next());
      sent++;
      if (n == kEachTick / 2) others += asker.turn();
      if (n % kAtATime == kAtATime - 1) {
        ASSERT_TRUE(stage.until_taken(sent + others));
      }
    }
    ASSERT_TRUE(stage.until_taken(sent + others));
    asker.hear();
    if (HasFatalFailure()) return;
  }
  EXPECT_LT(heap(), heap_then + kMostGrown);

  const FloodSum sum = sum_of(stage, sent, others);
  EXPECT_EQ(sum.accounted(), sent);
  EXPECT_EQ(sum.hits, Flood::count_of(Flood::Kind::hit, sent));
  EXPECT_EQ(sum.dropped + sum.dropped_kernel, 0u) << "paced, nothing is lost";
  EXPECT_GT(sum.mutants, 0u);
  EXPECT_GT(sum.malformed, Flood::count_of(Flood::Kind::malformed, sent)) << "some mutants are no OSC";
  EXPECT_GE(sum.unknown, Flood::count_of(Flood::Kind::unknown, sent));
  EXPECT_GE(sum.refused, Flood::count_of(Flood::Kind::refused, sent));
  // every tick was one, and time went on with them
  EXPECT_EQ(stage.engine.world().tick(), static_cast<std::uint64_t>(stage.ticks));
  EXPECT_NEAR(stage.engine.world().time(), stage.ticks / 60.0, 1e-9);
  EXPECT_EQ(stage.engine.world().health_events(), 0u);
  // who listens by WebSocket hears the newest
  const std::string newest = one_float("/scene/wind", kWarmUp + kTicks);
  std::string heard;
  for (int tries = 0; tries < kPatienceMs && heard != newest; tries++) {
    stage.tick();
    const query_test::Frame frame = listener.receive(1);
    if (frame.opcode == 2) heard = frame.payload;
  }
  EXPECT_EQ(heard, newest);
  log_to_stderr(true);
}

}  // namespace
}  // namespace limber::app_test

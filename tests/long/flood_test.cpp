// Floods the running program with datagrams, as fast as three senders can for twenty seconds: it counts every one, does
// not grow, serves well-behaved clients, and responds normally afterwards.
#include <atomic>
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include "app/flood.h"
#include "app/program.h"
#include "engine/output/engine_link.h"
#include "oscquery/web_client.h"

namespace limber::app::test {
namespace {

using namespace osc::test;
using oscquery::test::WebClient;
using Seconds = std::chrono::duration<double>;

constexpr int kSenders = 3;
constexpr double kDuration = 20;           // s
constexpr std::size_t kDatagrams = 10000;  // different datagrams, sent repeatedly
// bytes: the maximum size of the queue, and as much again for commands being carried out
constexpr double kMaxGrowth = 2.0 * engine::EngineLink::kMaxBytes + 32e6;

struct Program {
  TempFolder folder;
  Process running{limber_command({folder.file("s.lua", kFloodScene), "--osc-in", "127.0.0.1:0", "--osc-out", "off"})};
  system::Endpoint osc{0x7f000001, 0};
  std::uint16_t web = 0;
  int pid = 0;

  Program() {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    osc.port = static_cast<std::uint16_t>(number_after("OSC in 127.0.0.1:"));
    web = static_cast<std::uint16_t>(number_after("remote panel http://127.0.0.1:"));
    pid = number_after("/limber-");
  }
  int number_after(const std::string& prefix) const {
    const std::size_t at = running.err().rfind(prefix);
    return at == std::string::npos ? 0 : std::atoi(running.err().c_str() + at + prefix.size());
  }
  double value(const std::string& path) const {
    WebClient client(web);
    const auto reply = nlohmann::json::parse(client.get(path + "?VALUE").body, nullptr, false);
    return reply.is_object() && reply.contains("VALUE") ? reply["VALUE"].at(0).get<double>() : -1;
  }
  std::uint64_t count(const std::string& name) const { return static_cast<std::uint64_t>(value("/osc/" + name)); }
  /// Bytes of the history: the commands of the last seconds, up to a limit.
  double history() const { return value("/transport/history_memory") * (1u << 20u); }
  double resident() const {
    std::ifstream statm(fmt::format("/proc/{}/statm", pid));
    double all = 0;
    double pages = 0;
    statm >> all >> pages;
    return pages * 4096;
  }
};

std::uint64_t send_for(double seconds, const system::Endpoint& to, std::uint64_t seed) {
  Flood generator(seed);
  std::vector<std::string> datagrams;
  for (std::size_t i = 0; i < kDatagrams; i++) datagrams.push_back(generator.next());
  const Client client;
  std::uint64_t sent = 0;
  const auto start = std::chrono::steady_clock::now();
  while (Seconds(std::chrono::steady_clock::now() - start).count() < seconds) {
    for (const std::string& datagram : datagrams) client.send(to, datagram);
    sent += datagrams.size();
  }
  return sent;
}

// requests the scene's counts until they arrive; returns the number of datagrams it needed
std::uint64_t request_counts(const Program& program, FloodSum& sum) {
  const Client client;
  for (std::uint64_t request_count = 1; request_count <= 200; request_count++) {
    client.send(program.osc, Bytes().text("/count").str());
    for (auto bytes = client.receive(100); bytes; bytes = client.receive(0)) {
      const Result<osc::Decoded> decoded = osc::decode_packet(bytes->data(), bytes->size());
      if (!decoded || decoded->messages.at(0).address != "/count") continue;
      sum.hits = static_cast<std::uint64_t>(decoded->messages[0].args.at(0).number);
      sum.mutants = static_cast<std::uint64_t>(decoded->messages[0].args.at(1).number);
      return request_count;
    }
  }
  ADD_FAILURE() << "the program does not respond any more";
  return 200;
}

TEST(Flood, CountsAndSurvivesThreeSendersForTwentySeconds) {
  Program program;
  ASSERT_NE(program.pid, 0) << program.running.err();
  {
    const Client closed_client;
    for (const char* stream : {"pos", "rot", "//*"})
      closed_client.send(program.osc, Bytes().text("/subscribe").text(",sf").text(stream).f(500).str());
  }
  WebClient blocked_client(program.web, 4096);
  ASSERT_EQ(blocked_client.upgrade().status, 101);
  blocked_client.listen("//*");
  // one second first, for one-time allocations
  std::uint64_t sent = send_for(1, program.osc, 9);
  const double resident = program.resident() - program.history();
  const double tick = program.value("/physics/sim/tick");

  std::atomic<std::uint64_t> flooded{0};
  std::vector<std::thread> senders;
  for (std::uint64_t i = 0; i < kSenders; i++)
    senders.emplace_back([&, i] { flooded += send_for(kDuration, program.osc, i + 1); });
  // a well-behaved client is served meanwhile
  int answered = 0;
  for (int i = 0; i < 50; i++) answered += program.value("/scene/wind") == 0 ? 1 : 0;
  for (std::thread& sender : senders) sender.join();
  sent += flooded;
  const double speed = program.value("/transport/speed_reached");
  const double ticks = program.value("/physics/sim/tick") - tick;
  EXPECT_EQ(answered, 50);

  FloodSum sum;
  const std::uint64_t request_count = request_counts(program, sum);
  const std::uint64_t received = program.count("received");
  sum.malformed = program.count("malformed");
  sum.dropped = program.count("dropped");
  sum.dropped_kernel = program.count("dropped_kernel");
  // each complete datagram was one message; the subscriptions are three more
  EXPECT_EQ(received + sum.malformed + sum.dropped_kernel, sent + 3 + request_count);
  EXPECT_GT(ticks, 0);
  const double history = program.history();
  EXPECT_GT(history, 0);
  EXPECT_LT(program.resident() - history, resident + kMaxGrowth);
  fmt::print(
      "{:.0f} datagrams per second sent, {:.0f} received; dropped: {} by the kernel, {} here; {:.0f} ticks in {} s, "
      "speed {:.2f} at the end; resident {:.1f} and {:.1f} MB, {:.1f} MB more for the history\n",
      static_cast<double>(flooded) / kDuration, static_cast<double>(received + sum.malformed) / (kDuration + 1),
      sum.dropped_kernel, sum.dropped, ticks, kDuration, speed, resident / 1e6, (program.resident() - history) / 1e6,
      history / 1e6);
  program.running.signal(SIGINT);
  EXPECT_EQ(program.running.finish().code, 0);
}

}  // namespace
}  // namespace limber::app::test

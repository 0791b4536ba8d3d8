// A flood of datagrams against the running program, as fast as three senders can for twenty seconds: it counts every
// one, does not grow, serves who behaves, and answers afterwards as if nothing had been.
#include <atomic>
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include "app/flood.h"
#include "app/program.h"
#include "engine/link.h"
#include "query/web_client.h"

namespace limber::app_test {
namespace {

using namespace osc_test;
using query_test::WebClient;
using Seconds = std::chrono::duration<double>;

constexpr int kSenders = 3;
constexpr double kLasts = 20;         // s
constexpr std::size_t kEach = 10000;  // different datagrams, sent again and again
// bytes: as much as may wait, and as much again that is being carried out
constexpr double kMostGrown = 2.0 * EngineLink::kMostBytes + 32e6;

struct Program {
  Folder folder;
  Running running{limber({folder.file("s.lua", kFloodScene), "--osc-in", "127.0.0.1:0", "--osc-out", "off"})};
  Endpoint osc{0x7f000001, 0};
  std::uint16_t web = 0;
  int pid = 0;

  Program() {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    osc.port = static_cast<std::uint16_t>(number_behind("OSC in 127.0.0.1:"));
    web = static_cast<std::uint16_t>(number_behind("remote panel http://127.0.0.1:"));
    pid = number_behind("/limber-");
  }
  int number_behind(const std::string& mark) const {
    const std::size_t at = running.err().rfind(mark);
    return at == std::string::npos ? 0 : std::atoi(running.err().c_str() + at + mark.size());
  }
  double value(const std::string& path) const {
    WebClient client(web);
    const auto said = nlohmann::json::parse(client.get(path + "?VALUE").body, nullptr, false);
    return said.is_object() && said.contains("VALUE") ? said["VALUE"].at(0).get<double>() : -1;
  }
  std::uint64_t count(const std::string& row) const { return static_cast<std::uint64_t>(value("/osc/" + row)); }
  /// Bytes of what is kept to go back in time: all that was taken in the last seconds, up to a bound of its own.
  double history() const { return value("/transport/history_memory") * (1u << 20u); }
  double resident() const {
    std::ifstream statm(fmt::format("/proc/{}/statm", pid));
    double all = 0;
    double mine = 0;
    statm >> all >> mine;
    return mine * 4096;
  }
};

std::uint64_t send_for(double seconds, const Endpoint& to, std::uint64_t seed) {
  Flood flood(seed);
  std::vector<std::string> datagrams;
  for (std::size_t i = 0; i < kEach; i++) datagrams.push_back(flood.next());
  const Client client;
  std::uint64_t sent = 0;
  const auto start = std::chrono::steady_clock::now();
  while (Seconds(std::chrono::steady_clock::now() - start).count() < seconds) {
    for (const std::string& datagram : datagrams) client.send(to, datagram);
    sent += datagrams.size();
  }
  return sent;
}

// asks until the scene's counts come; how many datagrams that took
std::uint64_t ask_counts(const Program& program, FloodSum& sum) {
  const Client client;
  for (std::uint64_t asked = 1; asked <= 200; asked++) {
    client.send(program.osc, Bytes().text("/count").str());
    for (auto bytes = client.receive(100); bytes; bytes = client.receive(0)) {
      const Result<Decoded> decoded = decode_packet(bytes->data(), bytes->size());
      if (!decoded || decoded->messages.at(0).address != "/count") continue;
      sum.hits = static_cast<std::uint64_t>(decoded->messages[0].args.at(0).number);
      sum.mutants = static_cast<std::uint64_t>(decoded->messages[0].args.at(1).number);
      return asked;
    }
  }
  ADD_FAILURE() << "it does not answer any more";
  return 200;
}

TEST(Flood, AsFastAsThreeSendersCanForTwentySeconds) {
  Program program;
  ASSERT_NE(program.pid, 0) << program.running.err();
  {
    const Client gone;
    for (const char* what : {"pos", "rot", "//*"})
      gone.send(program.osc, Bytes().text("/subscribe").text(",sf").text(what).f(500).str());
  }
  WebClient deaf(program.web, 4096);
  ASSERT_EQ(deaf.upgrade().status, 101);
  deaf.listen("//*");
  // a second of it, so that what is made once is there
  std::uint64_t sent = send_for(1, program.osc, 9);
  const double resident = program.resident() - program.history();
  const double tick = program.value("/physics/sim/tick");

  std::atomic<std::uint64_t> flooded{0};
  std::vector<std::thread> senders;
  for (std::uint64_t i = 0; i < kSenders; i++)
    senders.emplace_back([&, i] { flooded += send_for(kLasts, program.osc, i + 1); });
  // who behaves is answered meanwhile
  int answered = 0;
  for (int i = 0; i < 50; i++) answered += program.value("/scene/wind") == 0 ? 1 : 0;
  for (std::thread& sender : senders) sender.join();
  sent += flooded;
  const double reached = program.value("/transport/speed_reached");
  const double ticks = program.value("/physics/sim/tick") - tick;
  EXPECT_EQ(answered, 50);

  FloodSum sum;
  const std::uint64_t asked = ask_counts(program, sum);
  const std::uint64_t received = program.count("received");
  sum.malformed = program.count("malformed");
  sum.dropped = program.count("dropped");
  sum.dropped_kernel = program.count("dropped_kernel");
  // each whole datagram was one message; the subscriptions are three more
  EXPECT_EQ(received + sum.malformed + sum.dropped_kernel, sent + 3 + asked);
  EXPECT_GT(ticks, 0);
  const double history = program.history();
  EXPECT_GT(history, 0);
  EXPECT_LT(program.resident() - history, resident + kMostGrown);
  fmt::print(
      "{:.0f} datagrams a second were sent, {:.0f} taken; dropped: {} by the kernel, {} here; {:.0f} ticks in {} s, "
      "speed {:.2f} at the end; resident {:.1f} and {:.1f} MB, {:.1f} more that keep the last seconds\n",
      static_cast<double>(flooded) / kLasts, static_cast<double>(received + sum.malformed) / (kLasts + 1),
      sum.dropped_kernel, sum.dropped, ticks, kLasts, reached, resident / 1e6, (program.resident() - history) / 1e6,
      history / 1e6);
  program.running.signal(SIGINT);
  EXPECT_EQ(program.running.finish().code, 0);
}

}  // namespace
}  // namespace limber::app_test

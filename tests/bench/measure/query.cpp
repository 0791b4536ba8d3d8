// Minimal clients over plain sockets; one thread reads for all of them.
#include "bench/measure/measures.h"

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "app/show/query_host.h"
#include "base/system/net/socket.h"
#include "base/system/wait.h"
#include "bench/measure/arms.h"
#include "bench/measure/times.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kQueryArms = 16;
constexpr int kClients = 100;
constexpr int kPaths = 50;
constexpr int kRounds = 4;
constexpr double kUpdateInterval = 1.0 / 60;

// RFC 6455: a final text frame of less than 126 bytes, with a zero mask
std::string text_frame(const std::string& text) {
  std::string frame = "\x81";
  frame += static_cast<char>(0x80 | text.size());
  return frame + std::string(4, '\0') + text;
}

// connects, upgrades to WebSocket and subscribes to all paths
system::Descriptor connect_client(std::uint16_t port, int number) {
  system::Descriptor client = system::connect_tcp({0x7f000001, port});
  if (!client.is_open()) return {};
  std::string words =
      "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  // wait for the response to the upgrade before sending frames
  if (system::send_bytes(client.fd(), words) < 0) return {};
  std::array<char, 1024> response;
  if (system::receive_bytes(client.fd(), response.data(), response.size()) <= 0) return {};
  words.clear();
  for (int i = 0; i < kPaths; i++) {
    const std::string path =
        fmt::format("/physics/body/arm{}/part/part{}/position", (number + i) % kQueryArms + 1, i % 16 + 1);
    words += text_frame(fmt::format(R"({{"COMMAND":"LISTEN","DATA":"{}"}})", path));
  }
  if (system::send_bytes(client.fd(), words) < 0) return {};
  return client;
}

class Clients {
 public:
  explicit Clients(std::uint16_t port) {
    for (int i = 0; i < kClients; i++) sockets_.push_back(connect_client(port, i));
    reader_ = std::thread([this] { read(); });
  }
  ~Clients() {
    done_ = true;
    reader_.join();
  }
  Clients(const Clients&) = delete;
  Clients& operator=(const Clients&) = delete;
  std::uint64_t bytes() const { return bytes_.load(); }

 private:
  void read() {
    std::vector<system::PollEntry> waiting;
    for (const system::Descriptor& s : sockets_) waiting.push_back({.fd = s.fd()});
    std::vector<char> buffer(1 << 16);
    while (!done_) {
      (void)system::wait_ready(waiting, std::chrono::milliseconds(20));
      for (const system::PollEntry& w : waiting) {
        if (!w.ready) continue;
        const std::ptrdiff_t n = system::receive_bytes(w.fd, buffer.data(), buffer.size());
        if (n > 0) bytes_ += static_cast<std::uint64_t>(n);
      }
    }
  }

  std::vector<system::Descriptor> sockets_;
  std::atomic<bool> done_{false};
  std::atomic<std::uint64_t> bytes_{0};
  std::thread reader_;
};

// plays in real time and samples the processor time of each tick
void play(BenchArms& arms, int ticks, TimeSamples& samples) {
  double next = system::clock_seconds();
  for (int i = 0; i < ticks; i++) {
    arms.drive(arms.time());
    const double begin = system::thread_seconds();
    arms.tick();
    samples.add(system::thread_seconds() - begin);
    next += kUpdateInterval;
    std::this_thread::sleep_for(std::chrono::duration<double>(next - system::clock_seconds()));
  }
}

}  // namespace

nlohmann::ordered_json measure_query(const MeasureOptions& options) {
  const int ticks = options.ticks > 0 ? options.ticks : 150;
  BenchArms arms(arm_scene(kQueryArms));
  osc::Network network(arms.link(), {std::vector<ListenAddress>{}, std::vector<StreamTarget>{}, {}, false},
                       engine::transient_offsets());
  oscquery::QueryServer server(arms.link(), app::query_host(network, {}));
  if (const Result<void> started = server.start({"127.0.0.1", 0}); !started) return {{"fault", started.error()}};
  TimeSamples alone, listened;
  double seconds = 0;
  std::uint64_t bytes = 0;
  play(arms, 20, alone);
  alone = {};
  for (int round = 0; round < kRounds; round++) {
    play(arms, ticks, alone);
    const Clients clients(server.port());
    TimeSamples first;
    play(arms, 20, first);  // initial values for each subscription
    const std::uint64_t before = clients.bytes();
    const double begin = system::clock_seconds();
    play(arms, ticks, listened);
    seconds += system::clock_seconds() - begin;
    bytes += clients.bytes() - before;
  }
  server.stop();
  // size of a frame: header of 2 bytes, address padded to a multiple of 4, type tags, three numbers
  constexpr double kFrame = 2 + 44 + 8 + 12;
  return {{"clients", kClients},
          {"paths_each", kPaths},
          {"values_per_second", rounded(static_cast<double>(bytes) / kFrame / seconds, -2)},
          {"tick_alone_us", alone.microseconds()},
          {"tick_listened_us", listened.microseconds()},
          {"ratio_of_medians", rounded(listened.quantile(0.5) / alone.quantile(0.5), 3)}};
}

}  // namespace limber

// Runs an engine with arms, the program's receiver and streams, and a minimal client.
#include "bench/measure/measures.h"

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "base/random.h"
#include "base/system/net/udp_socket.h"
#include "base/system/wait.h"
#include "bench/measure/arms.h"
#include "bench/measure/times.h"
#include "engine/output/snapshot.h"
#include "net/osc/network.h"
#include "net/osc/packets/encode.h"
#include "net/osc/receiver.h"
#include "net/osc/stream_frame.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;
using Packet = std::vector<char>;

constexpr int kArms = 16;
constexpr int kBurst = 10000;
constexpr int kBundled = 20;  // messages per bundle

Packet packet_of(const Message& message) {
  static osc::PacketBuffer buffer;
  const std::span<const char> bytes = osc::encode_message(message, buffer);
  return {bytes.begin(), bytes.end()};
}

// the i-th message of a stream of servo targets that addresses all joints in turn
Packet target_packet(int i) {
  const std::string arm = fmt::format("arm{}", i % kArms + 1);
  const std::string joint = fmt::format("joint{}", i / kArms % 17 + 1);
  return packet_of({"/physics/motor/angularservoposition", {Arg::of(arm), Arg::of(joint), Arg::of(0.001 * (i % 300))}});
}

Packet bundle_of(const std::vector<Packet>& messages) {
  Packet bundle = {'#', 'b', 'u', 'n', 'd', 'l', 'e', 0, 0, 0, 0, 0, 0, 0, 0, 1};
  for (const Packet& message : messages) {
    const auto size = static_cast<std::uint32_t>(message.size());
    for (int shift = 24; shift >= 0; shift -= 8) bundle.push_back(static_cast<char>(size >> shift & 0xff));
    bundle.insert(bundle.end(), message.begin(), message.end());
  }
  return bundle;
}

// pauses the simulation, so that a tick consists of commands and the snapshot only
void pause(BenchArms& arms) {
  arms.link().command_queue.push({{{"/transport/pause", {}}}, {}});
  arms.tick();
}

// messages per second of the best round: receiver, then the engine's part
double messages_per_second(BenchArms& arms, const std::vector<Packet>& packets, int messages) {
  const osc::NetClock clock;
  osc::Receiver receiver(arms.link(), {}, {}, clock);
  double best = 0;
  for (int round = 0; round < 12; round++) {
    const double start = system::clock_seconds();
    for (const Packet& packet : packets) receiver.process(packet.data(), packet.size(), {0x7f000001, 9});
    double seconds = system::clock_seconds() - start;
    // a tick processes a limited number of messages
    for (int work = 0; work < 2 * messages; work += engine::Engine::kPassWork) {
      arms.tick();
      seconds += arms.engine().times().commands;
    }
    best = std::max(best, messages / seconds);
  }
  return rounded(best, 0);
}

// a UDP client on this machine
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(std::move(*system::open_udp({0x7f000001, 0}))), to_{0x7f000001, port} {}

  void send(const Packet& packet) { (void)system::send_datagram(socket_.fd(), to_, packet); }
  // true if a datagram arrived within a second
  bool receive() {
    system::PollEntry waiting{.fd = socket_.fd()};
    std::array<char, 2048> bytes;
    return system::wait_ready({&waiting, 1}, std::chrono::seconds(1)) &&
           system::receive_bytes(socket_.fd(), bytes.data(), bytes.size()) > 0;
  }

 private:
  system::UdpSocket socket_;
  system::Endpoint to_;
};

osc::OscOptions loopback_only() {
  osc::OscOptions options;
  options.in = std::vector<ListenAddress>{{"127.0.0.1", 0}};
  options.out.emplace();
  return options;
}

Json burst(BenchArms& arms, osc::Network& network, const std::vector<Packet>& packets) {
  engine::Counters& counters = arms.link().counters;
  const auto arrived = [&] { return counters.received.load(); };
  const std::uint64_t before = arrived();
  Client client(network.bound().front().port);
  const double start = system::clock_seconds();
  std::thread sender([&] {
    for (const Packet& packet : packets) client.send(packet);
  });
  // until all have arrived or none has for 0.5 s
  double last = start;
  for (std::uint64_t seen = before; seen < before + packets.size() && system::clock_seconds() - last < 0.5;) {
    arms.tick();
    if (arrived() == seen) continue;
    seen = arrived();
    last = system::clock_seconds();
  }
  sender.join();
  arms.tick();
  const auto received = static_cast<double>(arrived() - before);
  return {
      {"sent", packets.size()}, {"arrived", received}, {"messages_per_second", rounded(received / (last - start), 0)}};
}

}  // namespace

nlohmann::ordered_json measure_osc_in(const MeasureOptions&) {
  BenchArms arms(arm_scene(kArms));
  pause(arms);
  std::vector<Packet> single, bundles;
  for (int i = 0; i < kBurst; i++) single.push_back(target_packet(i));
  for (int i = 0; i < kBurst; i += kBundled) {
    bundles.push_back(bundle_of({single.begin() + i, single.begin() + i + kBundled}));
  }
  Json figures = {{"messages_per_second", messages_per_second(arms, single, kBurst)},
                  {"messages_per_second_in_bundles", messages_per_second(arms, bundles, kBurst)}};
  osc::Network network(arms.link(), loopback_only(), engine::transient_offsets());
  if (const Result<void> started = network.start(); !started) return {{"fault", started.error()}};
  figures["burst_on_loopback"] = burst(arms, network, single);
  network.stop();
  figures["refused"] = arms.link().counters.refused.load() + arms.link().counters.unknown.load();
  return figures;
}

nlohmann::ordered_json measure_osc_latency(const MeasureOptions&) {
  constexpr int kPings = 2000;
  constexpr int kQuestions = 120;
  BenchArms arms(arm_scene(kArms));
  osc::Network network(arms.link(), loopback_only(), engine::transient_offsets());
  if (const Result<void> started = network.start(); !started) return {{"fault", started.error()}};
  Client client(network.bound().front().port);
  int lost = 0;
  TimeSamples pings, values;
  const auto ask = [&](const Packet& packet, TimeSamples& times) {
    const double start = system::clock_seconds();
    client.send(packet);
    if (client.receive()) {
      times.add(system::clock_seconds() - start);
    } else {
      lost++;
    }
  };
  const Packet ping = packet_of({"/ping", {}});
  for (int i = 0; i < kPings; i++) ask(ping, pings);

  std::thread simulation([&] { arms.engine().run(); });
  Random random(1);
  const Packet get = packet_of({"/get", {Arg::of("/physics/body/arm1/motor/joint1/target")}});
  for (int i = 0; i < kQuestions; i++) {
    // at a random time of the tick
    std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform() / 60));
    client.send(target_packet(0));
    ask(get, values);
  }
  arms.engine().stop();
  simulation.join();
  network.stop();
  Json figures = {{"lost", lost}};
  if (!pings.empty()) figures["ping_us"] = pings.microseconds();
  if (!values.empty()) figures["value_and_answer_us"] = values.microseconds();
  figures["tick_us"] = rounded(1e6 / 60, 1);
  return figures;
}

nlohmann::ordered_json measure_osc_out(const MeasureOptions&) {
  constexpr int kFrames = 200;
  ArmScene scene = arm_scene(1000);
  scene.parts = 6;
  BenchArms arms(scene);
  arms.tick();
  system::UdpSender out;
  const Result<void> opened = out.open();
  const Result<system::UdpSocket> in = system::open_udp({0x7f000001, 0});
  if (!opened || !in) return {{"fault", opened ? in.error() : opened.error()}};

  // a reader, so that the kernel delivers the datagrams
  std::atomic<bool> done{false};
  std::thread reader([&] {
    std::vector<char> bytes(65536);
    while (!done) {
      system::PollEntry waiting{.fd = in->fd()};
      if (!system::wait_ready({&waiting, 1}, std::chrono::milliseconds(20))) continue;
      while (system::receive_bytes(in->fd(), bytes.data(), bytes.size()) > 0) continue;
    }
  });
  StreamTarget target;
  osc::StreamFrame frame(engine::transient_offsets());
  const std::shared_ptr<const engine::Snapshot> snapshot = arms.link().snapshots.read();
  TimeSamples fill, send;
  bool segmentation = true;
  for (int i = 0; i < kFrames; i++) {
    const double start = system::thread_seconds();
    frame.lay_out(snapshot->body_list, target);
    frame.fill(*snapshot);
    const double filled = system::thread_seconds();
    (void)out.send(in->local(), frame.bytes(), frame.datagram_sizes(), segmentation);
    fill.add(filled - start);
    send.add(system::thread_seconds() - filled);
  }
  done = true;
  reader.join();
  return {{"bodies", scene.arms},
          {"joints", scene.arms * scene.parts},
          {"datagrams", frame.datagram_sizes().size()},
          {"bytes", frame.bytes().size()},
          {"fill_us", fill.microseconds()},
          {"send_us", send.microseconds()},
          {"percent_of_a_tick_at_60_hz", rounded(100 * 60 * (fill.quantile(0.5) + send.quantile(0.5)), 2)}};
}

}  // namespace limber

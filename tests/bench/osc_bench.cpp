// Speed of OSC: the cost of an incoming datagram, and of an outgoing frame of a thousand bodies.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <string>
#include <thread>

#include "base/log/log.h"
#include "base/system/net/udp_socket.h"
#include "net/osc/network.h"
#include "net/osc/packets/decode.h"
#include "net/osc/packets/validate.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber {
namespace {

using namespace osc::test;

std::string mass_message() {
  return Bytes().text("/physics/part/mass").text(",ssf").text("quadruped").text("foot_1").f(0.25f).str();
}

engine::Snapshot thousand_arms() {
  std::vector<FakeBody> bodies(1000);
  for (std::size_t i = 0; i < bodies.size(); i++) bodies[i] = {"arm" + std::to_string(i), 17};
  return test_world(bodies);
}

void osc_validate(benchmark::State& state) {
  const std::string bytes = mass_message();
  for (auto _ : state) benchmark::DoNotOptimize(osc::packet_fault(bytes.data(), bytes.size()));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(osc_validate);

void osc_decode(benchmark::State& state) {
  const std::string bytes = mass_message();
  for (auto _ : state) benchmark::DoNotOptimize(osc::decode_packet(bytes.data(), bytes.size()));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(osc_decode);

// from the datagram to the engine's queue, without a socket; drained after every thousand
void osc_receive(benchmark::State& state) {
  auto engine = std::make_unique<FakeEngine>();
  const osc::NetClock clock;
  osc::Receiver receiver(engine->link, {}, {}, clock);
  const std::string bytes = mass_message();
  std::vector<engine::Command> commands;
  int count = 0;
  for (auto _ : state) {
    receiver.process(bytes.data(), bytes.size(), {0x7f000001, 5000});
    if (++count % 1000 == 0) engine->link.command_queue.drain(commands);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(osc_receive);

// sends range(0) messages at full speed, range(1) per datagram, and waits for the last; counts messages per second and
// the fraction lost
void osc_burst(benchmark::State& state) {
  auto engine = std::make_unique<FakeEngine>();
  const Client client;
  osc::OscOptions options;
  options.in = *osc::parse_osc_in("0");
  options.out = *osc::parse_osc_out("off");
  osc::Network network(engine->link, options, kTestOffsets);
  if (!network.start()) return state.SkipWithError("no port");
  const system::Endpoint to = network.bound().at(0);
  const auto count = static_cast<std::uint64_t>(state.range(0));
  const auto per = static_cast<std::size_t>(state.range(1));
  const std::string bytes = per == 1 ? mass_message() : bundle(1, std::vector<std::string>(per, mass_message()));
  const std::string ping = Bytes().text("/ping").str();
  std::vector<engine::Command> commands;
  const std::uint64_t before = engine->link.counters.received;
  for (auto _ : state) {
    for (std::uint64_t i = 0; i < count; i += per) {
      client.send(to, bytes);
      if (i % 50000 == 0) engine->link.command_queue.drain(commands);
    }
    // the ping follows all others; it may be lost too
    do client.send(to, ping);
    while (!client.receive(100));
    state.PauseTiming();
    while (client.receive(0)) continue;
    engine->link.command_queue.drain(commands);
    state.ResumeTiming();
  }
  const auto sent = static_cast<std::uint64_t>(state.iterations()) * count;
  const std::uint64_t pings = static_cast<std::uint64_t>(state.iterations());
  const std::uint64_t got = engine->link.counters.received - before;
  state.SetItemsProcessed(static_cast<std::int64_t>(sent));
  state.counters["lost_%"] =
      got >= sent + pings ? 0 : 100.0 * static_cast<double>(sent + pings - got) / static_cast<double>(sent);
}
BENCHMARK(osc_burst)
    ->Args({2000, 1})
    ->Args({10000, 1})
    ->Args({200000, 1})
    ->Args({200000, 10})
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// writes the numbers of a frame of 1000 bodies with 17 joints
void osc_frame_fill(benchmark::State& state) {
  const engine::Snapshot s = thousand_arms();
  osc::StreamFrame frame(kTestOffsets);
  frame.lay_out(s.body_list, {});
  for (auto _ : state) {
    frame.fill(s);
    benchmark::DoNotOptimize(frame.bytes().data());
  }
  state.counters["bytes"] = static_cast<double>(frame.bytes().size());
  state.counters["datagrams"] = static_cast<double>(frame.datagram_sizes().size());
}
BENCHMARK(osc_frame_fill)->Unit(benchmark::kMicrosecond);

// a new layout, as after a body was added or removed
void osc_frame_lay_out(benchmark::State& state) {
  const engine::Snapshot a = thousand_arms();
  const engine::Snapshot b = thousand_arms();
  osc::StreamFrame frame(kTestOffsets);
  for (auto _ : state) {
    frame.lay_out(a.body_list, {});
    frame.lay_out(b.body_list, {});
  }
}
BENCHMARK(osc_frame_lay_out)->Unit(benchmark::kMicrosecond);

// sends a whole frame over loopback, with a client that reads on its own thread (range(2) = 1) or without a receiver
// (0); range(0): bundle size in bytes, range(1): whether the kernel may segment
void osc_frame_send(benchmark::State& state) {
  const engine::Snapshot s = thousand_arms();
  StreamTarget target;
  target.bundle = static_cast<int>(state.range(0));
  osc::StreamFrame frame(kTestOffsets);
  frame.lay_out(s.body_list, target);
  system::UdpSender sender;
  if (!sender.open()) return state.SkipWithError("no socket");
  const Client client;
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> got{0};
  std::thread reader;
  if (state.range(2) == 1) {
    reader = std::thread([&] {
      while (!stop) got += client.receive(50).has_value() ? 1 : 0;
    });
  }
  const system::Endpoint to = state.range(2) == 1 ? client.end() : system::Endpoint{0x7f000001, 9};
  std::uint64_t sent = 0;
  for (auto _ : state) {
    bool segmentation = state.range(1) != 0;
    frame.fill(s);
    sent += sender.send(to, frame.bytes(), frame.datagram_sizes(), segmentation).sent;
    if (state.range(2) == 1) {
      state.PauseTiming();
      const timespec pause{0, 4'000'000};
      nanosleep(&pause, nullptr);
      state.ResumeTiming();
    }
  }
  stop = true;
  if (reader.joinable()) reader.join();
  state.counters["datagrams"] = static_cast<double>(frame.datagram_sizes().size());
  if (state.range(2) == 1) state.counters["read_%"] = 100.0 * static_cast<double>(got) / static_cast<double>(sent);
}
BENCHMARK(osc_frame_send)
    ->ArgNames({"bundle", "gso", "reader"})
    ->Args({1472, 1, 1})
    ->Args({1472, 0, 1})
    ->Args({1472, 1, 0})
    ->Args({1472, 0, 0})
    ->Args({0, 1, 1})
    ->Args({0, 0, 1})
    ->Args({8192, 1, 1})
    ->Args({65504, 1, 1})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace limber

// Fuzzes OSC datagrams in a live world: validator, codec, receiver, queue, dispatch, Lua handlers, physics. The world
// persists across inputs, so a fault may depend on earlier inputs: reproduce it with the same -seed and -runs.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/commands/urgent.h"
#include "engine/engine.h"
#include "engine/everything.h"
#include "fuzz/target.h"
#include "net/osc/packets/decode.h"
#include "net/osc/packets/encode.h"
#include "net/osc/packets/validate.h"
#include "net/osc/receiver.h"
#include "net/osc/subscribers.h"
#include "osc/same_decoded.h"
#include "support/world_objects.h"
#if LIMBER_OSCPACK
#include "osc/oscpack_reference.h"
#endif

namespace {

using namespace limber;

// handlers in addition to those of the tests' scene
constexpr std::string_view kHandlers = R"(
osc:on("/fuzz/*", function(...) osc:send("/heard", select("#", ...)) end)
osc:on("//mass", function() osc:reply("/heaviest", 1) end)
)";
constexpr system::Endpoint kFrom{0x7f000001, 5000};
constexpr std::uint64_t kPlayEvery = 16;   // inputs between two ticks of the engine
constexpr std::uint64_t kStepEvery = 128;  // inputs between two steps of physics
constexpr int kUrgentKinds = static_cast<int>(engine::UrgentKind::take_stop) + 1;
constexpr std::uint64_t kRenewEvery = 16384;  // inputs per world

std::uint32_t u32_at(const char* data) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; i++) value = value << 8 | static_cast<unsigned char>(data[i]);
  return value;
}

// number of messages in a valid packet, counted independently of the tested code
std::uint64_t messages_in(const char* data, std::size_t size) {
  if (size < 8 || std::memcmp(data, "#bundle", 8) != 0) return 1;
  std::uint64_t count = 0;
  for (std::size_t at = 16; at < size;) {
    const std::size_t length = u32_at(data + at);
    count += messages_in(data + at + 4, length);
    at += 4 + length;
  }
  return count;
}

// the scene as a file in memory
std::string scene_file() {
  static const int file = [] {
    const int made = memfd_create("scene", 0);
    for (const std::string_view text : {std::string_view(engine::test::kEverything), kHandlers}) {
      must(write(made, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    }
    return made;
  }();
  return "/proc/self/fd/" + std::to_string(file);
}

engine::EngineOptions options() {
  engine::EngineOptions options;
  options.scene = scene_file();
  options.fast = true;
  options.print = false;
  return options;
}

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// an engine with its OSC front end, used for thousands of inputs
class OscFixture {
 public:
  OscFixture() {
    must(engine_.start().ok());
    bodies_ = engine_.world().bodies().size();
    drain_output();
  }

  // processes one input; every kPlayEvery inputs, runs a tick and checks that a valid message still takes effect
  void input(std::string_view bytes) {
    process_and_check(bytes.data(), bytes.size());
    inputs_++;
    if (inputs_ % kPlayEvery == 0) play();
  }

  bool needs_renewal() {
    const bool missing = engine_.world().bodies().size() < bodies_;
    return inputs_ >= kRenewEvery || (missing && inputs_ % (kRenewEvery / 8) == 0);
  }

 private:
  void process_and_check(const char* data, std::size_t size) {
    const engine::Counters& counters = link_.counters;
    const std::uint64_t malformed = counters.malformed;
    const std::uint64_t received = counters.received;
    const bool valid = limber::osc::packet_fault(data, size) == nullptr;
    check_codec(data, size, valid);
    receiver_.process(data, size, kFrom);
    // the codec accepts all packets that the validator accepts; rejected packets have no effect
    must(counters.malformed - malformed == (valid ? 0u : 1u));
    must(counters.received - received == (valid ? messages_in(data, size) : 0u));
  }

  // decodes every input, and valid inputs with oscpack, too: both must agree in both directions
  void check_codec(const char* data, std::size_t size, bool valid) {
    const Result<limber::osc::Decoded> decoded = limber::osc::decode_packet(data, size);
    must(decoded.ok() == valid);
#if LIMBER_OSCPACK
    if (!valid) return;
    const Result<limber::osc::Decoded> reference = limber::osc::test::oscpack_reference::decode_packet(data, size);
    must(reference.ok() && limber::osc::test::same(*decoded, *reference));
    for (const Message& message : decoded->messages)
      must(std::ranges::equal(limber::osc::encode_message(message, buffer_), oscpack_.message(message)));
#endif
  }

  void play() {
    const bool step = inputs_ % kStepEvery == 0;
    if (step) steady_ += 11'000'000'000;  // makes all scheduled bundles due
    receiver_.process_pending();          // first, so that their messages don't follow the valid message
    const double gravity = -1 - static_cast<double>(inputs_ / kPlayEvery % 1024) / 64;  // exact as a float
    send({"/physics/sim/gravity", {Arg::of(0.0), Arg::of(0.0), Arg::of(gravity)}});
    send({"/physics/sim/paused", {Arg::of(true)}});
    if (step) {
      // valid values that make physics very slow are allowed, but would only slow the fuzzer down
      send({"/physics/sim/substeps", {Arg::of(2.0)}});
      send({"/physics/sim/solver_iterations", {Arg::of(10.0)}});
      send({"/transport/step", {}});
    }
    subscribers_.work();
    check_queued_commands();
    const std::uint64_t tick = engine_.world().tick();
    engine_.tick();

    const Store& store = engine_.store();
    must(store.values(engine_.world().id(), sim::World::table().at("gravity"))[2] == gravity);
    if (step) {
      // a reset restarts the tick count
      must(engine_.world().tick() == tick + 1 || engine_.world().tick() <= 1);
      must(all_finite(store.persistent_values()) && all_finite(store.transient_values()));
    }
    check_counters(step);
  }

  void send(const Message& message) {
    const std::span<const char> packet = limber::osc::encode_message(message, buffer_);
    process_and_check(packet.data(), packet.size());
  }

  // checks the messages queued for the engine, and queues them again
  void check_queued_commands() {
    // urgent requests are not in the queue; several are merged into one, and they discard the messages they overtake
    for (int kind = 0; kind < kUrgentKinds; kind++)
      urgent_ |= link_.command_queue.has_urgent(static_cast<engine::UrgentKind>(kind));
    link_.command_queue.drain(commands_);
    for (engine::Command& command : commands_) {
      for (const Message& message : command.messages) {
        must(!message.address.empty() && message.address[0] == '/');
        must(message.args.size() <= limber::osc::OscLimits::kMessageArguments);
        check_packet(message);
        executed_++;
      }
      must(link_.command_queue.push(std::move(command)));
    }
  }

  // checks that a message can be encoded as valid OSC
  void check_packet(const Message& message) {
    const std::span<const char> packet = limber::osc::encode_message(message, buffer_);
    must(packet.empty() || limber::osc::packet_fault(packet.data(), packet.size()) == nullptr);
  }

  void drain_output() { link_.output_queue.drain(outgoing_); }

  void check_counters(bool nothing_pending) {
    drain_output();
    for (const engine::Outgoing& out : outgoing_) {
      if (out.destination == engine::Outgoing::Destination::error) errors_++;
      check_packet(out.message);
    }
    const engine::Counters& counters = link_.counters;
    // each message is counted exactly once, and each rejection was reported to its sender
    const std::uint64_t accounted =
        executed_ + pongs_ + subscribed_ + tokens_ + rejected_by_receiver_ + counters.dropped;
    must(counters.received >= accounted + uncounted_);
    if (nothing_pending && std::exchange(urgent_, false)) uncounted_ = counters.received - accounted;
    must(!nothing_pending || counters.received == accounted + uncounted_);
    must(link_.output_queue.dropped() > 0 || counters.refused + counters.unknown == errors_);
  }

  engine::EngineLink link_;
  engine::Engine engine_{link_, options()};
  std::int64_t steady_ = 0;
  limber::osc::NetClock clock_{[this] { return steady_; }, [] { return std::uint64_t{1} << 63; }};
  limber::osc::Receiver receiver_{
      link_,
      {},
      {[this](const engine::Outgoing& out) {
         rejected_by_receiver_++;
         errors_++;
         check_packet(out.message);
       },
       [this](const CommandOrigin&) { pongs_++; },
       [this](const Message& message, const CommandOrigin& origin) {
         Result<void> done = subscribers_.handle(message, origin);
         subscribed_ += done ? 1 : 0;
         return done;
       },
       [this](const CommandOrigin& origin) { return subscribers_.is_subscriber(origin); },
       [](const system::Endpoint&, std::size_t) {}, [this](const Message&, const CommandOrigin&) { tokens_++; }},
      clock_};
  limber::osc::Subscribers subscribers_{link_, clock_, [this](const engine::Outgoing& out) {
                                          check_packet(out.message);
                                          return true;
                                        }};
  limber::osc::PacketBuffer buffer_;
#if LIMBER_OSCPACK
  limber::osc::test::oscpack_reference::Encoder oscpack_;
#endif
  std::vector<engine::Command> commands_;
  std::vector<engine::Outgoing> outgoing_;
  std::size_t bodies_ = 0;
  std::uint64_t inputs_ = 0;
  std::uint64_t executed_ = 0;
  std::uint64_t uncounted_ = 0;  // urgent requests, and the messages they discarded
  bool urgent_ = false;          // an urgent request arrived since uncounted_ was updated
  std::uint64_t pongs_ = 0;
  std::uint64_t subscribed_ = 0;
  std::uint64_t tokens_ = 0;
  std::uint64_t rejected_by_receiver_ = 0;
  std::uint64_t errors_ = 0;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return persistent_input<OscFixture>(bytes, size);
}

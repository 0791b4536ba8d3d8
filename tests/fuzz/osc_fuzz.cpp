// Arbitrary bytes through the way of a datagram into a live world: validator, codec, receiver, inbox, dispatch, Lua
// handlers, physics. The world lives on from input to input, so a fault may need those before it: the same -seed and
// -runs find it again.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "engine/everything.h"
#include "engine/urgent.h"
#include "fuzz/target.h"
#include "osc/codec.h"
#include "osc/encode.h"
#include "osc/receiver.h"
#include "osc/same_decoded.h"
#include "osc/subscribers.h"
#include "osc/validate.h"

namespace {

using namespace limber;

// handlers, beside what the tests' scene has
constexpr std::string_view kHandlers = R"(
osc:on("/fuzz/*", function(...) osc:send("/heard", select("#", ...)) end)
osc:on("//mass", function() osc:reply("/heaviest", 1) end)
)";
constexpr Endpoint kFrom{0x7f000001, 5000};
constexpr std::uint64_t kPlayEvery = 16;   // inputs until they take effect, and a good message behind them
constexpr std::uint64_t kStepEvery = 128;  // inputs between two steps of physics
constexpr int kUrgentKinds = static_cast<int>(UrgentKind::take_stop) + 1;
constexpr std::uint64_t kRenewEvery = 16384;  // inputs that a world sees

std::uint32_t u32_at(const char* data) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; i++) value = value << 8 | static_cast<unsigned char>(data[i]);
  return value;
}

// messages of a packet that is whole, counted without the code that is tested
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

// the scene as a file that is nowhere on the disk
std::string scene_file() {
  static const int file = [] {
    const int made = memfd_create("scene", 0);
    for (const std::string_view text : {std::string_view(engine_test::kEverything), kHandlers}) {
      must(write(made, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    }
    return made;
  }();
  return "/proc/self/fd/" + std::to_string(file);
}

EngineOptions options() {
  EngineOptions options;
  options.scene = scene_file();
  options.fast = true;
  options.print = false;
  return options;
}

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// an engine and what stands before it, for some thousand inputs
class Desk {
 public:
  Desk() {
    must(engine_.start().ok());
    bodies_ = engine_.world().bodies().size();
    clear_outbox();
  }

  // one input; now and then what came takes effect, and so does a good message behind it
  void input(std::string_view bytes) {
    take(bytes.data(), bytes.size());
    inputs_++;
    if (inputs_ % kPlayEvery == 0) play();
  }

  bool worn() {
    const bool missing = engine_.world().bodies().size() < bodies_;
    return inputs_ >= kRenewEvery || (missing && inputs_ % (kRenewEvery / 8) == 0);
  }

 private:
  void take(const char* data, std::size_t size) {
    const Counters& counters = link_.counters;
    const std::uint64_t malformed = counters.malformed;
    const std::uint64_t received = counters.received;
    const bool whole = packet_fault(data, size) == nullptr;
    check_codecs(data, size, whole);
    receiver_.take(data, size, kFrom);
    // the codec takes whatever the validator has passed, and nothing comes of what it has not
    must(counters.malformed - malformed == (whole ? 0u : 1u));
    must(counters.received - received == (whole ? messages_in(data, size) : 0u));
  }

  // our own codec on every input; oscpack's, where it is correct, on valid ones: both find and write the same
  void check_codecs(const char* data, std::size_t size, bool whole) {
    const Result<Decoded> own = own_codec::decode(data, size);
    must(own.ok() == whole);
#if LIMBER_OSCPACK
    if (!whole) return;
    const Result<Decoded> oscpack = oscpack_codec::decode(data, size);
    must(oscpack.ok() && osc_test::same(*own, *oscpack));
    for (const Message& message : own->messages) {
      const std::span<const char> ours = own_codec::encode(message, buffer_);
      const std::span<const char> theirs = oscpack_codec::encode(message, oscpack_buffer_);
      must(std::ranges::equal(ours, theirs));
    }
#endif
  }

  void play() {
    const bool step = inputs_ % kStepEvery == 0;
    if (step) steady_ += 11'000'000'000;  // bundles that wait for their time are due
    receiver_.release_due();              // first: what they hold must not come behind the good message
    const double gravity = -1 - static_cast<double>(inputs_ / kPlayEvery % 1024) / 64;  // exact as a float
    say({"/physics/sim/gravity", {Arg::of(0.0), Arg::of(0.0), Arg::of(gravity)}});
    say({"/physics/sim/paused", {Arg::of(true)}});
    if (step) {
      // values that a machine can't keep up with are the performer's right, and none of the fuzzer's business
      say({"/physics/sim/substeps", {Arg::of(2.0)}});
      say({"/physics/sim/solver_iterations", {Arg::of(10.0)}});
      say({"/transport/step", {}});
    }
    subscribers_.work();
    count_waiting();
    const std::uint64_t tick = engine_.world().tick();
    engine_.tick();

    const Store& store = engine_.store();
    must(store.values(engine_.world().id(), World::table().at("gravity"))[2] == gravity);
    if (step) {
      // a reset begins time anew
      must(engine_.world().tick() == tick + 1 || engine_.world().tick() <= 1);
      must(all_finite(store.kept()) && all_finite(store.live()));
    }
    check_counters(step);
  }

  void say(const Message& message) {
    const std::span<const char> packet = encode_message(message, buffer_);
    take(packet.data(), packet.size());
  }

  // looks at what waits for the engine, and puts it back
  void count_waiting() {
    // urgent requests don't wait with the others; several are one, and discard what they overtake
    for (int kind = 0; kind < kUrgentKinds; kind++) urgent_ |= link_.inbox.waits(static_cast<UrgentKind>(kind));
    link_.inbox.drain(commands_);
    for (Command& command : commands_) {
      for (const Message& message : command.messages) {
        must(!message.address.empty() && message.address[0] == '/');
        must(message.args.size() <= OscLimits::kMessageArguments);
        check_packet(message);
        executed_++;
      }
      must(link_.inbox.push(std::move(command)));
    }
  }

  // what came in can be sent on, and what goes out is OSC
  void check_packet(const Message& message) {
    const std::span<const char> packet = encode_message(message, buffer_);
    must(packet.empty() || packet_fault(packet.data(), packet.size()) == nullptr);
  }

  void clear_outbox() { link_.outbox.drain(outgoing_); }

  void check_counters(bool nothing_is_held) {
    clear_outbox();
    for (const Outgoing& out : outgoing_) {
      if (out.to == Outgoing::To::error) errors_++;
      check_packet(out.message);
    }
    const Counters& counters = link_.counters;
    // every message came to one end, and each refusal was told to its sender
    const std::uint64_t ended = executed_ + pongs_ + subscribed_ + tokens_ + refused_here_ + counters.dropped;
    must(counters.received >= ended + uncounted_);
    if (nothing_is_held && std::exchange(urgent_, false)) uncounted_ = counters.received - ended;
    must(!nothing_is_held || counters.received == ended + uncounted_);
    must(link_.outbox.dropped() > 0 || counters.refused + counters.unknown == errors_);
  }

  EngineLink link_;
  Engine engine_{link_, options()};
  std::int64_t steady_ = 0;
  NetClock clock_{[this] { return steady_; }, [] { return std::uint64_t{1} << 63; }};
  Receiver receiver_{link_,
                     {},
                     {[this](const Outgoing& out) {
                        refused_here_++;
                        errors_++;
                        check_packet(out.message);
                      },
                      [this](const Origin&) { pongs_++; },
                      [this](const Message& message, const Origin& origin) {
                        Result<void> done = subscribers_.take(message, origin);
                        subscribed_ += done ? 1 : 0;
                        return done;
                      },
                      [this](const Origin& origin) { return subscribers_.follows(origin); },
                      [](const Endpoint&, std::size_t) {}, [this](const Message&, const Origin&) { tokens_++; }},
                     clock_};
  Subscribers subscribers_{link_, clock_, [this](const Outgoing& out) {
                             check_packet(out.message);
                             return true;
                           }};
  PacketBuffer buffer_;
  [[maybe_unused]] PacketBuffer oscpack_buffer_;
  std::vector<Command> commands_;
  std::vector<Outgoing> outgoing_;
  std::size_t bodies_ = 0;
  std::uint64_t inputs_ = 0;
  std::uint64_t executed_ = 0;
  std::uint64_t uncounted_ = 0;  // urgent requests, and what they discarded
  bool urgent_ = false;          // one came since it was counted
  std::uint64_t pongs_ = 0;
  std::uint64_t subscribed_ = 0;
  std::uint64_t tokens_ = 0;
  std::uint64_t refused_here_ = 0;
  std::uint64_t errors_ = 0;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return live_input<Desk>(bytes, size);
}

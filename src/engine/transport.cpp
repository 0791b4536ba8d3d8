// The rows of /transport and /osc.
#include "engine/transport.h"

#include <algorithm>
#include <array>

namespace limber {

namespace {

using namespace rows;

constexpr double kMostTicks = 100000;

Row counter(std::string name, std::string doc) {
  return live(readout(integer(std::move(name), 0, 0, kUnbounded, std::move(doc))));
}

}  // namespace

const Table& Transport::table() {
  static const Table table(
      "transport", "/transport", "",
      {
          act<&Transport::act_play>(action("play", 0, 0, "Time runs.")),
          act<&Transport::act_pause>(action("pause", 0, 0, "Time stands still.")),
          act<&Transport::act_step>(
              action("step", 0, 1, "So many ticks (1), then stands still; fewer than 0: so many ticks back.")),
          act<&Transport::act_rewind>(action("rewind", 1, 1, "So many seconds back, as far as history goes.")),
          act<&Transport::act_rewind_ticks>(action("rewind_ticks", 1, 1, "So many ticks back.")),
          act<&Transport::act_reset>(action("reset", 0, 0, "The scene from its start, with the performer's values.")),
          act<&Transport::act_panic>(action("panic", 0, 0, Panic::kDoc)),
          act<&Transport::act_panic_end>(action("panic_end", 0, 0, "Ends a panic, whenever it began.")),
          live(readout(number("speed_reached", "× real time", 1, 0, kUnbounded,
                              "Simulated seconds per real second, over the last half second."))),
          live(readout(number("rewindable", "s", 0, 0, kUnbounded, "How far back a rewind can go."))),
          live(readout(number("history_memory", "", 0, 0, kUnbounded, "Megabytes that this takes."))),
          live(readout(number("lost_time", "s", 0, 0, kUnbounded,
                              "Real time in which the show stood still: the program was stopped, or the machine was "
                              "suspended or busy. It is not made up."))),
          say<&Transport::say_health>(
              text("health", "What was dropped, reduced, disabled or lost, and since when; empty: all is well.")),
      });
  return table;
}

Transport::Transport(World& world, const Health& health)
    : world_(world), health_(health), id_(world.store().add(table(), world.store().root(), "transport", this)) {}

bool Transport::paused() const { return world_.store().values(world_.id(), World::table().at("paused"))[0] != 0; }

void Transport::set_paused(bool paused) {
  const double value = paused ? 1 : 0;
  (void)world_.store().set(world_.id(), World::table().at("paused"), {&value, 1});
}

bool Transport::take_step() {
  if (steps_ == 0) return false;
  steps_--;
  return true;
}

void Transport::tell(double speed_reached, double rewindable, double history_memory, double lost_time) {
  static const Row& first = table().at("speed_reached");
  double* const out = world_.store().tell(id_, first);  // the readouts stand in a row
  out[0] = speed_reached;
  out[1] = rewindable;
  out[2] = history_memory;
  out[3] = lost_time;
}

std::string_view Transport::say_health() const {
  health_text_ = health_.text();
  return health_text_;
}

Result<void> Transport::act_play(std::span<const double>) {
  steps_ = 0;
  set_paused(false);
  return {};
}

void Transport::stand_still() {
  steps_ = 0;
  set_paused(true);
}

Result<void> Transport::act_pause(std::span<const double>) {
  stand_still();
  return {};
}

Result<void> Transport::act_step(std::span<const double> args) {
  const double wanted = args.empty() ? 1 : args[0];
  if (wanted <= -1) {
    Result<void> goes = act_rewind_ticks(std::array{-wanted});
    if (goes) back_->stands = true;
    return goes;
  }
  if (!(wanted >= 1 && wanted <= kMostTicks)) return Error{"step takes 1 to 100000 ticks, or -1 to -100000 back"};
  steps_ = std::min(static_cast<int>(kMostTicks), steps_ + static_cast<int>(wanted));
  set_paused(true);
  return {};
}

Result<void> Transport::act_reset(std::span<const double>) {
  world_.ask_reset();
  return {};
}

Result<void> Transport::act_panic(std::span<const double>) {
  world_.ask_panic();
  return {};
}

Result<void> Transport::act_panic_end(std::span<const double>) {
  world_.ask_panic_end();
  return {};
}

Result<void> Transport::act_rewind(std::span<const double> args) {
  if (!(args[0] > 0)) return Error{"rewind takes the seconds to go back, more than 0"};
  back_ = Back{args[0]};
  return {};
}

Result<void> Transport::act_rewind_ticks(std::span<const double> args) {
  if (!(args[0] >= 1 && args[0] <= kMostTicks)) return Error{"so many ticks back: 1 to 100000"};
  back_ = Back{0, static_cast<std::uint64_t>(args[0])};
  return {};
}

const Table& CounterNode::table() {
  static const Table table("osc", "/osc", "",
                           {
                               counter("received", "Messages that came in whole."),
                               counter("malformed", "Datagrams that are no OSC."),
                               counter("denied", "Datagrams from senders whom --osc-allow leaves out."),
                               counter("unknown", "Messages with an address that nobody answers."),
                               counter("refused", "Messages refused for their arguments or names."),
                               counter("clamped", "Messages with values outside their range."),
                               counter("dropped", "Messages lost here: more came than a tick takes."),
                               counter("dropped_kernel", "Datagrams lost by the kernel: its buffer was full."),
                               counter("sent", "Datagrams sent."),
                               counter("unsent", "Datagrams that the system did not take, or that came back."),
                               counter("discarded",
                                       "Requests (play, step, ...) that a later panic, pause or end of a "
                                       "take overtook: they were left out."),
                               counter("unheard",
                                       "Messages that osc:on handlers missed: more waited than they are "
                                       "given time for."),
                               counter("disabled", "Handlers (osc:on) that failed: disabled until the scene is saved."),
                           });
  return table;
}

CounterNode::CounterNode(Store& store, const Counters& counters)
    : store_(store), counters_(counters), id_(store.add(table(), store.root(), "osc", this)) {}

void CounterNode::tell() {
  // in the rows' order
  const Counters& c = counters_;
  const std::atomic<std::uint64_t>* const all[] = {
      &c.received,       &c.malformed, &c.denied, &c.unknown,   &c.refused, &c.clamped, &c.dropped,
      &c.dropped_kernel, &c.sent,      &c.unsent, &c.discarded, &c.unheard, &c.disabled};
  double* out = store_.live_block(id_);
  for (const auto* count : all) *out++ = static_cast<double>(count->load(std::memory_order_relaxed));
}

}  // namespace limber

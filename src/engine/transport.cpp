// The properties and actions of /transport.
#include "engine/transport.h"

#include <algorithm>
#include <array>

namespace limber::engine {

namespace {

using namespace properties;

constexpr double kMaxTicks = 100000;

}  // namespace

const PropertyTable& Transport::table() {
  static const PropertyTable table(
      "transport", "/transport", "",
      {
          invokes<&Transport::act_play>(action("play", 0, 0, "Starts or resumes simulated time.")),
          invokes<&Transport::act_pause>(action("pause", 0, 0, "Pauses simulated time.")),
          invokes<&Transport::act_step>(
              action("step", 0, 1, "Advances by a number of ticks (default 1), then pauses; negative: rewinds.")),
          invokes<&Transport::act_rewind>(
              action("rewind", 1, 1, "Rewinds by a number of seconds, as far as the history reaches.")),
          invokes<&Transport::act_rewind_ticks>(action("rewind_ticks", 1, 1, "Rewinds by a number of ticks.")),
          invokes<&Transport::act_reset>(
              action("reset", 0, 0, "Restarts the scene and applies the performer's values again.")),
          invokes<&Transport::act_panic>(action("panic", 0, 0, sim::Panic::kDoc)),
          invokes<&Transport::act_panic_end>(action("panic_end", 0, 0, "Ends a panic.")),
          transient(readout(number("speed_reached", "× real time", 1, 0, kUnbounded,
                                   "Simulated seconds per real second, over the last half second."))),
          transient(readout(number("rewindable", "s", 0, 0, kUnbounded, "Time that can be rewound."))),
          transient(readout(number("history_memory", "", 0, 0, kUnbounded, "Megabytes used by the history."))),
          transient(
              readout(number("lost_time", "s", 0, 0, kUnbounded,
                             "Real time lost because the program was stopped, or the machine was suspended or busy. "
                             "It is not caught up."))),
          text_from<&Transport::read_health>(
              text("health", "Problems: anything dropped, reduced, disabled or lost, and since when; empty: none.")),
      });
  return table;
}

Transport::Transport(sim::World& world, const Health& health, bool lockstep)
    : world_(world),
      health_(health),
      lockstep_(lockstep),
      id_(world.store().add(table(), world.store().root(), "transport", this)) {}

bool Transport::paused() const {
  if (lockstep_) return true;
  return world_.store().values(world_.id(), sim::World::table().at("paused"))[0] != 0;
}

void Transport::set_paused(bool paused) {
  const double value = paused ? 1 : 0;
  (void)world_.store().set(world_.id(), sim::World::table().at("paused"), {&value, 1});
}

bool Transport::consume_step() {
  if (steps_ == 0) return false;
  steps_--;
  return true;
}

void Transport::publish(double speed_reached, double rewindable, double history_memory, double lost_time) {
  static const Property& first = table().at("speed_reached");
  double* const out = world_.store().mutable_values(id_, first);  // the readouts are contiguous
  out[0] = speed_reached;
  out[1] = rewindable;
  out[2] = history_memory;
  out[3] = lost_time;
}

std::string_view Transport::read_health() const {
  health_text_ = health_.text();
  return health_text_;
}

Result<void> Transport::act_play(std::span<const double>) {
  if (lockstep_) return Error{"with --lockstep, time advances only by /transport/step"};
  steps_ = 0;
  set_paused(false);
  return {};
}

void Transport::pause() {
  steps_ = 0;
  set_paused(true);
}

Result<void> Transport::act_pause(std::span<const double>) {
  pause();
  return {};
}

Result<void> Transport::act_step(std::span<const double> args) {
  const double ticks = args.empty() ? 1 : args[0];
  if (ticks <= -1) {
    Result<void> rewind = act_rewind_ticks(std::array{-ticks});
    if (rewind) rewind_->pause = true;
    return rewind;
  }
  if (!(ticks >= 1 && ticks <= kMaxTicks))
    return Error{"the number of ticks must be 1 to 100000, or -1 to -100000 to rewind"};
  steps_ = std::min(static_cast<int>(kMaxTicks), steps_ + static_cast<int>(ticks));
  set_paused(true);
  return {};
}

Result<void> Transport::act_reset(std::span<const double>) {
  world_.requests().reset = true;
  return {};
}

Result<void> Transport::act_panic(std::span<const double>) {
  world_.requests().panic = true;
  return {};
}

Result<void> Transport::act_panic_end(std::span<const double>) {
  world_.requests().end_panic();
  return {};
}

Result<void> Transport::act_rewind(std::span<const double> args) {
  if (!(args[0] > 0)) return Error{"the seconds to rewind must be more than 0"};
  rewind_ = RewindRequest{args[0]};
  return {};
}

Result<void> Transport::act_rewind_ticks(std::span<const double> args) {
  if (!(args[0] >= 1 && args[0] <= kMaxTicks)) return Error{"the number of ticks must be 1 to 100000"};
  rewind_ = RewindRequest{0, static_cast<std::uint64_t>(args[0])};
  return {};
}

}  // namespace limber::engine

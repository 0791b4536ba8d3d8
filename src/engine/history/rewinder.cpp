// Rewinder: the target of a rewind, and the passes that are simulated again.
#include "engine/history/rewinder.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "engine/history/history_input.h"

namespace limber::engine {

namespace {

// Session state and other values that survive a rewind: restores them at its end.
class UnaffectedState {
 public:
  explicit UnaffectedState(ShowState& show)
      : show_(show), steps_(show.session->transport.steps()), presets_(show.presets.list()), calls_(show.call_log) {
    listener_ = show.session->store.set_listener({});
    for (std::size_t i = 0; i < kProperties.size(); i++) values_[i] = show.session->world_value(kProperties[i]);
  }
  ~UnaffectedState() {
    Session& session = *show_.session;
    show_.presets.set_list(std::move(presets_));
    for (std::size_t i = 0; i < kProperties.size(); i++)
      (void)session.store.set(session.world.id(), kProperties[i], {&values_[i], 1});
    session.transport.set_steps(steps_);
    show_.call_log = std::move(calls_);
    show_.call_log.record_rewind();
    session.store.set_listener(listener_);
  }
  UnaffectedState(const UnaffectedState&) = delete;
  UnaffectedState& operator=(const UnaffectedState&) = delete;

 private:
  static constexpr std::array<const char*, 3> kProperties = {"paused", "speed", "history"};

  ShowState& show_;
  std::array<double, 3> values_{};
  const int steps_;
  PresetList presets_;
  script::CallLog calls_;
  Store::Listener listener_;
};

// While an object of this class exists, recorded passes are simulated again: the show has no output and saves nothing,
// and only the calls of scripts that the history lists are stopped.
class Resimulation {
 public:
  explicit Resimulation(ShowState& show) : show_(show), muted_(show.outputs) { set(true); }
  ~Resimulation() { set(false); }
  Resimulation(const Resimulation&) = delete;
  Resimulation& operator=(const Resimulation&) = delete;

 private:
  void set(bool on) {
    show_.presets.suspend_saving(on);
    if (show_.session->scene != nullptr) show_.session->scene->set_resimulating(on);
  }

  ShowState& show_;
  const Outputs::Muted muted_;
};

}  // namespace

Rewinder::Target Rewinder::target_of(const Transport::RewindRequest& request) const {
  const sim::World& world = show_.session->world;
  const History& history = show_.history;
  Target result;
  RewindTarget& target = result.target;
  if (request.ticks > 0) {
    target.tick = request.ticks < world.tick() ? world.tick() - request.ticks : 0;
  } else {
    target.time = world.time() - request.seconds;
  }
  const double half_tick = world.timestep() / 2;
  const bool too_far =
      target.time ? *target.time < history.oldest_time() - half_tick : target.tick < history.oldest_tick();
  if (too_far) result = {{history.oldest_tick(), {}}, history.limit_reason()};
  // less than half a tick: one tick
  if (target.time && *target.time > world.time() - half_tick) target = {world.tick() - 1, {}};
  return result;
}

Outcome Rewinder::rewind(const Transport::RewindRequest& request) {
  show_.pacer.excuse_stall();
  const sim::World& world = show_.session->world;
  const double time = world.time();
  if (!show_.history.validate(*show_.session) || world.tick() <= show_.history.oldest_tick())
    return Outcome::rejected(fmt::format("can't rewind: {}", show_.history.limit_reason()));
  const Target target = target_of(request);
  resimulate_until(target.target);
  if (request.pause) show_.session->transport.pause();
  Outcome outcome = Outcome::answered();
  Message& answer = outcome.answers.emplace_back(Message{"/transport/rewound", {}});
  answer.args = {Arg::of(std::round(1e6 * (time - world.time())) / 1e6), Arg::of(static_cast<double>(world.tick()))};
  if (!target.limit_reason.empty()) answer.args.push_back(Arg::of(target.limit_reason));
  show_.send_transport();
  return outcome;
}

void Rewinder::resimulate_until(const RewindTarget& target) {
  bool stopped = false;
  {
    const UnaffectedState unaffected(show_);
    show_.handler_queue.clear();
    show_.preset_requests.clear();
    show_.history.restore(*show_.session, target);
    const Resimulation resimulation(show_);
    stopped = resimulate_passes(target);
  }
  if (stopped)
    log_warning("rewind: a script exceeded its time limit in the replayed ticks; rewound further than requested");
  show_.session->dispatcher.begin_pass();
}

// Stops, and returns true, if a script call that was not stopped when it was recorded now exceeds its time limit: the
// remaining passes would differ from the recorded ones and be slow.
bool Rewinder::resimulate_passes(const RewindTarget& target) {
  bool reached = false;
  bool stopped = false;
  for (RecordedPass pass; !reached && !stopped && show_.history.next(pass);) {
    reached = pass.running && target.reached(show_.session->world);
    if (reached) continue;
    resimulate(pass);
    stopped = show_.call_log.unexpected_stops() > 0;
  }
  show_.history.truncate(reached);
  return stopped;
}

void Rewinder::resimulate(RecordedPass& pass) {
  Session& session = *show_.session;
  show_.call_log.begin_pass(std::move(pass.stopped_calls));
  session.dispatcher.begin_pass();
  HistoryInput input(show_, executor_, pass);
  input.execute_messages(pass.running);
  PhaseTimes unused_times;
  simulator_.simulate(input.advances_time(pass.running), input, unused_times);
  session.world.requests().reset = false;  // the reset failed in the original run
  session.preset_node.publish();
  session.cue_node.publish();
  if (session.scene != nullptr) session.scene->collect_garbage();
}

}  // namespace limber::engine

// Engine: rewind.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "engine/engine.h"

namespace limber {

namespace {
constexpr std::size_t kMaxReplayHistoryBytes = std::size_t{1}
                                               << 30;  // a replay must be able to rewind as far as the recorded session
}  // namespace

void Engine::end_pass(bool running) {
  if (is_replaying()) history_.set_max_bytes(kMaxReplayHistoryBytes);
  history_.end_pass(*session_, call_log_, running, session_->world_value("history"));
}

void Engine::update_transport() {
  const double rewindable = history_.empty() ? 0 : session_->world.time() - history_.oldest_time();
  session_->transport.publish(clock_.speed_reached(), rewindable, static_cast<double>(history_.bytes()) / (1u << 20u),
                              lost_time_);
}

// Rewinds. Inputs of the current tick that were executed before are discarded as well; the remaining ones are executed
// at the restored time.
Outcome Engine::rewind(const Transport::RewindRequest& request, const CommandOrigin& origin) {
  stall_excused_ = true;
  World& world = session_->world;
  const std::uint64_t tick = world.tick();
  const double time = world.time();
  if (!history_.validate(*session_) || tick <= history_.oldest_tick()) {
    return Outcome::rejected(fmt::format("can't rewind: {}", history_.limit_reason()));
  }
  RewindTarget target;
  if (request.ticks > 0) {
    target.tick = request.ticks < tick ? tick - request.ticks : 0;
  } else {
    target.time = time - request.seconds;
  }
  std::string limit_reason;
  const bool too_far =
      target.time ? *target.time < history_.oldest_time() - world.timestep() / 2 : target.tick < history_.oldest_tick();
  if (too_far) {
    target = {history_.oldest_tick(), {}};
    limit_reason = history_.limit_reason();
  }
  if (target.time && *target.time > time - world.timestep() / 2)
    target = {tick - 1, {}};  // less than half a tick: one tick
  resimulate_until(target);
  if (request.pause) session_->transport.pause();
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  Message& answer = outcome.answers.emplace_back(Message{"/transport/rewound", {}});
  answer.args = {Arg::of(std::round(1e6 * (time - world.time())) / 1e6), Arg::of(static_cast<double>(world.tick()))};
  if (!limit_reason.empty()) answer.args.push_back(Arg::of(limit_reason));
  if (recorder_ != nullptr) {
    // record the ticks that were actually rewound: the history of a replay may reach back further, or less far
    if (request.pause) recorder_->record_message({"/transport/pause", {}}, origin);
    recorder_->record_message({"/transport/rewind_ticks", {Arg::of(static_cast<double>(tick - world.tick()))}}, origin);
  }
  send_transport();
  return outcome;
}

void Engine::resimulate_until(const RewindTarget& target) {
  // session state and presets survive a rewind
  constexpr std::array<const char*, 3> kSessionProperties = {"paused", "speed", "history"};
  std::array<double, kSessionProperties.size()> session_values{};
  for (std::size_t i = 0; i < kSessionProperties.size(); i++)
    session_values[i] = session_->world_value(kSessionProperties[i]);
  const int steps = session_->transport.steps();
  PresetList presets = presets_.list();
  const CallLog calls = call_log_;
  Store& store = session_->store;
  const Store::Listener listener = store.set_listener({});
  handler_queue_.clear();
  preset_requests_.clear();
  history_.restore(*session_, target);
  set_resimulating(true);
  bool reached = false;
  bool stopped = false;  // a call exceeded its limit that did not before: the rest would diverge and be slow
  for (RecordedPass pass; !reached && !stopped && history_.next(pass);) {
    reached = pass.running && target.reached(session_->world);
    if (reached) continue;
    resimulate(pass);
    stopped = call_log_.unexpected_stops() > 0;
  }
  history_.truncate(reached);
  set_resimulating(false);
  if (stopped)
    log_warning("rewind: a script exceeded its time limit in the replayed ticks; rewound further than requested");
  replayed_handler_calls_.reset();
  presets_.set_list(std::move(presets));
  for (std::size_t i = 0; i < kSessionProperties.size(); i++)
    (void)store.set(session_->world.id(), kSessionProperties[i], {&session_values[i], 1});
  session_->transport.set_steps(steps);
  call_log_ = calls;
  call_log_.record_rewind();
  store.set_listener(listener);
  session_->dispatcher.begin_tick();
}

// Suppresses logging, sending and saving while recorded passes are replayed.
void Engine::set_resimulating(bool on) {
  resimulating_ = on;
  log_silence_.reset();
  if (on) log_silence_.emplace();
  presets_.set_replaying(on);
  if (session_->scene != nullptr) session_->scene->set_replaying(on);
}

void Engine::resimulate(RecordedPass& pass) {
  call_log_.begin_tick(std::move(pass.stopped));
  session_->dispatcher.begin_tick();
  {
    EditScope edit_scope(session_->world, presets_, undo_stack_, muted_recorder_);
    replayed_handler_calls_.reset();
    for (TakeMessage& input : pass.messages) {
      if (!input.evaluate && execute_event(input.message)) continue;
      edit_scope.begin(input.origin);
      if (!input.evaluate) {
        execute(input.message, input.origin);
      } else if (session_->scene != nullptr) {
        (void)evaluate_text(input.message.address);
      }
    }
  }
  simulate(pass.running);
  (void)session_->world.consume_reset_request();  // the reset failed in the original run
  session_->preset_node.publish();
  if (session_->scene != nullptr) session_->scene->collect_garbage();
}

bool Engine::restore_before(std::uint64_t tick) {
  const PresetList presets = presets_.list();
  if (!history_.validate(*session_) || !history_.restore_before(*session_, tick)) return false;
  presets_.set_list(presets);
  handler_queue_.clear();
  preset_requests_.clear();
  call_log_.record_rewind();
  rewound_ = true;
  return true;
}

}  // namespace limber

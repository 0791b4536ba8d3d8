// Engine: start and end of a replay, of --replay and of a take that is played inside a running session.
#include <utility>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {

// Script limits of a replay. The take lists the calls that were stopped, so another call exceeds these limits only if
// the replay differs from the recording. They are lower in a running session, which must not hang for long.
ScriptLimits replay_limits(bool in_show) {
  ScriptLimits limits;
  limits.call_ms *= in_show ? 10 : 100;
  limits.replay_ms *= in_show ? 1 : 10;
  limits.run_ms *= 10;
  limits.memory *= 16;
  return limits;
}

}  // namespace

// Options for runs of the scene in the current state of the engine.
SceneOptions Engine::scene_options() const {
  SceneOptions options = options_.scene_options;
  if (is_replaying() && !player_->current_scripts()) options.limits = replay_limits(plays_in_show_);
  if (is_replaying()) options.keep_timers = player_->keeps_timers();
  if (!has_current_rules()) options.limits.disable_failed_handlers = false;
  return options;
}

Result<void> Engine::start_replay() {
  auto player = TakePlayer::open(options_.replay, options_.current_scripts);
  if (!player) return Error{player.error()};
  (*player)->next();
  return begin_replay(std::move(*player), options_.replay);
}

// Starts the replay in an empty session, with the first tick of the take.
Result<void> Engine::begin_replay(std::unique_ptr<TakePlayer> player, const std::string& file) {
  player_ = std::move(player);
  take_name_ = title_of_take(file);
  const TakeInitialState& initial_state = player_->initial_state();
  options_.scene = initial_state.scene;
  options_.scene_options.seed = initial_state.seed;
  options_.scene_options.package_paths = initial_state.package_paths;
  options_.preset = initial_state.preset;
  options_.sets = initial_state.sets;
  recovered_ = initial_state.recovered.empty() ? nullptr : initial_state.recovered.front();
  call_log_.begin_tick(player_->stopped_calls());
  Result<void> started = start_from_take();
  if (!started) return started;
  finish_take_tick(false);
  publish();
  if (initial_state.reset) end_pass(false);  // a rewind can return to this state, as it could in the recorded session
  return started;
}

// Prepares the next tick of the take. False at its end.
bool Engine::next_replay_tick(bool& may_step) {
  if (!player_->next()) return false;
  may_step = player_->tick().running;
  call_log_.begin_tick(player_->stopped_calls());
  replay_runs();
  return true;
}

Result<void> Engine::play_take(const std::string& file, std::optional<std::uint64_t> stops) {
  const std::uint64_t stops_when_requested = stops.value_or(take_stop_count(link_));
  auto player = TakePlayer::open(file, false);
  if (!player) return Error{player.error()};
  (*player)->next();
  if (Result<void> runs = check_take(**player); !runs) return runs;
  Presets::Bank bank = read_presets((*player)->initial_state().scene);
  std::unique_ptr<Session> previous;  // destroyed on this thread, so that the simulation doesn't wait for it
  Result<void> started;
  const Result<void> done = run_between_ticks([&] {
    if (recorder_ != nullptr || requested_take_) {
      started = Error{"a take is being recorded; /take/stop ends it"};
    } else if (take_stop_count(link_) != stops_when_requested) {
      link_.counters.discarded.fetch_add(1, std::memory_order_relaxed);
      started = Error{"discarded: a panic or /take/stop was requested before it could start"};
    } else {
      previous = begin_play(std::move(*player), file, bank);
    }
  });
  return done ? started : done;
}

// Runs the take's scene detached: the running session isn't replaced if the scene fails.
Result<void> Engine::check_take(TakePlayer& player) {
  const std::vector<TakeSceneRun>& runs = player.tick().runs;
  if (runs.empty() || !runs.front().succeeded) return Error{"its scene failed when it was recorded, too"};
  SceneOptions options = options_.scene_options;
  options.package_paths = player.initial_state().package_paths;
  options.limits = replay_limits(true);
  options.sources = player.sources(runs.front());
  Session session(link_, presets_, undo_stack_, {});  // never steps
  return session.run_detached(player.initial_state().scene, *this, options);
}

// Replaces the session by the replay and returns the previous one. `bank`: presets of the take's scene from the disk,
// which are used after the replay; on return the presets that were open, if they belong to another scene.
std::unique_ptr<Session> Engine::begin_play(std::unique_ptr<TakePlayer> player, const std::string& file,
                                            Presets::Bank& bank) {
  reject_commands();
  plays_in_show_ = true;
  overrides_.clear();
  undo_stack_.clear();
  presets_after_play_ = presets_.exchange({});
  if (presets_after_play_.file != bank.file) std::swap(presets_after_play_, bank);
  if (session_->scene != nullptr) session_->scene->disarm();
  std::unique_ptr<Session> previous = swap_session(new_session());
  if (const Result<void> started = begin_replay(std::move(player), file); !started) {
    faults_++;
    log_error("{}: {}", printable(file), started.error());
    end_play();
    return previous;
  }
  log_info("playing the take {}; /take/stop ends it", printable(take_name_));
  send_transport();
  return previous;
}

void Engine::end_play() {
  const ReplayResult result = player_->result();
  player_ = nullptr;
  plays_in_show_ = false;
  reload_request_.reset();
  presets_.exchange(std::exchange(presets_after_play_, {}));
  const ScriptLimits& limits = options_.scene_options.limits;
  if (session_->scene != nullptr) session_->scene->set_limits(limits);
  reloader_.set_limits(limits);
  history_.clear("a take was played before");
  log_info("{}: {}; live input resumed", printable(take_name_), text_of(result));
  const double diverged_at = result.diverged_at ? static_cast<double>(*result.diverged_at) : -1;
  push_out({Outgoing::Destination::event,
            {},
            {"/take/played", {Arg::of(take_name_), Arg::of(static_cast<double>(result.ticks)), Arg::of(diverged_at)}}});
  send_transport();
}

}  // namespace limber

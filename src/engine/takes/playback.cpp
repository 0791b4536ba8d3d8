// TakePlayback: start and end of a replay, and its runs of the scene.
#include "engine/takes/playback.h"

#include <utility>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/reload/reload_candidate.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxReplayHistoryBytes = std::size_t{1}
                                               << 30;  // a replay must be able to rewind as far as the recorded session

// Script limits of a replay. The take lists the calls that were stopped, so another call exceeds these limits only if
// the replay differs from the recording. They are lower in a running session, which must not hang for long.
script::ScriptLimits replay_limits(bool in_show) {
  script::ScriptLimits limits;
  limits.call_ms *= in_show ? 10 : 100;
  limits.replay_ms *= in_show ? 1 : 10;
  limits.run_ms *= 10;
  limits.memory *= 16;
  return limits;
}

ShowRules rules_of(const TakePlayer& player, bool in_show) {
  ShowRules rules;
  rules.before_first_revision = player.rules() < 1;
  rules.before_second_revision = player.rules() < 2;
  rules.keeps_timers = player.keeps_timers();
  rules.frames_scenes = player.frames_scenes();
  if (!player.current_scripts()) rules.limits = replay_limits(in_show);
  return rules;
}

}  // namespace

TakePlayback::TakePlayback(ShowState& show, CommandExecutor& executor, Rewinder& rewinder, LiveInput& live,
                           SceneRunner& scenes, TakeRecording& recording, RecoveryControl& recovery)
    : show_(show),
      executor_(executor),
      rewinder_(rewinder),
      live_(live),
      scenes_(scenes),
      recording_(recording),
      recovery_(recovery) {}

Result<void> TakePlayback::start() {
  const std::string file = show_.options.replay;
  auto player = TakePlayer::open(file, show_.options.current_scripts);
  if (!player) return Error{player.error()};
  (*player)->next();
  return begin(std::move(*player), file, false);
}

// Starts the replay in an empty session, with the first tick of the take.
Result<void> TakePlayback::begin(std::unique_ptr<TakePlayer> player, const std::string& file, bool in_show) {
  input_ = std::make_unique<TakeInput>(show_, executor_, rewinder_, live_, std::move(player), in_show);
  show_.input = input_.get();
  show_.set_rules(rules_of(input_->player(), in_show));
  show_.history.set_max_bytes(kMaxReplayHistoryBytes);
  name_ = title_of_take(file);
  const TakeInitialState& initial_state = input_->player().initial_state();
  EngineOptions& options = show_.options;
  options.scene = initial_state.scene;
  options.scene_options.seed = initial_state.seed;
  options.scene_options.package_paths = initial_state.package_paths;
  options.preset = initial_state.preset;
  options.sets = initial_state.sets;
  show_.recovered = initial_state.recovered.empty() ? nullptr : initial_state.recovered.front();
  show_.call_log.begin_pass(input_->player().stopped_calls());
  Result<void> started = run_start();
  if (!started) return started;
  input_->end_pass();
  // a rewind can return to this state, as it could in the recorded session
  if (initial_state.reset) show_.end_history_pass(false);
  return started;
}

// Runs the scene for the first time, as the take began.
Result<void> TakePlayback::run_start() {
  TakePlayer& player = input_->player();
  if (player.initial_state().reset) {
    apply_initial_state(show_, player.initial_state());
    return scenes_.reset() ? Result<void>() : Result<void>(Error{"the scene's file has an error"});
  }
  const std::vector<TakeSceneRun>& runs = player.tick().runs;
  auto bank = runs.empty() ? std::nullopt : player.presets(runs.front());
  if (bank) show_.presets.open({std::move(bank->list), nullptr, bank->file});
  return scenes_.start();
}

bool TakePlayback::begin_pass() {
  if (input_ == nullptr) return true;
  const bool panic = show_.link.panic_signal.load() || show_.link.command_queue.has_urgent(UrgentKind::panic);
  if (input_->in_show() && panic) {
    end();
    return true;
  }
  if (next_tick()) return true;
  if (!input_->in_show()) return false;
  end();
  return true;
}

// Prepares the next tick of the take. False at its end.
bool TakePlayback::next_tick() {
  TakePlayer& player = input_->player();
  if (!player.next()) return false;
  show_.call_log.begin_pass(player.stopped_calls());
  while (const TakeSceneRun* run = player.next_external_run()) run_scene(*run);
  return true;
}

void TakePlayback::run_scene(const TakeSceneRun& run) {
  if (run.kind == TakeSceneRun::Kind::reload) {
    scenes_.run_now(run.kind, run.reuses_files);
    return;
  }
  const SceneRunner::Run scene_run = scenes_.begin_run(run.kind, run.reuses_files, run.scene);
  if (run.kind == TakeSceneRun::Kind::scene) return load_scene(run, scene_run);
  if (run.kind == TakeSceneRun::Kind::reload_requested) {
    reload_request_ = scenes_.reloader().make_request(*show_.session, run.reuses_files);
    return;
  }
  if (scene_run.files.fails || !reload_request_) return;
  reload_request_->options.sources = scene_run.files.sources;
  ReloadCandidate candidate(*std::exchange(reload_request_, std::nullopt), scenes_.host());
  scenes_.apply_candidate(candidate);
}

// Changes to another scene.
void TakePlayback::load_scene(const TakeSceneRun& run, const SceneRunner::Run& scene_run) {
  auto session = show_.new_session();
  script::SceneOptions run_options = show_.scene_options();
  run_options.sources = scene_run.files.sources;
  if (!session->run_detached(run.scene, scenes_.host(), run_options)) return;
  auto loaded = input_->player().presets(run);
  Presets::Bank bank;
  if (loaded) bank = {std::move(loaded->list), nullptr, loaded->file};
  scenes_.play_scene(run.scene, session, bank);
}

Result<void> TakePlayback::play(const std::string& file, std::optional<std::uint64_t> stops) {
  EngineLink& link = show_.link;
  const std::uint64_t stops_when_requested = stops.value_or(link.take_stop_count());
  auto player = TakePlayer::open(file, false);
  if (!player) return Error{player.error()};
  (*player)->next();
  if (Result<void> runs = check(**player); !runs) return runs;
  Presets::Bank bank = scenes_.read_presets((*player)->initial_state().scene);
  std::unique_ptr<Session> previous;  // destroyed on this thread, so that the simulation doesn't wait for it
  Result<void> started;
  const Result<void> done = scenes_.run_between_ticks([&] {
    if (recording_.active()) {
      started = Error{"a take is being recorded; /take/stop ends it"};
    } else if (link.take_stop_count() != stops_when_requested) {
      show_.output().count(&Counters::discarded);
      started = Error{"discarded: a panic or /take/stop was requested before it could start"};
    } else {
      previous = begin_in_show(std::move(*player), file, bank);
    }
  });
  return done ? started : done;
}

// Runs the take's scene detached: the running session isn't replaced if the scene fails.
Result<void> TakePlayback::check(TakePlayer& player) {
  const std::vector<TakeSceneRun>& runs = player.tick().runs;
  if (runs.empty() || !runs.front().succeeded) return Error{"its scene failed when it was recorded, too"};
  script::SceneOptions options = show_.options.scene_options;
  options.package_paths = player.initial_state().package_paths;
  options.limits = replay_limits(true);
  options.sources = player.sources(runs.front());
  Session session(show_.link, show_.presets, show_.cues, show_.undo_stack, {});  // never steps
  return session.run_detached(player.initial_state().scene, scenes_.host(), options);
}

// Replaces the session by the replay and returns the previous one. `bank`: presets of the take's scene from the disk,
// which are used after the replay; on return the presets that were open, if they belong to another scene.
std::unique_ptr<Session> TakePlayback::begin_in_show(std::unique_ptr<TakePlayer> player, const std::string& file,
                                                     Presets::Bank& bank) {
  live_.reject_commands(TakeInput::kReplayingError);
  recovery_.set_suspended(true);
  show_.added.clear();  // the take has its own
  show_.overrides.clear();
  show_.undo_stack.clear();
  show_.cues.set_state({});
  presets_after_ = show_.presets.exchange({});
  if (presets_after_.file != bank.file) std::swap(presets_after_, bank);
  if (show_.session->scene != nullptr) show_.session->scene->disable_jit();
  std::unique_ptr<Session> previous = scenes_.swap_session(show_.new_session());
  if (const Result<void> started = begin(std::move(player), file, true); !started) {
    show_.output().report_fault(fmt::format("{}: {}", printable(file), started.error()));
    end();
    return previous;
  }
  log_info("playing the take {}; /take/stop ends it", printable(name_));
  show_.send_transport();
  return previous;
}

void TakePlayback::end_if_requested() {
  if (input_ != nullptr && input_->stop_requested()) end();
}

void TakePlayback::end() {
  const ReplayResult result = input_->player().result();
  show_.input = &live_;
  input_ = nullptr;
  show_.set_rules({});
  recovery_.set_suspended(false);
  reload_request_.reset();
  show_.presets.exchange(std::exchange(presets_after_, {}));
  const script::ScriptLimits& limits = show_.options.scene_options.limits;
  if (show_.session->scene != nullptr) show_.session->scene->set_limits(limits);
  scenes_.reloader().set_limits(limits);
  if (show_.session->scene != nullptr)  // models that were added in the take stay
    show_.added = show_.session->scene->sources()->added();
  scenes_.reloader().set_added(show_.added);
  show_.history.clear("a take was played before");
  log_info("{}: {}; live input resumed", printable(name_), text_of(result));
  const double diverged_at = result.diverged_at ? static_cast<double>(*result.diverged_at) : -1;
  show_.output().push(
      {Outgoing::Destination::event,
       {},
       {"/take/played", {Arg::of(name_), Arg::of(static_cast<double>(result.ticks)), Arg::of(diverged_at)}}});
  show_.send_transport();
}

std::optional<TakeNode::Status> TakePlayback::status() const {
  if (input_ == nullptr) return std::nullopt;
  const TakePlayer& player = input_->player();
  return TakeNode::Status{name_, true, player.ticks(), player.total_ticks(), input_->in_show()};
}

}  // namespace limber::engine

// Engine: reloads and scene changes. The new scene runs detached from the show.
#include <utility>

#include "base/log/log.h"
#include "engine/engine.h"
#include "engine/reload/reload_candidate.h"

namespace limber {

// Runs `work` on the simulation thread between two ticks. Fails during a replay, because the take contains all input.
Result<void> Engine::run_between_ticks(const std::function<void()>& work) {
  Result<void> done = Error{"the show has ended"};
  const auto work_of_show = [&] {
    done = is_replaying() ? Result<void>(Error{"a take plays; /take/stop ends it"}) : Result<void>();
    if (done) work();
  };
  executor_.run_and_wait(work_of_show, [this] {
    commands_waiting_.store(true, std::memory_order_relaxed);
    { const std::scoped_lock lock(wake_mutex_); }
    wake_.notify_all();
  });
  return done;
}

bool Engine::reload(bool reuse_files) {
  constexpr int kTries = 3;
  for (int i = 0; i < kTries; i++) {
    ReloadRequest request;
    const auto copy_request = [&] {
      begin_run(TakeSceneRun::Kind::reload_requested, reuse_files);
      request = reloader_.make_request(*session_, reuse_files);
    };
    if (!run_between_ticks(copy_request)) return false;
    ReloadCandidate candidate(std::move(request), *this);
    SceneReloader::ApplyResult result = SceneReloader::ApplyResult::outdated;
    const auto apply_request = [&] {
      const RecordedRun run = begin_run(TakeSceneRun::Kind::reload_finished);
      result = apply_candidate(candidate);
      if (result == SceneReloader::ApplyResult::applied) run_succeeded(run, *session_);
    };
    if (!run_between_ticks(apply_request)) return false;
    if (result != SceneReloader::ApplyResult::outdated) return true;
  }
  // resets have made each candidate outdated, so reload within a tick
  return run_between_ticks([&] { reload_now(reuse_files); }).ok();
}

SceneReloader::ApplyResult Engine::reload_now(bool reuse_files) {
  return run_scene_now(TakeSceneRun::Kind::reload, reuse_files);
}

SceneReloader::ApplyResult Engine::run_scene_now(TakeSceneRun::Kind kind, bool reuse_files) {
  const RecordedRun run = begin_run(kind, reuse_files);
  ReloadRequest request = reloader_.make_request(*session_, reuse_files);
  if (run.fails) return SceneReloader::ApplyResult::failed;
  request.options.sources = run.sources;
  ReloadCandidate candidate(std::move(request), *this);
  const SceneReloader::ApplyResult result = apply_candidate(candidate);
  if (result == SceneReloader::ApplyResult::applied) run_succeeded(run, *session_);
  return result;
}

SceneReloader::ApplyResult Engine::apply_candidate(ReloadCandidate& candidate) {
  const bool is_start = session_->scene == nullptr;
  candidate.scene()->set_call_log(call_log_);
  const SceneReloader::ApplyResult result = [&] {
    const EditScope edit_scope(session_->world, presets_, undo_stack_, change_recorder_);
    return reloader_.apply_candidate(candidate, *session_);
  }();
  if (result != SceneReloader::ApplyResult::applied) return result;
  history_.clear("the scene was run again there");
  presets_.set_script_preset(reloader_.script_preset());
  static const Property& seed = World::table().at("seed");
  if ((candidate.diff().world >> seed.index & 1u) != 0) scene_seed_ = session_->world.seed();
  if (!is_start) return result;
  scene_seed_ = session_->world.seed();
  if (const Result<void> set = apply_initial_overrides(); !set) log_error("{}", set.error());
  begin_show();
  return result;
}

Result<void> Engine::change_scene(const std::string& file, std::optional<std::uint64_t> panics) {
  const std::uint64_t panics_at_request = panics.value_or(link_.panics.load());
  auto fresh = new_session();
  Result<void> run_result = fresh->run_detached(file, *this, options_.scene_options);
  if (!run_result) return run_result;
  Presets::Bank bank = read_presets(file);
  // the previous session and presets are destroyed at the end of this function, on this thread
  Result<void> result;
  const Result<void> done = run_between_ticks([&] {
    if (link_.panics.load() != panics_at_request) {
      link_.counters.discarded.fetch_add(1, std::memory_order_relaxed);
      result = Error{"discarded: a panic was requested before it could start"};
      return;
    }
    const RecordedRun run = begin_run(TakeSceneRun::Kind::scene, false, file);
    run_succeeded(run, *fresh, bank.list, bank.file);
    play_scene(file, fresh, bank);
  });
  return done ? result : done;
}

void Engine::play_scene(const std::string& file, std::unique_ptr<Session>& fresh, Presets::Bank& bank) {
  options_.scene = file;
  overrides_.clear();
  undo_stack_.clear();
  reloader_.capture(*fresh, scene_options(), file);
  presets_.set_script_preset(reloader_.script_preset());
  bank = presets_.open(std::move(bank));
  if (session_->scene != nullptr) session_->scene->disarm();
  fresh = install_session(std::move(fresh));
  session_->make_live(*this);
  scene_seed_ = session_->world.seed();
  begin_show();
  send_transport();
}

void Engine::rerun_if_requested() {
  if (!reloader_.consume_rerun(*session_)) return;
  const bool detached = link_.on_rerun && !options_.fast;
  if (is_replaying() && !player_->current_scripts()) {
    // a detached run is in the take as an input of its own
    if (player_->next_run_is(TakeSceneRun::Kind::rerun)) run_scene_now(TakeSceneRun::Kind::rerun, true);
  } else if (detached) {
    link_.on_rerun();
  } else {
    run_scene_now(TakeSceneRun::Kind::rerun, true);
  }
}

}  // namespace limber

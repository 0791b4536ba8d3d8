// Engine: the scene's runs beside the show.
#include <utility>

#include "base/log.h"
#include "engine/draft.h"
#include "engine/engine.h"

namespace limber {

// a take that is replayed has all that reaches the show
Result<void> Engine::between_ticks(const std::function<void()>& work) {
  Result<void> done = Error{"the show has ended"};
  const auto work_of_show = [&] {
    done = replays() ? Result<void>(Error{"a take plays; /take/stop ends it"}) : Result<void>();
    if (done) work();
  };
  requests_.ask(work_of_show, [this] {
    commands_wait_.store(true, std::memory_order_relaxed);
    { const std::scoped_lock lock(wake_mutex_); }
    wake_.notify_all();
  });
  return done;
}

bool Engine::reload(bool again) {
  constexpr int kTries = 3;
  for (int i = 0; i < kTries; i++) {
    DraftOrder order;
    const auto copy_order = [&] {
      begin_run(TakeRun::Kind::order, again);
      order = reload_.order(*stage_, again);
    };
    if (!between_ticks(copy_order)) return false;
    Draft draft(std::move(order), *this);
    Reload::End end = Reload::End::outdated;
    const auto apply_draft = [&] {
      const TakenRun run = begin_run(TakeRun::Kind::take);
      end = take(draft);
      if (end == Reload::End::applied) run_was_good(run, *stage_);
    };
    if (!between_ticks(apply_draft)) return false;
    if (end != Reload::End::outdated) return true;
  }
  // resets come so fast that each draft is late: this one stretches a tick
  return between_ticks([&] { reload_now(again); }).ok();
}

Reload::End Engine::reload_now(bool again) { return run_now(TakeRun::Kind::reload, again); }

Reload::End Engine::run_now(TakeRun::Kind kind, bool again) {
  const TakenRun run = begin_run(kind, again);
  DraftOrder order = reload_.order(*stage_, again);
  if (run.fails) return Reload::End::failed;
  order.options.sources = run.sources;
  Draft draft(std::move(order), *this);
  const Reload::End end = take(draft);
  if (end == Reload::End::applied) run_was_good(run, *stage_);
  return end;
}

Reload::End Engine::take(Draft& draft) {
  const bool is_start = stage_->scene == nullptr;
  draft.scene()->count_calls(calls_);
  const Reload::End end = [&] {
    const Hands hands(stage_->world, presets_, edits_, notes_);
    return reload_.take(draft, *stage_);
  }();
  if (end != Reload::End::applied) return end;
  history_.begin_anew("the scene was run anew there");
  presets_.scene_says(reload_.script());
  static const Row& seed = World::table().at("seed");
  if ((draft.difference().world >> seed.index & 1u) != 0) scene_seed_ = stage_->world.seed();
  if (!is_start) return end;
  scene_seed_ = stage_->world.seed();
  if (const Result<void> set = first_hand(); !set) log_error("{}", set.error());
  begin_show();
  return end;
}

Result<void> Engine::change_scene(const std::string& file, std::optional<std::uint64_t> panics) {
  const std::uint64_t asked = panics.value_or(link_.panics.load());
  auto fresh = new_stage();
  Result<void> ran = fresh->run_beside(file, *this, options_.scene_options);
  if (!ran) return ran;
  Presets::Book book = read_presets(file);
  // the stage and the presets before go at the end of this, beside the show
  Result<void> begun;
  const Result<void> done = between_ticks([&] {
    if (link_.panics.load() != asked) {
      link_.counters.discarded.fetch_add(1, std::memory_order_relaxed);
      begun = Error{"discarded: a panic came before it could begin"};
      return;
    }
    const TakenRun run = begin_run(TakeRun::Kind::scene, false, file);
    run_was_good(run, *fresh, book.list, book.file);
    play_scene(file, fresh, book);
  });
  return done ? begun : done;
}

void Engine::play_scene(const std::string& file, std::unique_ptr<Stage>& fresh, Presets::Book& book) {
  options_.scene = file;
  hand_.clear();
  edits_.clear();
  reload_.begin(*fresh, scene_options(), file);
  presets_.scene_says(reload_.script());
  book = presets_.open(std::move(book));
  if (stage_->scene != nullptr) stage_->scene->disarm();
  fresh = take_stage(std::move(fresh));
  stage_->begin(*this);
  scene_seed_ = stage_->world.seed();
  begin_show();
  send_transport();
}

void Engine::rerun() {
  if (!reload_.take_rerun(*stage_)) return;
  const bool beside = link_.rerun_scene && !options_.fast;
  if (replays() && !player_->current_scripts()) {
    // where it was run beside the show, the take has that by itself
    if (player_->comes(TakeRun::Kind::rerun)) run_now(TakeRun::Kind::rerun, true);
  } else if (beside) {
    link_.rerun_scene();
  } else {
    run_now(TakeRun::Kind::rerun, true);
  }
}

}  // namespace limber

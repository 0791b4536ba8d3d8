// Engine: the scene's runs beside the show.
#include <utility>

#include "base/log.h"
#include "engine/draft.h"
#include "engine/engine.h"

namespace limber {

bool Engine::between_ticks(const std::function<void()>& work) {
  return requests_.ask(work, [this] {
    commands_wait_.store(true, std::memory_order_relaxed);
    { const std::scoped_lock lock(wake_mutex_); }
    wake_.notify_all();
  });
}

void Engine::reload(bool again) {
  constexpr int kTries = 3;
  for (int i = 0; i < kTries; i++) {
    DraftOrder order;
    if (!between_ticks([&] { order = reload_.order(*stage_, again); })) return;
    Draft draft(std::move(order), *this);
    Reload::End end = Reload::End::outdated;
    if (!between_ticks([&] { end = take(draft); }) || end != Reload::End::outdated) return;
  }
  // resets come so fast that each draft is late: this one stretches a tick
  between_ticks([&] { reload_now(again); });
}

Reload::End Engine::reload_now(bool again) {
  Draft draft(reload_.order(*stage_, again), *this);
  return take(draft);
}

Reload::End Engine::take(Draft& draft) {
  const bool is_start = stage_->scene == nullptr;
  const Reload::End end = [&] {
    const Presets::Hands hands(presets_, stage_->store);
    return reload_.take(draft, *stage_);
  }();
  if (end != Reload::End::applied) return end;
  presets_.scene_says(reload_.script());
  static const Row& seed = World::table().at("seed");
  if ((draft.difference().world >> seed.index & 1u) != 0) scene_seed_ = stage_->world.seed();
  if (!is_start) return end;
  scene_seed_ = stage_->world.seed();
  if (const Result<void> set = first_hand(); !set) log_error("{}", set.error());
  begin_show();
  return end;
}

void Engine::rerun() {
  if (!reload_.take_rerun(*stage_)) return;
  if (link_.rerun_scene && !options_.fast) {
    link_.rerun_scene();
  } else {
    reload_now(true);
  }
}

}  // namespace limber

// Scene state outside Lua's heap: generators, phase of timers, counters.
#include "script/scene/scene_checkpoint.h"

#include <algorithm>

#include "script/api/script_context.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/scene/earlier_runs.h"
#include "script/scene/scene.h"
#include "script/vm/vm.h"

namespace limber::script {

namespace {

void serialize_context(Archive& archive, ScriptContext& context) {
  context.random.serialize(archive);
  archive.serialize_all(context.timers.checked_at, context.osc.handlers, context.osc.disabled_handlers,
                        context.timers.cancellations);
  context.behaviors->serialize(archive);
}

void serialize_run(Archive& archive, EarlierRuns::Run& run) {
  serialize_context(archive, *run.context);
  archive.serialize_all(run.timers, run.ended_at, run.state);
}

}  // namespace

template <class SerializeExtra>
void SceneCheckpoint::capture(State& to, Vm& vm, PageStore& pages, const State* previous, Archive& scratch,
                              SerializeExtra serialize_extra) {
  vm.copy_heap(pages, previous == nullptr ? nullptr : &previous->heap, to.heap);
  scratch.begin_saving();
  serialize_extra(scratch);
  vm.serialize_counts(scratch);
  to.extra_size = scratch.bytes().size();
  to.extra.clear();
  pages.append(to.extra, scratch.bytes(), previous == nullptr ? nullptr : &previous->extra);
}

template <class SerializeExtra>
void SceneCheckpoint::restore(const State& from, Vm& vm, const PageStore& pages, Archive& scratch,
                              SerializeExtra serialize_extra) {
  vm.restore_heap(pages, from.heap);
  scratch.bytes().resize(from.extra_size);
  pages.restore(from.extra, 0, scratch.bytes());
  scratch.begin_loading();
  serialize_extra(scratch);
  vm.serialize_counts(scratch);
}

void SceneCheckpoint::capture(Scene& scene, PageStore& pages, const SceneCheckpoint* previous, Archive& scratch) {
  const Scene::Components components = scene.components();
  const auto serialize_scene = [&](Archive& archive) { serialize_context(archive, components.context); };
  capture(state_, components.vm, pages, previous == nullptr ? nullptr : &previous->state_, scratch, serialize_scene);
  earlier_.clear();
  for (EarlierRuns::Run& run : components.earlier.all()) {
    if (run.timers == 0) continue;
    const State* older = nullptr;
    if (previous != nullptr) {
      for (const EarlierState& known : previous->earlier_) {
        if (known.number == run.number) older = &known.state;
      }
    }
    EarlierState& to = earlier_.emplace_back();
    to.number = run.number;
    capture(to.state, *run.vm, pages, older, scratch, [&](Archive& archive) { serialize_run(archive, run); });
  }
}

void SceneCheckpoint::restore(Scene& scene, const PageStore& pages, Archive& scratch) const {
  const Scene::Components components = scene.components();
  restore(state_, components.vm, pages, scratch,
          [&](Archive& archive) { serialize_context(archive, components.context); });
  for (EarlierRuns::Run& run : components.earlier.all()) {
    const auto known =
        std::ranges::find_if(earlier_, [&](const EarlierState& state) { return state.number == run.number; });
    if (known == earlier_.end()) {
      run.timers = 0;  // the run had ended at that time
    } else {
      restore(known->state, *run.vm, pages, scratch, [&](Archive& archive) { serialize_run(archive, run); });
    }
  }
}

void SceneCheckpoint::release(PageStore& pages) {
  pages.release(state_.heap);
  pages.release(state_.extra);
  for (EarlierState& earlier : earlier_) {
    pages.release(earlier.state.heap);
    pages.release(earlier.state.extra);
  }
  earlier_.clear();
}

}  // namespace limber::script

// What of a scene lies beside Lua's heap: generators, the beat of timers, counts.
#include "script/scene_key.h"

#include <algorithm>

#include "script/behavior_scripts.h"
#include "script/context.h"
#include "script/earlier_runs.h"
#include "script/scene.h"
#include "script/vm.h"

namespace limber {

namespace {

void pass_context(KeyBytes& key, ScriptContext& context) {
  key.pass_all(context.random, context.seeded_with, context.timers_at, context.handlers, context.disabled_handlers,
               context.cancels);
  context.behaviors->pass_memory(key);
}

void pass_run(KeyBytes& key, EarlierRuns::Run& run) {
  pass_context(key, *run.context);
  key.pass_all(run.timers, run.ended_at, run.state);
}

}  // namespace

template <class Beside>
void SceneKey::take(State& to, Vm& vm, PageStore& pages, const State* before, KeyBytes& scratch, Beside pass) {
  vm.copy_heap(pages, before == nullptr ? nullptr : &before->heap, to.heap);
  scratch.begin_taking();
  pass(scratch);
  vm.pass_counts(scratch);
  to.own_size = scratch.bytes().size();
  to.own.clear();
  pages.append(to.own, scratch.bytes(), before == nullptr ? nullptr : &before->own);
}

template <class Beside>
void SceneKey::bring_back(const State& from, Vm& vm, const PageStore& pages, KeyBytes& scratch, Beside pass) {
  vm.bring_back_heap(pages, from.heap);
  scratch.bytes().resize(from.own_size);
  pages.copy_back(from.own, 0, scratch.bytes());
  scratch.begin_bringing();
  pass(scratch);
  vm.pass_counts(scratch);
}

void SceneKey::take(Scene& scene, PageStore& pages, const SceneKey* before, KeyBytes& scratch) {
  const auto pass_scene = [&](KeyBytes& key) { pass_context(key, *scene.context_); };
  take(state_, *scene.vm_, pages, before == nullptr ? nullptr : &before->state_, scratch, pass_scene);
  earlier_.clear();
  for (EarlierRuns::Run& run : scene.earlier_->all()) {
    if (run.timers == 0) continue;
    const State* older = nullptr;
    if (before != nullptr) {
      for (const EarlierState& known : before->earlier_) {
        if (known.number == run.number) older = &known.state;
      }
    }
    EarlierState& to = earlier_.emplace_back();
    to.number = run.number;
    take(to.state, *run.vm, pages, older, scratch, [&](KeyBytes& key) { pass_run(key, run); });
  }
}

void SceneKey::bring_back(Scene& scene, const PageStore& pages, KeyBytes& scratch) const {
  bring_back(state_, *scene.vm_, pages, scratch, [&](KeyBytes& key) { pass_context(key, *scene.context_); });
  for (EarlierRuns::Run& run : scene.earlier_->all()) {
    const auto known =
        std::ranges::find_if(earlier_, [&](const EarlierState& state) { return state.number == run.number; });
    if (known == earlier_.end()) {
      run.timers = 0;  // it had ended by then
    } else {
      bring_back(known->state, *run.vm, pages, scratch, [&](KeyBytes& key) { pass_run(key, run); });
    }
  }
}

void SceneKey::release(PageStore& pages) {
  pages.release(state_.heap);
  pages.release(state_.own);
  for (EarlierState& earlier : earlier_) {
    pages.release(earlier.state.heap);
    pages.release(earlier.state.own);
  }
  earlier_.clear();
}

}  // namespace limber

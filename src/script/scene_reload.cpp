// Scene: what a run beside the show is given of it, and how such a run becomes the show.
#include <algorithm>

#include "script/behavior_scripts.h"
#include "script/context.h"
#include "script/earlier_runs.h"
#include "script/scene.h"
#include "script/vm.h"

namespace limber {

RunInputs Scene::inputs() {
  const ScriptContext& c = *context_;
  RunInputs inputs;
  inputs.tick = c.world->tick();
  inputs.time = c.world->time();
  inputs.state = vm_->state_text();
  if (c.params != nullptr) inputs.params = c.params->live();
  return inputs;
}

void Scene::prepare() { vm_->prepare(); }

void Scene::note_things() {
  const bool keeps = context_->options.keep_timers && vm_->callback_timers().timers > 0;
  earlier_->note_things();
  names_ = keeps ? std::make_unique<HandleNames>() : nullptr;
  if (!keeps) return;
  vm_->gather_handles();
  names_->note(*context_);
}

void Scene::release_ended(std::uint64_t before_tick) { earlier_->release_ended(before_tick); }

// of a run whose place this one takes
void Scene::keep_run(Scene& before) {
  ScriptContext& old = *before.context_;
  old.behaviors->close();  // it may go on another thread
  run_number_ = before.run_number_ + 1;
  before.earlier_->cancel(old, old.world->tick());
  earlier_ = std::move(before.earlier_);
  kept_ = {};
  if (before.names_ == nullptr) {
    old.look_at(nullptr);
  } else {
    EarlierRuns::Run run(std::move(before.context_), std::move(before.vm_));
    run.names = std::move(*before.names_);
    run.number = before.run_number_;
    kept_.handlers = run.vm->become_earlier();
    kept_.ended = earlier_->add(std::move(run));
  }
  earlier_->follow_things(params());
  const EarlierRuns::Counts counts = earlier_->counts();
  kept_.timers = counts.timers;
  kept_.repeating = counts.repeating;
}

std::uint64_t Scene::become_live(World& world, const std::function<NodeId(NodeId)>& live_id, Scene* before) {
  ScriptContext& c = *context_;
  // handles: the ids that their things have in the other store, or none
  for (std::int32_t* const id : c.things) {
    const NodeId live = live_id(id_of(id[0], id[1]));
    id[0] = live.null() ? -1 : static_cast<std::int32_t>(live.slot);
    id[1] = static_cast<std::int32_t>(live.generation);
  }
  c.things = {};
  std::vector<Row> rows;
  if (c.params != nullptr) rows.assign(c.params->table().rows().begin(), c.params->table().rows().end());
  const bool has_params = c.params != nullptr;
  const Table* const table = has_params ? &c.params->table() : nullptr;
  c.params = nullptr;
  c.look_at(&world);

  ScriptContext* const old = before == nullptr ? nullptr : before->context_.get();
  std::vector<LiveParam> live;
  if (old != nullptr && old->params != nullptr) live = old->params->live();
  std::uint64_t defaults = 0;
  if (has_params && old != nullptr && old->params != nullptr && &old->params->table() == table) {
    c.params = std::move(old->params);  // the same node, with all that it holds
  } else {
    if (old != nullptr) old->params = nullptr;
    if (has_params) {
      c.params = std::make_unique<ParamsNode>(world.store(), std::move(rows));
      defaults = c.params->keep(live);
    }
  }
  if (old != nullptr) {
    vm_->take_state(before->vm_->state_text());
    if (c.options.keep_timers) vm_->take_afters(before->vm_->afters_text());
    c.timers_at = old->timers_at;
    before->disarm();
    keep_run(*before);
  }
  vm_->number_run(run_number_);
  vm_->become_live(c.timers_at);
  arm();
  c.host.plan_osc(c.plan);
  return defaults;
}

NodeId Scene::params() const { return context_->params == nullptr ? NodeId{} : context_->params->id(); }

void Scene::rerun_values(std::vector<double>& out) const {
  const ScriptContext& c = *context_;
  out.clear();
  if (c.rerun_rows == 0 || c.params == nullptr) return;
  const Store& store = c.world->store();
  for (const Row& row : c.params->table().rows()) {
    if ((c.rerun_rows >> row.index & 1u) == 0) continue;
    const double* const values = store.values(c.params->id(), row);
    out.insert(out.end(), values, values + row.width);
  }
}

}  // namespace limber

// Scene: data for a detached run, and going live.
#include <algorithm>

#include "script/api/script_context.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/scene/earlier_runs.h"
#include "script/scene/scene.h"
#include "script/vm/vm.h"
#include "sim/world/body.h"

namespace limber::script {

RunInputs Scene::inputs() {
  const ScriptContext& c = *context_;
  RunInputs inputs;
  inputs.tick = c.world->tick();
  inputs.time = c.world->time();
  inputs.state = vm_->state_text();
  if (c.params.node != nullptr) inputs.params = c.params.node->values();
  return inputs;
}

void Scene::prepare() { vm_->prepare(); }

void Scene::capture_handles() {
  const bool has_timers = context_->options.keep_timers && vm_->callback_timers().timers > 0;
  earlier_->capture_handles();
  handle_names_ = has_timers ? std::make_unique<HandleNames>() : nullptr;
  if (!has_timers) return;
  vm_->gather_handles();
  handle_names_->capture(*context_);
}

void Scene::release_ended(std::uint64_t before_tick) { earlier_->release_ended(before_tick); }

// takes over the earlier runs, and the replaced run if it has timers
void Scene::adopt_run(Scene& previous) {
  ScriptContext& old = *previous.context_;
  old.behaviors->detach();  // it may be destroyed on another thread
  run_number_ = previous.run_number_ + 1;
  previous.earlier_->apply_cancellations(old, old.world->tick());
  earlier_ = std::move(previous.earlier_);
  carried_timers_ = {};
  if (previous.handle_names_ == nullptr) {
    old.set_world(nullptr);
  } else {
    EarlierRuns::Run run(std::move(previous.context_), std::move(previous.vm_));
    run.handle_names = std::move(*previous.handle_names_);
    run.number = previous.run_number_;
    carried_timers_.handlers = run.vm->retire();
    carried_timers_.ended = earlier_->add(std::move(run));
  }
  earlier_->resolve_handles(params());
  const EarlierRuns::Counts counts = earlier_->counts();
  carried_timers_.timers = counts.timers;
  carried_timers_.repeating = counts.repeating;
}

namespace {

// Maps the handles to the ids in the live store.
void map_handles(ScriptContext& c, const std::function<NodeId(NodeId)>& live_id) {
  for (std::int32_t* const id : c.arguments.handle_ids) {
    const NodeId live = live_id(id_of(id[0], id[1]));
    id[0] = live.null() ? -1 : static_cast<std::int32_t>(live.slot);
    id[1] = static_cast<std::int32_t>(live.generation);
  }
  c.arguments.handle_ids = {};
}

}  // namespace

std::uint64_t Scene::become_live(sim::World& world, const std::function<NodeId(NodeId)>& live_id, Scene* previous) {
  ScriptContext& c = *context_;
  map_handles(c, live_id);
  std::vector<Property> properties;
  if (c.params.node != nullptr)
    properties.assign(c.params.node->table().properties().begin(), c.params.node->table().properties().end());
  const bool has_params = c.params.node != nullptr;
  const PropertyTable* const table = has_params ? &c.params.node->table() : nullptr;
  c.params.node = nullptr;
  c.set_world(&world);

  ScriptContext* const old = previous == nullptr ? nullptr : previous->context_.get();
  std::vector<LiveParam> live;
  if (old != nullptr && old->params.node != nullptr) live = old->params.node->values();
  std::uint64_t defaults = 0;
  if (has_params && old != nullptr && old->params.node != nullptr && &old->params.node->table() == table) {
    c.params.node = std::move(old->params.node);  // same node, with all its values
  } else {
    if (old != nullptr) old->params.node = nullptr;
    if (has_params) {
      c.params.node = std::make_unique<ParamsNode>(world.store(), std::move(properties));
      defaults = c.params.node->carry_over(live);
    }
  }
  if (old != nullptr) {
    vm_->adopt_state(previous->vm_->state_text());
    if (c.options.keep_timers) vm_->adopt_delayed_timers(previous->vm_->delayed_timers_text());
    c.timers.checked_at = old->timers.checked_at;
    previous->disable_jit();
    adopt_run(*previous);
  }
  vm_->set_run_number(run_number_);
  vm_->become_live(c.timers.checked_at);
  enable_jit();
  c.host.configure_osc(c.osc.config);
  return defaults;
}

NodeId Scene::params() const { return context_->params.id(); }

void Scene::rerun_values(std::vector<double>& out) const {
  const ScriptContext& c = *context_;
  out.clear();
  if (c.params.rerun_properties == 0 || c.params.node == nullptr) return;
  const Store& store = c.world->store();
  for (const Property& property : c.params.node->table().properties()) {
    if ((c.params.rerun_properties >> property.index & 1u) == 0) continue;
    const double* const values = store.values(c.params.id(), property);
    out.insert(out.end(), values, values + property.width);
  }
}

}  // namespace limber::script

// Results, object names, random numbers, and begin and end of guarded calls.
#include "script/api/script_context.h"

#include <fmt/format.h>

#include "properties/values_hash.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/vm/guard.h"
#include "sim/clock/beat_clock.h"
#include "sim/fixtures/fixture.h"
#include "sim/gears/gear.h"
#include "sim/routes/route.h"
#include "sim/shapes/shape.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::script {

ScriptContext::ScriptContext(sim::World& w, ScriptHost& h, SceneOptions o)
    : world(&w),
      host(h),
      options(std::move(o)),
      pattern_matcher([this] { return guard->stop_requested(); }),
      behaviors(std::make_shared<BehaviorScripts>(*this)) {
  set_world(world);
}

ScriptContext::~ScriptContext() {
  behaviors->detach();
  set_world(nullptr);
}

void ScriptContext::set_world(sim::World* new_world) {
  if (world != nullptr) {
    world->store().unregister_view(views.store);
    world->mass_table().unregister_view(views.masses);
  }
  world = new_world;
  if (world == nullptr) return;
  world->store().register_view(views.store);
  world->mass_table().register_view(views.masses);
}

std::int32_t Answer::set_text(std::string new_text) {
  text_storage_ = std::move(new_text);
  text = text_storage_.data();
  length = static_cast<std::int32_t>(text_storage_.size());
  return kOk;
}

std::int32_t Answer::set_id(NodeId id) {
  slot = static_cast<std::int32_t>(id.slot);
  generation = static_cast<std::int32_t>(id.generation);
  count = id.null() ? 0 : 1;
  return kOk;
}

std::uint64_t ScriptContext::hash(std::uint64_t start) const {
  NumberHash numbers(behaviors->hash(start) +
                     (params.node != nullptr ? persistent_hash(world->store(), params.id()) : 0));
  random.add_to(numbers);
  return numbers.value();
}

void ScriptContext::count_call() {
  answer.call = static_cast<std::int32_t>(static_cast<std::uint32_t>(answer.call) + 1);  // wraps around after a day
  random.begin_call();
}

void ScriptContext::begin_call() {
  count_call();
  effects.begin_call();
  timers.begin_call();
  neighbors.group_means = {};
  world->transaction().begin();
}

bool ScriptContext::next_call() {
  if (!world->transaction().is_empty() || !effects.can_wait() || timers.canceled()) {
    end_call(true);
    begin_call();
    return true;
  }
  count_call();
  effects.forces.commit(world->force_accumulators());
  return false;
}

void ScriptContext::end_call(bool success) {
  effects.forces.apply_committed(world->force_accumulators());
  if (success) {
    world->transaction().commit();
    effects.apply(*world, host);
  } else {
    effects.forces.discard_uncommitted();
    world->transaction().rollback();
    timers.rollback();
    random.rollback();
  }
  effects.clear();
}

sim::Behavior* behavior_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!c.alive(id) || store.table(id).name() != "behavior") return nullptr;
  return static_cast<sim::Behavior*>(store.object(id));
}

sim::BehaviorGroup* group_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  // a node of the store without properties (Store::is_group) is no group of behaviors, but its table has the same name
  if (!c.alive(id) || store.is_group(id) || store.table(id).name() != "group") return nullptr;
  return static_cast<sim::BehaviorGroup*>(store.object(id));
}

std::string label_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!store.alive(id)) return "an object that no longer exists";
  const PropertyTable* const table = &store.table(id);
  if (table == &sim::World::table()) return "sim";
  if (table == &sim::Visuals::table()) return "visuals";
  if (table == &sim::Camera::table()) return "visuals.camera";
  if (table == &sim::Appearance::table()) return "visuals.look";
  if (table == &sim::BeatClock::table()) return "sim.clock";
  const std::string& name = store.name(id);
  if (table == &sim::Body::table() || table == &sim::Shape::table() || table == &sim::Gear::table() ||
      table == &sim::Fixture::table() || table == &sim::Route::table())
    return fmt::format("{} '{}'", table->name(), name);
  if (group_of(c, id) != nullptr) return fmt::format("group '{}'", name);
  const NodeId owner = store.parent(store.parent(id));
  if (object_of<sim::Body>(c, owner) != nullptr)
    return fmt::format("{} '{}/{}'", table->name(), store.name(owner), name);
  return "params";
}

}  // namespace limber::script

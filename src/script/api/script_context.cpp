// Results, object names, random numbers, and begin and end of guarded calls.
#include "script/api/script_context.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "properties/values_hash.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/vm/guard.h"

namespace limber {

ScriptContext::ScriptContext(World& w, ScriptHost& h, SceneOptions o)
    : world(&w),
      host(h),
      options(std::move(o)),
      search([this] { return guard->stop_requested(); }),
      behaviors(std::make_shared<BehaviorScripts>(*this)) {
  set_world(world);
}

ScriptContext::~ScriptContext() {
  behaviors->detach();
  set_world(nullptr);
}

void ScriptContext::set_world(World* new_world) {
  if (world != nullptr) {
    world->store().unregister_view(view);
    world->mass_table().unregister_view(mass_table);
  }
  world = new_world;
  if (world == nullptr) return;
  world->store().register_view(view);
  world->mass_table().register_view(mass_table);
}

std::int32_t ScriptContext::set_text(std::string new_text) {
  text = std::move(new_text);
  answer.text = text.data();
  answer.length = static_cast<std::int32_t>(text.size());
  return kOk;
}

std::int32_t ScriptContext::set_id(NodeId id) {
  answer.slot = static_cast<std::int32_t>(id.slot);
  answer.generation = static_cast<std::int32_t>(id.generation);
  answer.count = id.null() ? 0 : 1;
  return kOk;
}

Random& ScriptContext::generator() {
  // a change of the seed in a callback takes effect at the next start
  const bool reseed = !seeded_with || (answer.top_level != 0 && *seeded_with != world->seed());
  if (reseed) {
    seeded_with = world->seed();
    random = Random(world->seed(), random_name);
  }
  return random;
}

std::uint64_t ScriptContext::hash(std::uint64_t start) const {
  NumberHash numbers(behaviors->hash(start) + (params != nullptr ? persistent_hash(world->store(), params->id()) : 0));
  if (random.used()) numbers.add(random.state());
  return numbers.value();
}

void ScriptContext::count_call() {
  answer.call = static_cast<std::int32_t>(static_cast<std::uint32_t>(answer.call) + 1);  // wraps around after a day
  random_before_ = random;
  seeded_before_ = seeded_with;
}

void ScriptContext::begin_call() {
  count_call();
  reset_requested = panic_requested = false;
  cancellations_before_call = cancellations.size();
  group_means = {};
  world->transaction().begin();
}

bool ScriptContext::next_call() {
  if (!world->transaction().is_empty() || !pending_messages.empty() || reset_requested || panic_requested ||
      cancellations.size() > cancellations_before_call) {
    end_call(true);
    begin_call();
    return true;
  }
  count_call();
  forces.commit(world->force_accumulators());
  return false;
}

void ScriptContext::end_call(bool success) {
  forces.apply_committed(world->force_accumulators());
  if (success) {
    world->transaction().commit();
    forces.apply(world->force_accumulators());
    for (PendingMessage& pending : pending_messages) {
      if (pending.route == Route::all) {
        host.send(std::move(pending.message));
      } else if (pending.route == Route::sender) {
        host.reply(pending.to, std::move(pending.message));
      } else {
        host.send_direct(pending.to, std::move(pending.message));
      }
    }
    for (Message& request : preset_requests) host.request_preset(std::move(request));
    if (reset_requested) host.request_reset();
    if (panic_requested) host.request_panic();
  } else {
    forces.discard_uncommitted();
    world->transaction().rollback();
    cancellations.resize(cancellations_before_call);
    random = random_before_;
    seeded_with = seeded_before_;
  }
  pending_messages.clear();
  preset_requests.clear();
}

Behavior* behavior_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!c.alive(id) || store.table(id).name() != "behavior") return nullptr;
  return static_cast<Behavior*>(store.object(id));
}

BehaviorGroup* group_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  // groups of the store without properties are also called groups
  if (!c.alive(id) || store.is_group(id) || store.table(id).name() != "group") return nullptr;
  return static_cast<BehaviorGroup*>(store.object(id));
}

std::string label_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!store.alive(id)) return "an object that no longer exists";
  const PropertyTable* const table = &store.table(id);
  if (table == &World::table()) return "sim";
  if (table == &Visuals::table()) return "visuals";
  if (table == &Camera::table()) return "visuals.camera";
  if (table == &Appearance::table()) return "visuals.look";
  const std::string& name = store.name(id);
  if (table == &Body::table() || table == &Shape::table() || table == &Gear::table())
    return fmt::format("{} '{}'", table->name(), name);
  if (group_of(c, id) != nullptr) return fmt::format("group '{}'", name);
  if (table == &Part::table() || table == &Joint::table() || table == &Motor::table() ||
      behavior_of(c, id) != nullptr) {
    return fmt::format("{} '{}/{}'", table->name(), store.name(store.parent(store.parent(id))), name);
  }
  return "params";
}

}  // namespace limber

// Answers, names of things, the scene's generator.
#include "script/context.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "params/values_hash.h"
#include "script/behavior_scripts.h"
#include "script/guard.h"

namespace limber {

ScriptContext::ScriptContext(World& w, ScriptHost& h, SceneOptions o)
    : world(&w),
      host(h),
      options(std::move(o)),
      search([this] { return guard->stop_asked(); }),
      behaviors(std::make_shared<BehaviorScripts>(*this)) {
  look_at(world);
}

ScriptContext::~ScriptContext() {
  behaviors->close();
  look_at(nullptr);
}

void ScriptContext::look_at(World* other) {
  if (world != nullptr) {
    world->store().hide_view(view);
    world->solids().hide_view(solids);
  }
  world = other;
  if (world == nullptr) return;
  world->store().show_view(view);
  world->solids().show_view(solids);
}

std::int32_t ScriptContext::say(std::string what) {
  text = std::move(what);
  answer.text = text.data();
  answer.length = static_cast<std::int32_t>(text.size());
  return kOk;
}

std::int32_t ScriptContext::tell(NodeId id) {
  answer.slot = static_cast<std::int32_t>(id.slot);
  answer.generation = static_cast<std::int32_t>(id.generation);
  answer.count = id.null() ? 0 : 1;
  return kOk;
}

Random& ScriptContext::generator() {
  // a seed that comes later counts from the next start
  const bool anew = !seeded_with || (answer.top_level != 0 && *seeded_with != world->seed());
  if (anew) {
    seeded_with = world->seed();
    random = Random(world->seed(), random_name);
  }
  return random;
}

std::uint64_t ScriptContext::hash(std::uint64_t start) const {
  NumberHash numbers(behaviors->hash(start) + (params != nullptr ? kept_hash(world->store(), params->id()) : 0));
  if (random.drawn()) numbers.add(random.state());
  return numbers.value();
}

void ScriptContext::count_call() {
  answer.call = static_cast<std::int32_t>(static_cast<std::uint32_t>(answer.call) + 1);  // wraps after a day
  random_before_ = random;
  seeded_before_ = seeded_with;
}

void ScriptContext::begin_call() {
  count_call();
  reset_wanted = panic_wanted = false;
  cancels_before_call = cancels.size();
  means_of_all = {};
  world->undo().begin();
}

bool ScriptContext::next_call() {
  if (!world->undo().untouched() || !held.empty() || reset_wanted || panic_wanted ||
      cancels.size() > cancels_before_call) {
    end_call(true);
    begin_call();
    return true;
  }
  count_call();
  forces.commit(world->loads());
  return false;
}

void ScriptContext::end_call(bool good) {
  forces.apply_committed(world->loads());
  if (good) {
    world->undo().end();
    forces.apply(world->loads());
    for (Held& h : held) {
      if (h.way == Way::all) {
        host.send(std::move(h.message));
      } else if (h.way == Way::sender) {
        host.reply(h.to, std::move(h.message));
      } else {
        host.send_direct(h.to, std::move(h.message));
      }
    }
    for (Message& wish : preset_wishes) host.ask_preset(std::move(wish));
    if (reset_wanted) host.ask_reset();
    if (panic_wanted) host.ask_panic();
  } else {
    forces.take_back();
    world->undo().take_back();
    cancels.resize(cancels_before_call);
    random = random_before_;
    seeded_with = seeded_before_;
  }
  held.clear();
  preset_wishes.clear();
}

Behavior* behavior_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!c.alive(id) || store.table(id).name() != "behavior") return nullptr;
  return static_cast<Behavior*>(store.thing(id));
}

BehaviorGroup* group_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  // Store's own nodes without rows are called groups too
  if (!c.alive(id) || store.is_group(id) || store.table(id).name() != "group") return nullptr;
  return static_cast<BehaviorGroup*>(store.thing(id));
}

std::string label_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!store.alive(id)) return "a thing that no longer exists";
  const Table* const table = &store.table(id);
  if (table == &World::table()) return "sim";
  if (table == &Visuals::table()) return "visuals";
  if (table == &Camera::table()) return "visuals.camera";
  if (table == &Look::table()) return "visuals.look";
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

// ScenePatch: behaviors and groups.
#include "engine/reload/behavior_patch.h"

#include <algorithm>
#include <bit>

#include "base/log/log.h"
#include "sim/world/body.h"

namespace limber::engine {

namespace {

SavedBehavior saved_behavior(const sim::Behavior& behavior) {
  const PropertyTable& table = *behavior.type().table;
  const double* const values = std::as_const(behavior.store()).persistent_block(behavior.id());
  return {behavior.body().name(), behavior.name(), behavior.type().name,
          behavior.setup(),       &table,          {values, values + table.persistent_width()}};
}

class BehaviorPatcher {
 public:
  BehaviorPatcher(const ScenePatch& patch, const std::vector<sim::Body*>& bodies,
                  const std::vector<SavedBehavior>& saved)
      : patch_(patch), bodies_(bodies), saved_(saved), list_(patch.world.behaviors()) {}

  void run() {
    replace_types();
    for (const auto& [body, name] : patch_.diff.removed_behaviors) {
      if (sim::Behavior* const removed = bodies_[body]->behaviors().find(name)) list_.remove(*removed);
    }
    for (const std::string& name : patch_.diff.removed_groups) {
      if (sim::BehaviorGroup* const removed = list_.find_group(name)) list_.remove(*removed);
    }
    for (std::size_t i = 0; i < bodies_.size(); i++) {
      for (std::size_t k = 0; k < patch_.now.bodies[i].behaviors.size(); k++) apply_behavior(i, k);
    }
    restore_unmanaged();
    for (std::size_t i = 0; i < patch_.now.groups.size(); i++) apply_group(i);
    for (std::size_t i = 0; i < bodies_.size(); i++) apply_members(i);
    if (patch_.diff.order_changed || added_) list_.order().sort(patch_.now.behavior_order);
  }

 private:
  // Replaces the types that come from files by those of the new run, and rebuilds their instances.
  void replace_types() {
    const sim::BehaviorTypes& source_types = patch_.candidate.behaviors().types();
    sim::BehaviorTypes& types = list_.types();
    std::vector<std::string> removed;
    for (const auto& type : types.all()) {
      if (!type->is_built_in && source_types.find(type->name) == nullptr) removed.push_back(type->name);
    }
    for (const auto& type : source_types.all()) {
      if (type->is_built_in) continue;
      (void)types.add(*type);  // can't fail: it was valid in the new run
      list_.replace_instances(type->name);
    }
    for (const std::string& name : removed) types.remove(name);
  }

  void set_properties(NodeId from, NodeId to, const PropertyTable& source_table, std::uint64_t mask) {
    const Store& source_store = patch_.candidate.store();
    Store& store = patch_.world.store();
    for (; mask != 0; mask &= mask - 1) {
      const Property& property = source_table.property(static_cast<std::uint32_t>(std::countr_zero(mask)));
      const Property& live = store.table(to).at(property.name);
      patch_.on_set(to, live);
      (void)store.set(
          to, live, {source_store.values(from, property), property.width});  // can't fail: it was valid in the new run
    }
  }

  // Copies saved values to the replacement of a behavior, except the properties of `except`, which the scene sets.
  void copy_values(const SavedBehavior& from, const sim::Behavior& to, std::uint64_t except) {
    Store& store = patch_.world.store();
    for (const Property& property : to.type().table->properties()) {
      if (!property.stored() || !property.writable() || (except >> property.index & 1u) != 0) continue;
      const Property* const old = from.table->find(property.name);
      if (old == nullptr || !old->stored() || old->type != property.type) continue;
      (void)store.set(to.id(), property, {from.values.data() + old->offset, property.width});
    }
  }

  const SavedBehavior* find_saved(std::string_view body, std::string_view name) const {
    const auto found =
        std::find_if(saved_.begin(), saved_.end(), [&](const auto& k) { return k.body == body && k.name == name; });
    return found == saved_.end() ? nullptr : &*found;
  }

  void apply_behavior(std::size_t body, std::size_t index) {
    const BehaviorDescription& now = patch_.now.bodies[body].behaviors[index];
    if (now.of_group) return;
    const BehaviorDiff& diff = patch_.diff.behaviors[body][index];
    const sim::Behavior& source = *patch_.candidate.bodies()[body]->behaviors().list()[index];
    sim::Behavior* live = bodies_[body]->behaviors().find(now.name);
    const SavedBehavior* before = find_saved(bodies_[body]->name(), now.name);
    SavedBehavior replaced;
    const bool must_replace =
        live != nullptr && (live->group() != nullptr || live->type().name != now.type || !(live->setup() == now.setup));
    if (must_replace) {
      replaced = saved_behavior(*live);
      before = &replaced;
      list_.remove(*live);
      live = nullptr;
    }
    if (live == nullptr) {
      live = add(*bodies_[body], now.type, now.name, now.setup);
      if (live == nullptr) return;
      if (before != nullptr && diff.in_old_spec) {
        copy_values(*before, *live, diff.changed);
      } else {
        return set_properties(source.id(), live->id(), *now.table, explicit_mask(now.values));
      }
    }
    set_properties(source.id(), live->id(), *now.table, diff.changed);
  }

  sim::Behavior* add(sim::Body& body, const std::string& type, const std::string& name,
                     const sim::BehaviorSetup& setup) {
    const Result<sim::Behavior*> added = list_.add(body, type, name, setup);
    added_ = true;
    if (added) return *added;
    log_warning("behavior '{}/{}' was removed: {}", body.name(), name, added.error());
    return nullptr;
  }

  // Attaches unmanaged behaviors (made in callbacks) to rebuilt bodies again.
  void restore_unmanaged() {
    for (const SavedBehavior& saved : saved_) {
      sim::Body* const body = patch_.world.find_body(saved.body);
      if (body == nullptr || body->behaviors().find(saved.name) != nullptr || in_old_spec(saved)) continue;
      if (const sim::Behavior* const behavior = add(*body, saved.type, saved.name, saved.setup))
        copy_values(saved, *behavior, 0);
    }
  }

  bool in_old_spec(const SavedBehavior& saved) const {
    return std::any_of(patch_.before.bodies.begin(), patch_.before.bodies.end(), [&](const BodyDescription& body) {
      return body.name == saved.body && std::any_of(body.behaviors.begin(), body.behaviors.end(),
                                                    [&](const BehaviorDescription& b) { return b.name == saved.name; });
    });
  }

  void apply_group(std::size_t index) {
    const GroupDescription& now = patch_.now.groups[index];
    const BehaviorDiff& diff = patch_.diff.groups[index];
    const sim::BehaviorGroup& source = *patch_.candidate.behaviors().groups()[index];
    sim::BehaviorGroup* live = list_.find_group(now.name);
    const bool must_replace = live != nullptr && (live->type().name != now.type || !(live->setup() == now.setup));
    std::uint64_t mask = diff.changed;
    if (must_replace) {
      list_.remove(*live);
      live = nullptr;
    }
    if (live == nullptr) {
      added_ = true;
      const Result<sim::BehaviorGroup*> added = list_.add_group(now.type, now.name, now.setup);
      if (!added) return log_warning("group behavior '{}' was removed: {}", now.name, added.error());
      live = *added;
      mask = explicit_mask(now.values);
    }
    set_properties(source.id(), live->id(), *now.table, mask);
  }

  // Sets the values of single members of groups.
  void apply_members(std::size_t body) {
    const std::vector<BehaviorDescription>& now = patch_.now.bodies[body].behaviors;
    for (std::size_t k = 0; k < now.size(); k++) {
      const std::uint64_t mask = patch_.diff.behaviors[body][k].changed;
      if (!now[k].of_group || mask == 0) continue;
      const sim::Behavior* const live = bodies_[body]->behaviors().find(now[k].name);
      if (live == nullptr || live->group() == nullptr) continue;
      set_properties(patch_.candidate.bodies()[body]->behaviors().list()[k]->id(), live->id(), *now[k].table, mask);
    }
  }

  const ScenePatch& patch_;
  const std::vector<sim::Body*>& bodies_;
  const std::vector<SavedBehavior>& saved_;
  sim::BehaviorList& list_;
  bool added_ = false;
};

}  // namespace

void save_behaviors(const sim::Body& body, std::vector<SavedBehavior>& saved) {
  for (const sim::Behavior* behavior : body.behaviors().list()) {
    if (behavior->group() == nullptr) saved.push_back(saved_behavior(*behavior));
  }
}

void apply_behaviors(const ScenePatch& patch, const std::vector<sim::Body*>& bodies,
                     const std::vector<SavedBehavior>& saved) {
  BehaviorPatcher(patch, bodies, saved).run();
}

}  // namespace limber::engine

// BehaviorList: adding, removing, copying, stepping.
#include "sim/behavior/behavior_list.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

// Warns about selected targets that the type doesn't use.
void warn_unused_targets(const BehaviorType& type, const Body& body, std::string_view name,
                         const BehaviorSetup& setup) {
  const bool to_parts = type.targets == BehaviorTargets::parts || type.targets == BehaviorTargets::pairs;
  const bool has_unused = to_parts ? !setup.joints.is_default() || !setup.motors.is_default()
                                   : type.targets == BehaviorTargets::motors && !setup.parts.is_default();
  if (!has_unused) return;
  log_warning("behavior '{}/{}': {} acts on {}; the selected {} are ignored", body.name(), name, type.name,
              to_parts ? "parts" : "motors", to_parts ? "joints and motors" : "parts");
}

}  // namespace

BehaviorList::BehaviorList(World& world, NodeId physics)
    : world_(world),
      group_node_(world.store().add_group(physics, "group")),
      routes_(std::make_unique<RouteList>(world.store(), physics)),
      clock_(std::make_unique<BeatClock>(world)) {
  routes_->set_transaction(world.transaction());
}

BehaviorList::~BehaviorList() { clear(); }

void BehaviorList::clear() {
  routes_->clear();
  while (!entries_.empty()) destroy_last();
}

Result<std::unique_ptr<Behavior>> BehaviorList::make(Body& body, const std::shared_ptr<const BehaviorType>& type,
                                                     const std::string& name,
                                                     const std::shared_ptr<const BehaviorSetup>& setup,
                                                     BehaviorGroup* group) {
  if (const auto fault = name_error(name)) return Error{fmt::format("behavior: {}", *fault)};
  if (!world_.store().child(body.behaviors().group(), name).null()) {
    return Error{fmt::format("body '{}' has a behavior '{}' already; names are unique", body.name(), name)};
  }
  std::unique_ptr<Behavior> behavior = type->make();
  if (const Result<void> attached = behavior->attach(body, type, setup, group); !attached)
    return Error{attached.error()};
  behavior->add_node(name);
  return behavior;
}

Result<Behavior*> BehaviorList::add(Body& body, std::string_view type_name, const std::string& name,
                                    BehaviorSetup setup) {
  const Result<std::shared_ptr<const BehaviorType>> type = types_.require(type_name);
  if (!type) return Error{type.error()};
  if ((*type)->is_group) {
    return Error{fmt::format("'{}' acts on several bodies: attach it with sim:add_group_behavior", (*type)->name)};
  }
  warn_unused_targets(**type, body, name, setup);
  auto shared = std::make_shared<const BehaviorSetup>(std::move(setup));
  Result<std::unique_ptr<Behavior>> behavior = make(body, *type, name, shared, nullptr);
  if (!behavior) return Error{behavior.error()};
  record_entry_count();
  entries_.push_back({std::move(*behavior), nullptr});
  return entries_.back().single.get();
}

Result<BehaviorGroup*> BehaviorList::add_group(std::string_view type_name, std::string name, GroupSetup setup) {
  const Result<std::shared_ptr<const BehaviorType>> type = types_.require(type_name);
  if (!type) return Error{type.error()};
  if (!(*type)->is_group) {
    return Error{fmt::format("'{}' acts on one body: attach it with body:add_behavior", (*type)->name)};
  }
  if (const auto fault = name_error(name)) return Error{fmt::format("group behavior: {}", *fault)};
  if (!world_.store().child(group_node_, name).null()) {
    return Error{fmt::format("there is a group behavior '{}' already; names are unique", name)};
  }
  auto group = std::make_unique<BehaviorGroup>(world_, group_node_, std::move(name), *type, std::move(setup));
  Result<void> result = group->check_names();
  if (result) result = group->update_members();
  if (!result) {
    const std::string& text = result.error();
    while (!group->members().empty()) destroy(*group->members().back());
    return Error{text};
  }
  record_entry_count();
  entries_.push_back({nullptr, std::move(group)});
  return entries_.back().group.get();
}

// Logs the number of entries, so that a guarded call that fails removes those that it added.
void BehaviorList::record_entry_count() {
  if (!world_.transaction().active()) return;
  const auto rollback = [](void* list, std::size_t count) {
    auto& self = *static_cast<BehaviorList*>(list);
    while (self.entries_.size() > count) self.destroy_last();
  };
  world_.transaction().record(rollback, this, entries_.size());
}

void BehaviorList::remove(Behavior& behavior) {
  world_.transaction().active() ? transaction_.hide(behavior) : destroy(behavior);
}

void BehaviorList::remove(BehaviorGroup& group) {
  world_.transaction().active() ? transaction_.hide(group) : destroy_group(group);
}

void BehaviorList::destroy_last() {
  const StepEntry& last = entries_.back();
  if (last.group != nullptr) {
    destroy_group(*last.group);
  } else {
    destroy(*last.single);
  }
}

// Removes an entry, searching from the end, since usually the newest one is removed first. While behaviors are stepped
// an empty entry stays, so that the indices of the others don't change.
template <class Predicate>
RemovedBehavior BehaviorList::extract_last(Predicate predicate) {
  const auto at = std::find_if(entries_.rbegin(), entries_.rend(), predicate).base() - 1;
  RemovedBehavior removed{std::move(at->single), std::move(at->group)};
  removed.index = static_cast<std::size_t>(at - entries_.begin());
  if (!stepping_) entries_.erase(at);
  return removed;
}

RemovedBehavior BehaviorList::extract(Behavior& behavior) {
  BehaviorGroup* const group = behavior.group();
  RemovedBehavior removed = group != nullptr
                                ? group->remove_member(behavior)
                                : extract_last([&](const StepEntry& e) { return e.single.get() == &behavior; });
  removed.index_on_body = behavior.body().behaviors().remove(behavior);
  return removed;
}

RemovedBehavior BehaviorList::extract(BehaviorGroup& group) {
  return extract_last([&](const StepEntry& e) { return e.group.get() == &group; });
}

void BehaviorList::insert(RemovedBehavior removed) {
  if (removed.behavior != nullptr) {
    Behavior& behavior = *removed.behavior;
    behavior.body().behaviors().insert(removed.index_on_body, behavior);
    if (BehaviorGroup* const group = behavior.group()) return group->insert_member(std::move(removed));
  }
  if (!stepping_) entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(removed.index), StepEntry{});
  entries_[removed.index] = {std::move(removed.behavior), std::move(removed.group)};
}

void BehaviorList::retire(RemovedBehavior removed) {
  if (removed.behavior != nullptr) removed.behavior->detach();
  if (stepping_) retired_.push_back(std::move(removed));
}

void BehaviorList::destroy(Behavior& behavior) {
  world_.store().remove(behavior.id());
  retire(extract(behavior));
}

void BehaviorList::destroy_group(BehaviorGroup& group) {
  while (!group.members().empty()) destroy(*group.members().back());
  world_.store().remove(group.id());
  retire(extract(group));
}

BehaviorGroup* BehaviorList::find_group(std::string_view name) const {
  const NodeId id = world_.store().child(group_node_, name);
  return id.null() ? nullptr : static_cast<BehaviorGroup*>(world_.store().object(id));
}

std::vector<BehaviorGroup*> BehaviorList::groups() const {
  std::vector<BehaviorGroup*> list;
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr) list.push_back(entry.group.get());
  }
  return list;
}

std::size_t BehaviorList::suspended_count() const {
  std::size_t count = 0;
  const auto count_suspended = [&](const std::unique_ptr<Behavior>& behavior) {
    if (behavior != nullptr && !behavior->error().empty()) count++;
  };
  for (const StepEntry& entry : entries_) {
    count_suspended(entry.single);
    if (entry.group != nullptr) std::ranges::for_each(entry.group->members(), count_suspended);
  }
  return count;
}

void BehaviorList::copy_values(const Behavior& from, Behavior& to) {
  Store& store = world_.store();
  const double* values = std::as_const(store).persistent_block(from.id());
  std::copy_n(values, from.type().table->persistent_width(), store.persistent_block(to.id()));
  store.mark_explicitly_set(to.id(), store.explicitly_set(from.id()));
}

void BehaviorList::copy(const Body& source, Body& copy) {
  if (&source.world() != &world_) return;  // types and groups belong to one world
  for (std::size_t i = 0; i < source.behaviors().list().size(); i++) {
    const Behavior& from = *source.behaviors().list()[i];
    Result<std::unique_ptr<Behavior>> copied =
        make(copy, from.shared_type(), from.name(), from.shared_setup(), from.group());
    if (!copied) continue;  // can't happen: the copy has the same parts under the same names
    copy_values(from, **copied);
    if (from.group() == nullptr) {
      entries_.push_back({std::move(*copied), nullptr});
    } else {
      from.group()->append_member(std::move(*copied));
    }
  }
}

void BehaviorList::on_body_destroyed(Body& body) {
  while (!body.behaviors().list().empty()) destroy(*body.behaviors().list().back());
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr) entry.group->remove_body(body);
  }
}

void BehaviorList::on_body_reset(Body& body) {
  for (Behavior* behavior : body.behaviors().list()) behavior->restart();
}

std::shared_ptr<NeighborSet> BehaviorList::neighbor_set(std::vector<Part*> parts) {
  std::erase_if(neighbor_sets_, [](const auto& known) { return known.expired(); });
  for (const auto& cached : neighbor_sets_) {
    if (std::shared_ptr<NeighborSet> set = cached.lock(); set->consists_of(parts)) return set;
  }
  auto set = std::make_shared<NeighborSet>(world_, std::move(parts));
  neighbor_sets_.push_back(set);
  return set;
}

void BehaviorList::update_members() {
  if (stepping_) return;
  const std::uint64_t structure = world_.store().structure_version();
  if (std::exchange(structure_version_, structure) == structure) return;
  for (const StepEntry& entry : entries_) {
    if (entry.group == nullptr) continue;
    if (const Result<void> updated = entry.group->update_members(); !updated) {
      log_warning("group behavior '{}': {}", entry.group->name(), updated.error());
    }
  }
  for (const auto& body : world_.bodies()) {
    for (Behavior* behavior : body->behaviors().list()) behavior->update_targets();
  }
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr) entry.group->invalidate_layout();
  }
  structure_version_ = world_.store().structure_version();  // includes members that were just added
}

Result<void> BehaviorList::check_can_move() const {
  if (!stepping_) return {};
  return Error{"behaviors can't be moved while they are stepped; move them from a scene's callback"};
}

void BehaviorList::step(double dt) {
  routes_->apply(dt);
  update_members();
  step_count_++;
  stepping_ = true;
  double last_time = system::clock_seconds();
  for (std::size_t i = 0; i < entries_.size(); i++) {
    if (BehaviorGroup* group = entries_[i].group.get()) {
      group->step(dt);
      last_time = system::clock_seconds();
      continue;
    }
    Behavior* const behavior = entries_[i].single.get();
    if (behavior == nullptr) continue;  // removed in this step
    if (behavior->runs()) behavior->prepare();
    if (behavior->runs()) behavior->step(dt);
    const double now = system::clock_seconds();
    behavior->set_step_seconds(now - std::exchange(last_time, now));
  }
  stepping_ = false;
  if (retired_.empty()) return;
  retired_.clear();
  std::erase_if(entries_, [](const StepEntry& e) { return e.single == nullptr && e.group == nullptr; });
}

void BehaviorList::report_fault(const Behavior& behavior) const {
  if (on_fault_) return on_fault_(behavior);
  log_error("behavior '{}/{}': {}", behavior.body().name(), behavior.name(), behavior.error());
}

void BehaviorList::replace_instances(std::string_view type_name) {
  const std::shared_ptr<const BehaviorType> type = types_.find(type_name);
  if (type == nullptr) return;
  for (StepEntry& entry : entries_) {
    if (entry.group != nullptr) {
      entry.group->replace_type(type);
    } else if (entry.single != nullptr && type->replaces(entry.single->type())) {
      entry.single = entry.single->make_replacement(type);
    }
  }
}

void BehaviorList::serialize(Archive& archive) {
  routes_->serialize(archive);
  clock_->serialize(archive);
  for (const StepEntry& entry : entries_) {
    if (entry.single != nullptr) entry.single->serialize_all(archive);
    if (entry.group != nullptr) entry.group->serialize(archive);
  }
}

std::uint64_t BehaviorList::state_hash(std::uint64_t hash) const {
  hash = clock_->state_hash(routes_->state_hash(hash));
  for (const StepEntry& entry : entries_) {
    if (entry.group != nullptr) hash = entry.group->state_hash(hash);
  }
  return hash;
}

}  // namespace limber::sim

// BehaviorList: making, removing, copying, stepping.
#include "sim/behavior_list.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "sim/world.h"

namespace limber {

namespace {

// what a type leaves aside of what the scene says is said to the scene
void say_left_aside(const BehaviorType& type, const Body& body, std::string_view name, const BehaviorSetup& setup) {
  const bool to_parts = type.targets == BehaviorTargets::parts || type.targets == BehaviorTargets::pairs;
  const bool needless = to_parts ? !setup.joints.left_out() || !setup.motors.left_out()
                                 : type.targets == BehaviorTargets::motors && !setup.parts.left_out();
  if (!needless) return;
  log_warning("behavior '{}/{}': {} acts on {}; the {} that are said have no effect", body.name(), name, type.name,
              to_parts ? "parts" : "motors", to_parts ? "joints and motors" : "parts");
}

// what came last goes first, mostly
template <class T, class Is>
auto from_behind(std::vector<T>& list, Is is) {
  return std::find_if(list.rbegin(), list.rend(), is).base() - 1;
}

}  // namespace

BehaviorList::BehaviorList(World& world, NodeId physics)
    : world_(world), group_node_(world.store().add_group(physics, "group")) {}

BehaviorList::~BehaviorList() { clear(); }

void BehaviorList::clear() {
  while (!entries_.empty()) drop_last();
}

Result<std::unique_ptr<Behavior>> BehaviorList::make(Body& body, const std::shared_ptr<const BehaviorType>& type,
                                                     const std::string& name,
                                                     const std::shared_ptr<const BehaviorSetup>& setup,
                                                     BehaviorGroup* group) {
  Store& store = world_.store();
  const NodeId node = body.behavior_group_;
  if (const auto fault = name_fault(name)) return Error{fmt::format("behavior: {}", *fault)};
  if (!store.child(node, name).null()) {
    return Error{fmt::format("body '{}' has a behavior '{}' already; names are unique", body.name(), name)};
  }
  std::unique_ptr<Behavior> behavior = type->make();
  behavior->attach(body, NodeId{}, type, setup, group);
  if (const Result<void> resolved = behavior->resolve(); !resolved) return Error{resolved.error()};
  behavior->id_ = store.add(*type->table, node, name, behavior.get());
  body.behaviors_.push_back(behavior.get());
  return behavior;
}

Result<Behavior*> BehaviorList::add(Body& body, std::string_view type_name, const std::string& name,
                                    BehaviorSetup setup) {
  const Result<std::shared_ptr<const BehaviorType>> type = types_.require(type_name);
  if (!type) return Error{type.error()};
  if ((*type)->is_group) {
    return Error{fmt::format("'{}' acts on several bodies: attach it with sim:add_group_behavior", (*type)->name)};
  }
  say_left_aside(**type, body, name, setup);
  auto shared = std::make_shared<const BehaviorSetup>(std::move(setup));
  Result<std::unique_ptr<Behavior>> behavior = make(body, *type, name, shared, nullptr);
  if (!behavior) return Error{behavior.error()};
  note_made();
  entries_.push_back({std::move(*behavior), nullptr});
  return entries_.back().single.get();
}

Result<BehaviorGroup*> BehaviorList::add_group(std::string_view type_name, std::string name, GroupSetup setup) {
  const Result<std::shared_ptr<const BehaviorType>> type = types_.require(type_name);
  if (!type) return Error{type.error()};
  if (!(*type)->is_group) {
    return Error{fmt::format("'{}' acts on one body: attach it with body:add_behavior", (*type)->name)};
  }
  if (const auto fault = name_fault(name)) return Error{fmt::format("group behavior: {}", *fault)};
  if (!world_.store().child(group_node_, name).null()) {
    return Error{fmt::format("there is a group behavior '{}' already; names are unique", name)};
  }
  std::unique_ptr<BehaviorGroup> group(
      new BehaviorGroup(world_, group_node_, std::move(name), *type, std::move(setup)));
  Result<void> good = group->names_exist();
  if (good) good = group->follow();
  if (!good) {
    const std::string& text = good.error();
    while (!group->members_.empty()) drop(*group->members_.back());
    return Error{text};
  }
  note_made();
  entries_.push_back({nullptr, std::move(group)});
  return entries_.back().group.get();
}

// what a guarded call has made goes again when it fails
void BehaviorList::note_made() {
  if (!world_.undo().active()) return;
  const auto take_back = [](void* list, std::size_t count) {
    auto& self = *static_cast<BehaviorList*>(list);
    while (self.entries_.size() > count) self.drop_last();
  };
  world_.undo().note(take_back, this, entries_.size());
}

void BehaviorList::remove(Behavior& behavior) { world_.undo().active() ? undo_.hide(behavior) : drop(behavior); }

void BehaviorList::remove_group(BehaviorGroup& group) {
  world_.undo().active() ? undo_.hide(group) : drop_group(group);
}

void BehaviorList::drop_last() {
  const Entry& last = entries_.back();
  if (last.group != nullptr) {
    drop_group(*last.group);
  } else {
    drop(*last.single);
  }
}

void BehaviorList::bury(std::unique_ptr<Behavior> behavior) {
  behavior->body_ = nullptr;
  if (stepping_) graves_.push_back(std::move(behavior));
}

void BehaviorList::bury(std::unique_ptr<BehaviorGroup> group) {
  if (stepping_) group_graves_.push_back(std::move(group));
}

// an entry that has become empty: while behaviours step its place stays, so that the others keep theirs
void BehaviorList::close_gap(std::size_t place) {
  if (!stepping_) entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(place));
}

BehaviorList::Entry& BehaviorList::open_gap(std::size_t place) {
  if (!stepping_) entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(place), Entry{});
  return entries_[place];
}

void BehaviorList::drop(Behavior& behavior) {
  std::erase(behavior.body_->behaviors_, &behavior);
  world_.store().remove(behavior.id_);
  if (BehaviorGroup* group = behavior.group_) {
    group->left_.push_back(behavior.body_->id());
    const auto at = from_behind(group->members_, [&](const auto& member) { return member.get() == &behavior; });
    bury(std::move(*at));
    group->members_.erase(at);
    group->laid_out_ = false;
    return;
  }
  const auto at = from_behind(entries_, [&](const Entry& e) { return e.single.get() == &behavior; });
  bury(std::move(at->single));
  close_gap(static_cast<std::size_t>(at - entries_.begin()));
}

void BehaviorList::drop_group(BehaviorGroup& group) {
  while (!group.members_.empty()) drop(*group.members_.back());
  world_.store().remove(group.id_);
  const auto at = from_behind(entries_, [&](const Entry& e) { return e.group.get() == &group; });
  bury(std::move(at->group));
  close_gap(static_cast<std::size_t>(at - entries_.begin()));
}

BehaviorGroup* BehaviorList::find_group(std::string_view name) const {
  const NodeId id = world_.store().child(group_node_, name);
  return id.null() ? nullptr : static_cast<BehaviorGroup*>(world_.store().thing(id));
}

std::vector<BehaviorGroup*> BehaviorList::groups() const {
  std::vector<BehaviorGroup*> list;
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) list.push_back(entry.group.get());
  }
  return list;
}

std::size_t BehaviorList::suspended() const {
  std::size_t count = 0;
  const auto look_at = [&](const std::unique_ptr<Behavior>& behavior) {
    if (behavior != nullptr && !behavior->error().empty()) count++;
  };
  for (const Entry& entry : entries_) {
    look_at(entry.single);
    if (entry.group != nullptr) std::ranges::for_each(entry.group->members(), look_at);
  }
  return count;
}

void BehaviorList::copy_values(const Behavior& from, Behavior& to) {
  Store& store = world_.store();
  const double* values = std::as_const(store).kept_block(from.id_);
  std::copy_n(values, from.type_->table->kept_width(), store.kept_block(to.id_));
  store.say(to.id_, store.said(from.id_));  // a copy of what was said
}

void BehaviorList::copy(const Body& source, Body& copy) {
  if (&source.world() != &world_) return;  // types and groups are its world's
  for (std::size_t i = 0; i < source.behaviors_.size(); i++) {
    const Behavior& from = *source.behaviors_[i];
    Result<std::unique_ptr<Behavior>> made = make(copy, from.type_, from.name(), from.setup_, from.group_);
    if (!made) continue;  // the copy has the same parts under the same names
    copy_values(from, **made);
    if (from.group_ == nullptr) {
      entries_.push_back({std::move(*made), nullptr});
      continue;
    }
    from.group_->members_.push_back(std::move(*made));
  }
}

void BehaviorList::body_gone(Body& body) {
  while (!body.behaviors_.empty()) drop(*body.behaviors_.back());
  for (const Entry& entry : entries_) {
    if (entry.group == nullptr) continue;
    std::erase(entry.group->left_, body.id());
    entry.group->neighbors_->forget(body);
  }
}

void BehaviorList::body_reset(Body& body) {
  for (Behavior* behavior : body.behaviors_) behavior->restart();
}

std::shared_ptr<NeighborSet> BehaviorList::neighbor_set(std::vector<Part*> parts) {
  std::erase_if(neighbor_sets_, [](const auto& known) { return known.expired(); });
  for (const auto& known : neighbor_sets_) {
    if (std::shared_ptr<NeighborSet> set = known.lock(); set->holds(parts)) return set;
  }
  auto set = std::make_shared<NeighborSet>(world_, std::move(parts));
  neighbor_sets_.push_back(set);
  return set;
}

void BehaviorList::follow_bodies() {
  if (stepping_) return;
  const std::uint64_t structure = world_.store().structure_version();
  if (std::exchange(structure_, structure) == structure) return;
  for (const Entry& entry : entries_) {
    if (entry.group == nullptr) continue;
    if (const Result<void> followed = entry.group->follow(); !followed) {
      log_warning("group behavior '{}': {}", entry.group->name(), followed.error());
    }
  }
  for (const auto& body : world_.bodies()) {
    for (Behavior* behavior : body->behaviors_) {
      if (std::exchange(behavior->resolved_at_, body->structure_) == body->structure_) continue;
      if (const Result<void> resolved = behavior->resolve(); !resolved) behavior->fail({resolved.error(), "", 0});
    }
  }
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) entry.group->laid_out_ = false;
  }
  structure_ = world_.store().structure_version();  // newcomers are followed already
}

std::string BehaviorList::key_of(const Entry& entry) {
  if (entry.group != nullptr) return "/" + entry.group->name();
  return entry.single->body().name() + "/" + entry.single->name();
}

std::vector<std::string> BehaviorList::order() const {
  std::vector<std::string> keys;
  keys.reserve(entries_.size());
  for (const Entry& entry : entries_) keys.push_back(key_of(entry));
  return keys;
}

void BehaviorList::bring_into(const std::vector<std::string>& order) {
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t i = 0; i < order.size(); i++) places[order[i]] = i;
  std::vector<std::pair<std::size_t, Entry>> placed;
  for (Entry& entry : entries_) {
    const auto found = places.find(key_of(entry));
    placed.emplace_back(found == places.end() ? order.size() : found->second, std::move(entry));
  }
  std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  entries_.clear();
  for (auto& [place, entry] : placed) entries_.push_back(std::move(entry));
  world_.store().note_structure();
}

void BehaviorList::step(double dt) {
  follow_bodies();
  turn_++;
  stepping_ = true;
  double before = system::clock_seconds();
  for (std::size_t i = 0; i < entries_.size(); i++) {
    if (BehaviorGroup* group = entries_[i].group.get()) {
      group->step(dt);
      before = system::clock_seconds();
      continue;
    }
    Behavior* const behavior = entries_[i].single.get();
    if (behavior == nullptr) continue;  // removed in this step
    if (behavior->runs()) behavior->prepare();
    if (behavior->runs()) behavior->step(dt);
    const double now = system::clock_seconds();
    behavior->seconds_ = now - std::exchange(before, now);
  }
  stepping_ = false;
  if (graves_.empty() && group_graves_.empty()) return;
  graves_.clear();
  group_graves_.clear();
  std::erase_if(entries_, [](const Entry& e) { return e.single == nullptr && e.group == nullptr; });
}

void BehaviorList::say_fault(const Behavior& behavior) const {
  if (on_fault_) return on_fault_(behavior);
  log_error("behavior '{}/{}': {}", behavior.body().name(), behavior.name(), behavior.error());
}

void BehaviorList::renew(std::string_view type_name) {
  const std::shared_ptr<const BehaviorType> type = types_.find(type_name);
  if (type == nullptr) return;
  const auto outdated = [&](const Behavior& b) { return b.type_->name == type->name && b.type_ != type; };
  for (Entry& entry : entries_) {
    if (entry.single != nullptr && outdated(*entry.single)) entry.single = renewed(*entry.single, type);
    if (entry.group == nullptr) continue;
    for (auto& member : entry.group->members_) {
      if (!outdated(*member)) continue;
      member = renewed(*member, type);
      entry.group->laid_out_ = false;
    }
    if (entry.group->type_->name == type->name && entry.group->type_ != type) entry.group->renew(type);
  }
}

std::unique_ptr<Behavior> BehaviorList::renewed(Behavior& before, const std::shared_ptr<const BehaviorType>& type) {
  std::unique_ptr<Behavior> behavior = type->make();
  behavior->attach(*before.body_, before.id_, type, before.setup_, before.group_);
  behavior->parts_ = before.parts_;
  behavior->joints_ = before.joints_;
  behavior->motors_ = before.motors_;
  behavior->random_ = before.random_;
  behavior->seeded_with_ = before.seeded_with_;
  behavior->fresh_ = before.fresh_;
  behavior->id_ = world_.store().retable(before.id_, *type->table, behavior.get());
  for (const Behavior::Beat& beat : before.beats_) {
    if (const Row* row = type->table->find(beat.row->name)) {
      behavior->beats_.push_back(beat);
      behavior->beats_.back().row = row;
    }
  }
  std::replace(before.body_->behaviors_.begin(), before.body_->behaviors_.end(), &before, behavior.get());
  behavior->take_over(before);
  return behavior;
}

std::uint64_t BehaviorList::state_hash(std::uint64_t hash) const {
  for (const Entry& entry : entries_) {
    if (entry.group != nullptr) hash = entry.group->state_hash(hash);
  }
  return hash;
}

}  // namespace limber

// BehaviorGroup: updates members and neighbors as bodies are added and removed, and steps the members.
#include "sim/behavior/behavior_group.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log/log.h"
#include "base/memory/archive.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "properties/values_hash.h"
#include "sim/behavior/behavior_list.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

bool has_selected_part(const Body& body, const Selection& selection) {
  const auto parts = body.parts();
  return std::any_of(parts.begin(), parts.end(),
                     [&](const auto& part) { return selection.selects(part->name(), !part->is_static()); });
}

Error part_not_found(const Body& body, std::string_view word) {
  std::vector<std::string_view> names;
  for (const auto& part : body.parts()) names.push_back(part->name());
  return Error{fmt::format("body '{}' has no part '{}'{}", body.name(), printable(word), name_hint(word, names))};
}

}  // namespace

void BehaviorGroup::set_on_members(void* object, const Property& property) {
  const BehaviorGroup& group = *static_cast<BehaviorGroup*>(object);
  Store& store = group.world_.store();
  const Property& member_property = group.type_->table->property(property.index);
  std::array<double, 4> values{};
  store.get(group.id_, property, values.data());
  for (const auto& member : group.members_) {
    (void)store.set(member->id(), member_property,
                    {values.data(), member_property.width});  // validated by the group's own property
  }
}

BehaviorGroup::BehaviorGroup(World& world, NodeId parent, std::string name, std::shared_ptr<const BehaviorType> type,
                             GroupSetup setup)
    : world_(world),
      id_(world.store().add(*type->group_table, parent, std::move(name), this)),
      type_(std::move(type)),
      setup_(std::move(setup)) {
  BehaviorSetup member_setup;
  member_setup.parts = setup_.parts;
  member_setup_ = std::make_shared<const BehaviorSetup>(std::move(member_setup));
}

BehaviorGroup::~BehaviorGroup() { world_.store().remove(id_); }

const std::string& BehaviorGroup::name() const { return world_.store().name(id_); }

double BehaviorGroup::seconds_per_member() const {
  return members_.empty() ? 0 : step_seconds_ / static_cast<double>(members_.size());
}

Behavior* BehaviorGroup::member_of(const Body& body) const {
  const auto all = body.behaviors().list();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Behavior* b) { return b->group() == this; });
  return at == all.end() ? nullptr : *at;
}

bool BehaviorGroup::includes(const Body& body) const {
  if (std::find(removed_bodies_.begin(), removed_bodies_.end(), body.id()) != removed_bodies_.end()) return false;
  return setup_.bodies.selects(body.name()) || member_of(body) != nullptr;
}

const Selection& BehaviorGroup::neighbor_selection() const {
  return setup_.neighbor_parts.is_default() ? setup_.parts : setup_.neighbor_parts;
}

Result<void> BehaviorGroup::check_names() const {
  const std::vector<std::string_view> bodies = world_.body_names();
  if (const std::string_view missing = setup_.bodies.first_missing(bodies); !missing.empty()) {
    return Error{fmt::format("there is no body '{}'{}", printable(missing), name_hint(missing, bodies))};
  }
  std::vector<const Body*> included;
  for (const auto& body : world_.bodies()) {
    if (includes(*body)) included.push_back(body.get());
  }
  for (const Selection* selection : {&setup_.parts, &neighbor_selection()}) {
    for (const std::string& word : selection->words()) {
      if (!Selection({word}).has_names()) continue;
      bool found = included.empty();
      for (const Body* body : included) {
        const bool has = body->find_part(word) != nullptr;
        const auto& named = setup_.bodies.words();
        const bool required =
            selection == &setup_.parts && std::find(named.begin(), named.end(), body->name()) != named.end();
        found = found || has;
        if (!has && required) return part_not_found(*body, word);
      }
      if (!found) return part_not_found(*included.front(), word);
    }
  }
  return {};
}

Result<void> BehaviorGroup::update_members() {
  Result<void> result;
  std::vector<Part*> neighbor_parts;
  const Selection& selection = neighbor_selection();
  for (const auto& body : world_.bodies()) {
    if (!includes(*body)) continue;
    for (const auto& part : body->parts()) {
      if (selection.selects(part->name(), !part->is_static())) neighbor_parts.push_back(part.get());
    }
    if (member_of(*body) != nullptr || !has_selected_part(*body, setup_.parts)) continue;
    if (Result<void> added = add_member(*body); !added && result) result = std::move(added);
  }
  if (neighbors_ == nullptr || !neighbors_->consists_of(neighbor_parts))
    neighbors_ = world_.behaviors().neighbor_set(std::move(neighbor_parts));
  return result;
}

Result<void> BehaviorGroup::add_member(Body& body) {
  Result<std::unique_ptr<Behavior>> member = world_.behaviors().make(body, type_, name(), member_setup_, this);
  if (!member) return Error{member.error()};
  Store& store = world_.store();
  const std::size_t width = type_->table->persistent_width();
  std::copy_n(std::as_const(store).persistent_block(id_), width, store.persistent_block((*member)->id()));
  append_member(std::move(*member));
  // undo, unless it has been removed with its group
  constexpr unsigned kHalf = 32;
  const NodeId added = members_.back()->id();
  world_.transaction().record(
      [](void* owner, std::size_t value) {
        const World& world = *static_cast<World*>(owner);
        const NodeId id{static_cast<std::uint32_t>(value >> kHalf), static_cast<std::uint32_t>(value)};
        if (!world.store().alive(id)) return;
        auto& behavior = *static_cast<Behavior*>(world.store().object(id));
        BehaviorGroup& group = *behavior.group();
        behavior.world().behaviors().remove(behavior);
        group.removed_bodies_.pop_back();  // not an explicit removal
      },
      &world_, std::size_t{added.slot} << kHalf | added.generation);
  return {};
}

RemovedBehavior BehaviorGroup::remove_member(const Behavior& member) {
  removed_bodies_.push_back(member.body().id());
  layout_valid_ = false;
  // searches from the end, since usually the newest member is removed first
  const auto is_member = [&](const std::unique_ptr<Behavior>& each) { return each.get() == &member; };
  const auto at = std::find_if(members_.rbegin(), members_.rend(), is_member).base() - 1;
  RemovedBehavior removed;
  removed.index = static_cast<std::size_t>(at - members_.begin());
  removed.behavior = std::move(*at);
  members_.erase(at);
  return removed;
}

void BehaviorGroup::insert_member(RemovedBehavior removed) {
  removed_bodies_.pop_back();
  layout_valid_ = false;
  members_.insert(members_.begin() + static_cast<std::ptrdiff_t>(removed.index), std::move(removed.behavior));
}

void BehaviorGroup::remove_body(const Body& body) {
  std::erase(removed_bodies_, body.id());
  neighbors_->remove_body(body);
}

void BehaviorGroup::replace_type(const std::shared_ptr<const BehaviorType>& type) {
  for (auto& member : members_) {
    if (!type->replaces(member->type())) continue;
    member = member->make_replacement(type);
    layout_valid_ = false;
  }
  if (!type->replaces(*type_)) return;
  id_ = world_.store().change_table(id_, *type->group_table, this);
  type_ = type;
}

void BehaviorGroup::build_layout() {
  static const std::uint32_t enabled = Body::table().at("enabled").offset;
  static const std::uint32_t mass = Part::table().at("mass").offset;
  layout_valid_ = true;
  members_version_++;
  needs_preparation_ = true;
  const NodeSlot* const slots = world_.store().view()->slots;
  const std::uint32_t active = type_->table->property(0).width;
  layout_ = {};
  for (const auto& member : members_) {
    layout_.values.push_back(slots[member->id().slot].persistent + active);
    layout_.enabled.push_back(slots[member->body().id().slot].transient + enabled);
    layout_.first_part.push_back(static_cast<std::uint32_t>(layout_.parts.size()));
    for (Part* part : member->parts()) {
      layout_.parts.push_back(part);
      const Vec3 inertia = part->geometry()->unit_inertia;
      layout_.min_inertia.push_back(std::min({inertia.x, inertia.y, inertia.z}));
      layout_.accumulator.push_back(part->accumulator_index());
      layout_.mass.push_back(slots[part->id().slot].persistent + mass);
    }
  }
  layout_.first_part.push_back(static_cast<std::uint32_t>(layout_.parts.size()));
}

// Prepares each member individually: the slow path, for a step in which a member starts or has an error.
void BehaviorGroup::prepare_members() {
  needs_preparation_ = false;
  members_version_++;
  for (std::size_t i = 0; i < members_.size(); i++) {
    Behavior& member = *members_[i];
    if (member.runs()) member.prepare();
    needs_preparation_ = needs_preparation_ || member.needs_preparation();
  }
}

void BehaviorGroup::step(double dt) {
  const double start = system::clock_seconds();
  if (!layout_valid_) build_layout();
  const std::uint64_t seed = world_.seed();
  if (needs_preparation_ || std::exchange(last_seed_, seed) != seed) prepare_members();
  running_.clear();
  running_indices_.clear();
  const double* const persistent = world_.store().persistent_values().data();
  const double* const transient = world_.store().transient_values().data();
  constexpr std::uint32_t kMembersAhead = 12;  // prefetch: these are no longer in the cache after a tick of physics
  for (std::uint32_t i = 0; i < layout_.values.size(); i++) {
    if (i + kMembersAhead < layout_.values.size()) {
      __builtin_prefetch(persistent + layout_.values[i + kMembersAhead] - 1);
      __builtin_prefetch(transient + layout_.enabled[i + kMembersAhead]);
    }
    if (persistent[layout_.values[i] - 1] == 0 || transient[layout_.enabled[i]] == 0) continue;
    if (needs_preparation_ && !members_[i]->runs()) continue;
    running_.push_back(members_[i].get());
    running_indices_.push_back(i);
  }
  if (!running_.empty()) running_.front()->step_group(running_, dt);
  step_seconds_ = system::clock_seconds() - start;
}

void BehaviorGroup::serialize(Archive& archive) {
  for (const auto& member : members_) member->serialize_all(archive);
  if (archive.loading()) layout_valid_ = false;
}

std::uint64_t BehaviorGroup::state_hash(std::uint64_t hash) const {
  NumberHash numbers(hash_bytes(name(), hash));
  numbers.add_word(persistent_hash(world_.store(), id_));
  return numbers.value();
}

}  // namespace limber::sim

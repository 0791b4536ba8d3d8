// BehaviorGroup: members and neighbours as bodies come and go.
#include "sim/behavior_group.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/clock_seconds.h"
#include "base/log.h"
#include "base/text.h"
#include "sim/behavior_list.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

bool has_any(const Body& body, const Selection& selection) {
  const auto parts = body.parts();
  return std::any_of(parts.begin(), parts.end(),
                     [&](const auto& part) { return selection.means(part->name(), !part->is_static()); });
}

Error no_part(const Body& body, std::string_view word) {
  std::vector<std::string_view> names;
  for (const auto& part : body.parts()) names.push_back(part->name());
  return Error{fmt::format("body '{}' has no part '{}'{}", body.name(), printable(word), name_hint(word, names))};
}

}  // namespace

std::vector<Row> BehaviorGroup::common_rows() {
  Row on = boolean("active", true, "Whether its members act; setting it sets theirs.");
  on.written = &BehaviorGroup::hand_on;
  return {std::move(on),
          view<&BehaviorGroup::read_time>(
              readout(number("time", "µs", 0, 0, kUnbounded, "What the last tick spent on all of it."))),
          act<&BehaviorGroup::act_remove>(action("remove", 0, 0, "Takes it away from all its members."))};
}

void BehaviorGroup::hand_on(void* thing, const Row& row) {
  const BehaviorGroup& group = *static_cast<BehaviorGroup*>(thing);
  Store& store = group.world_.store();
  const Row& own = group.type_->table->row(row.index);
  std::array<double, 4> values{};
  store.get(group.id_, row, values.data());
  for (const auto& member : group.members_) {
    (void)store.set(member->id(), own, {values.data(), own.width});  // the group's own row has checked it
  }
}

BehaviorGroup::BehaviorGroup(World& world, NodeId parent, std::string name, std::shared_ptr<const BehaviorType> type,
                             GroupSetup setup)
    : world_(world),
      id_(world.store().add(*type->group_table, parent, std::move(name), this)),
      type_(std::move(type)),
      setup_(std::move(setup)) {
  BehaviorSetup of_members;
  of_members.parts = setup_.parts;
  member_setup_ = std::make_shared<const BehaviorSetup>(std::move(of_members));
}

BehaviorGroup::~BehaviorGroup() { world_.store().remove(id_); }

const std::string& BehaviorGroup::name() const { return world_.store().name(id_); }

double BehaviorGroup::seconds_a_member() const {
  return members_.empty() ? 0 : seconds_ / static_cast<double>(members_.size());
}

void BehaviorGroup::read_time(double* out) const { out[0] = 1e6 * seconds_; }

Result<void> BehaviorGroup::act_remove(std::span<const double>) {
  world_.behaviors().remove_group(*this);
  return {};
}

Behavior* BehaviorGroup::member_of(const Body& body) const {
  const auto all = body.behaviors();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Behavior* b) { return b->group() == this; });
  return at == all.end() ? nullptr : *at;
}

bool BehaviorGroup::means(const Body& body) const {
  if (std::find(left_.begin(), left_.end(), body.id()) != left_.end()) return false;
  return setup_.bodies.means(body.name()) || member_of(body) != nullptr;
}

const Selection& BehaviorGroup::neighbor_selection() const {
  return setup_.neighbor_parts.left_out() ? setup_.parts : setup_.neighbor_parts;
}

// every named body exists and has every part that is named; a part's name that bodies by pattern share is in one of
// them
Result<void> BehaviorGroup::names_exist() const {
  const std::vector<std::string_view> bodies = world_.body_names();
  if (const std::string_view missing = setup_.bodies.missing(bodies); !missing.empty()) {
    return Error{fmt::format("there is no body '{}'{}", printable(missing), name_hint(missing, bodies))};
  }
  std::vector<const Body*> meant;
  for (const auto& body : world_.bodies()) {
    if (means(*body)) meant.push_back(body.get());
  }
  for (const Selection* selection : {&setup_.parts, &neighbor_selection()}) {
    for (const std::string& word : selection->words()) {
      if (!Selection({word}).has_names()) continue;
      bool anywhere = meant.empty();
      for (const Body* body : meant) {
        const bool has = body->find_part(word) != nullptr;
        const auto& named = setup_.bodies.words();
        const bool must =
            selection == &setup_.parts && std::find(named.begin(), named.end(), body->name()) != named.end();
        anywhere = anywhere || has;
        if (!has && must) return no_part(*body, word);
      }
      if (!anywhere) return no_part(*meant.front(), word);
    }
  }
  return {};
}

Result<void> BehaviorGroup::follow() {
  neighbor_parts_.clear();
  const Selection& neighbors = neighbor_selection();
  for (const auto& body : world_.bodies()) {
    if (!means(*body)) continue;
    for (const auto& part : body->parts()) {
      if (neighbors.means(part->name(), !part->is_static())) neighbor_parts_.push_back(part.get());
    }
    if (member_of(*body) != nullptr || !has_any(*body, setup_.parts)) continue;
    if (const Result<Behavior*> member = join(*body); !member) return Error{member.error()};
  }
  return {};
}

Result<Behavior*> BehaviorGroup::join(Body& body) {
  Result<std::unique_ptr<Behavior>> member = world_.behaviors().make(body, type_, name(), member_setup_, this);
  if (!member) return Error{member.error()};
  Store& store = world_.store();
  const std::size_t width = type_->table->kept_width();
  std::copy_n(std::as_const(store).kept_block(id_), width, store.kept_block((*member)->id()));
  members_.push_back(std::move(*member));
  return members_.back().get();
}

void BehaviorGroup::renew(const std::shared_ptr<const BehaviorType>& type) {
  id_ = world_.store().retable(id_, *type->group_table, this);
  type_ = type;
}

void BehaviorGroup::forget_parts_of(const Body& body) {
  std::erase_if(neighbor_parts_, [&](const Part* part) { return &part->body() == &body; });
}

void BehaviorGroup::step(double dt) {
  const double start = clock_seconds();
  running_.clear();
  for (std::size_t i = 0; i < members_.size(); i++) {
    Behavior& member = *members_[i];
    if (!member.runs()) continue;
    member.prepare();
    if (member.runs()) running_.push_back(&member);
  }
  if (!running_.empty()) running_.front()->step_group(running_, dt);
  seconds_ = clock_seconds() - start;
}

std::uint64_t BehaviorGroup::state_hash(std::uint64_t hash) const {
  const auto* kept = reinterpret_cast<const char*>(std::as_const(world_.store()).kept_block(id_));
  hash = hash_bytes(name(), hash);
  return hash_bytes({kept, type_->group_table->kept_width() * sizeof(double)}, hash);
}

}  // namespace limber

// BehaviorGroup: members and neighbours as bodies come and go.
#include "sim/behavior_group.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "params/values_hash.h"
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
          act<&BehaviorGroup::act_remove>(action("remove", 0, 0, "Takes it away from all its members.")),
          refuse<&BehaviorGroup::refuse_place>(state(view<&BehaviorGroup::read_place, &BehaviorGroup::write_place>(
              integer("place", 1, 1, 1e6, "Which one it is, from 1, of all names of behaviours."))))};
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

void BehaviorGroup::read_place(double* out) const { out[0] = static_cast<double>(world_.behaviors().place(*this)); }

void BehaviorGroup::write_place(const double* in) { world_.behaviors().put_at(*this, static_cast<std::size_t>(in[0])); }

Result<void> BehaviorGroup::refuse_place(const double*) const { return world_.behaviors().may_move(); }

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
  Result<void> all_joined;
  std::vector<Part*> near;
  const Selection& neighbors = neighbor_selection();
  for (const auto& body : world_.bodies()) {
    if (!means(*body)) continue;
    for (const auto& part : body->parts()) {
      if (neighbors.means(part->name(), !part->is_static())) near.push_back(part.get());
    }
    if (member_of(*body) != nullptr || !has_any(*body, setup_.parts)) continue;
    if (const Result<Behavior*> member = join(*body); !member && all_joined) all_joined = Error{member.error()};
  }
  if (neighbors_ == nullptr || !neighbors_->holds(near)) neighbors_ = world_.behaviors().neighbor_set(std::move(near));
  return all_joined;
}

Result<Behavior*> BehaviorGroup::join(Body& body) {
  Result<std::unique_ptr<Behavior>> member = world_.behaviors().make(body, type_, name(), member_setup_, this);
  if (!member) return Error{member.error()};
  Store& store = world_.store();
  const std::size_t width = type_->table->kept_width();
  std::copy_n(std::as_const(store).kept_block(id_), width, store.kept_block((*member)->id()));
  members_.push_back(std::move(*member));
  world_.behaviors().undo().made_member(*members_.back());
  return members_.back().get();
}

void BehaviorGroup::renew(const std::shared_ptr<const BehaviorType>& type) {
  id_ = world_.store().retable(id_, *type->group_table, this);
  type_ = type;
}

void BehaviorGroup::lay_out() {
  static const std::uint32_t enabled = Body::table().at("enabled").offset;
  static const std::uint32_t mass = Part::table().at("mass").offset;
  laid_out_ = true;
  prepared_++;
  attention_ = true;
  const NodeSlot* const slots = world_.store().view()->slots;
  const std::uint32_t active = type_->table->row(0).width;
  layout_ = {};
  for (const auto& member : members_) {
    layout_.values.push_back(slots[member->id().slot].kept + active);
    layout_.enabled.push_back(slots[member->body().id().slot].live + enabled);
    layout_.first_part.push_back(static_cast<std::uint32_t>(layout_.parts.size()));
    for (Part* part : member->parts()) {
      layout_.parts.push_back(part);
      const Vec3 inertia = part->geometry()->unit_inertia;
      layout_.least_inertia.push_back(std::min({inertia.x, inertia.y, inertia.z}));
      layout_.load.push_back(part->load_place());
      layout_.mass.push_back(slots[part->id().slot].kept + mass);
    }
  }
  layout_.first_part.push_back(static_cast<std::uint32_t>(layout_.parts.size()));
}

// the slow way, in a step in which some start or rest with an error
void BehaviorGroup::prepare_members() {
  attention_ = false;
  prepared_++;
  for (std::size_t i = 0; i < members_.size(); i++) {
    Behavior& member = *members_[i];
    if (member.runs()) member.prepare();
    attention_ = attention_ || member.needs_attention();
  }
}

void BehaviorGroup::step(double dt) {
  const double start = system::clock_seconds();
  if (!laid_out_) lay_out();
  const std::uint64_t seed = world_.seed();
  if (attention_ || std::exchange(seed_, seed) != seed) prepare_members();
  running_.clear();
  running_numbers_.clear();
  const double* const kept = world_.store().kept().data();
  const double* const live = world_.store().live().data();
  constexpr std::uint32_t kAhead = 12;  // after a tick of physics these are far off: asked for in time
  for (std::uint32_t i = 0; i < layout_.values.size(); i++) {
    if (i + kAhead < layout_.values.size()) {
      __builtin_prefetch(kept + layout_.values[i + kAhead] - 1);
      __builtin_prefetch(live + layout_.enabled[i + kAhead]);
    }
    if (kept[layout_.values[i] - 1] == 0 || live[layout_.enabled[i]] == 0) continue;
    if (attention_ && !members_[i]->runs()) continue;
    running_.push_back(members_[i].get());
    running_numbers_.push_back(i);
  }
  if (!running_.empty()) running_.front()->step_group(running_, dt);
  seconds_ = system::clock_seconds() - start;
}

std::uint64_t BehaviorGroup::state_hash(std::uint64_t hash) const {
  NumberHash numbers(hash_bytes(name(), hash));
  numbers.add_word(kept_hash(world_.store(), id_));
  return numbers.value();
}

}  // namespace limber

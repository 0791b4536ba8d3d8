// GearList: adding, removing and reattaching gears; detection of redundant ones.
#include "sim/gears/gear_list.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

// Positions coupled by gears (union-find): each is factor·(position of the root) + offset.
class GearUnionFind {
 public:
  enum class Relation : std::uint8_t { independent, redundant, contradictory };

  /// Relation of another gear b = ratio·a + offset to those joined before; joins it if it is independent.
  Relation join(const bullet::JointConstraint* a, const bullet::JointConstraint* b, double ratio, double offset,
                double* contradiction) {
    if (ratio == 0) return Relation::independent;
    const Position at_a = find(a);
    const Position at_b = find(b);
    const double factor = ratio * at_a.factor;
    const double shift = ratio * at_a.offset + offset - at_b.offset;
    if (at_a.root != at_b.root) {
      positions_[at_b.root] = {at_a.root, factor / at_b.factor, shift / at_b.factor};
      return Relation::independent;
    }
    // with another ratio, only one position satisfies both: an independent constraint
    if (std::fabs(at_b.factor - factor) > 1e-9 * (std::fabs(at_b.factor) + std::fabs(factor))) {
      return Relation::independent;
    }
    *contradiction = shift;
    return std::fabs(shift) < 1e-6 ? Relation::redundant : Relation::contradictory;
  }

 private:
  struct Position {
    const bullet::JointConstraint* root = nullptr;
    double factor = 1;
    double offset = 0;
  };
  Position find(const bullet::JointConstraint* joint) {
    Position at{joint, 1, 0};
    for (auto parent = positions_.find(joint); parent != positions_.end(); parent = positions_.find(at.root)) {
      at = {parent->second.root, at.factor * parent->second.factor, at.factor * parent->second.offset + at.offset};
    }
    return at;
  }
  std::unordered_map<const bullet::JointConstraint*, Position> positions_;
};

void warn_unused(const Gear& gear, GearUnionFind::Relation relation, double contradiction) {
  if (relation == GearUnionFind::Relation::redundant) {
    log_warning("gear '{}': other gears couple its joints with the same ratio already; ignored. Remove one of them",
                gear.name());
  } else {
    log_warning(
        "gear '{}': contradicts other gears: '{}/{}' would be {:.6g} off; ignored. Change its offset or "
        "remove one of them",
        gear.name(), gear.joint_b().body().name(), gear.joint_b().name(), contradiction);
  }
}

}  // namespace

GearList::GearList(World& world, NodeId parent)
    : world_(world), gears_(world.store(), world.store().add_group(parent, "gear")) {}

Result<Gear*> GearList::add(std::string name, Joint& joint_a, Joint& joint_b, double ratio,
                            std::optional<double> offset) {
  if (const Result<void> free = gears_.check_new_name("gear", name); !free) return Error{free.error()};
  const auto fault = [&](std::string_view problem) { return Error{fmt::format("gear '{}': {}", name, problem)}; };
  for (const Joint* joint : {&joint_a, &joint_b}) {
    if (const Result<void> can = check_gear_joint(*joint); !can) return fault(can.error());
  }
  if (&joint_a == &joint_b) return fault("needs two different joints");
  const Property& ratio_range = Gear::table().at("ratio");
  if (ratio == 0 || !(std::fabs(ratio) <= ratio_range.max)) {
    return fault(fmt::format("the ratio must be {} .. {} and not 0, got {}", ratio_range.min, ratio_range.max, ratio));
  }
  // apply pending poses of the parts before the joints' positions are read
  for (Joint* joint : {&joint_a, &joint_b}) {
    joint->parent().flush();
    joint->child().flush();
    if (joint->body().joints_dirty()) joint->update_from_parts();
  }
  const double initial_offset = offset ? *offset : joint_b.value() - ratio * joint_a.value();
  const Property& offset_range = Gear::table().at("offset");
  if (!(std::fabs(initial_offset) <= offset_range.max)) {
    return fault(
        fmt::format("the offset must be {} .. {}, got {}", offset_range.min, offset_range.max, initial_offset));
  }
  Gear& gear = gears_.add(std::make_unique<Gear>(world_, gears_.group(), std::move(name), joint_a, joint_b));
  world_.store().mutable_values(gear.id(), ratio_range)[0] = ratio;
  world_.store().mutable_values(gear.id(), offset_range)[0] = initial_offset;
  gear.apply_settings();
  world_.transaction().record_added(gears_.objects());
  return &gear;
}

void GearList::remove(Gear& gear) {
  const std::size_t index = gears_.index_of(gear);
  if (index == gears_.list().size()) return;
  mark_dirty();
  if (world_.transaction().active()) return world_.transaction().hide(gears_.objects(), index);
  gears_.objects().erase(gears_.objects().begin() + static_cast<std::ptrdiff_t>(index));
}

void GearList::remove_from(const Body& body) {
  for (std::size_t i = gears_.list().size(); i-- > 0;) {
    if (Gear& gear = *gears_.list()[i]; gear.couples(body)) remove(gear);
  }
  mark_dirty();  // the body's mimic relations are removed with it
}

// Checks the gears in order of creation, after all mimic relations, which a model guarantees to be consistent.
void GearList::find_redundant() {
  GearUnionFind groups;
  double contradiction = 0;
  for (const auto& body : world_.bodies()) {
    for (const Joint* follower : body->followers()) {
      const bullet::GearConstraint& gear = *follower->mimic_gear();
      groups.join(&gear.joint_a(), &gear.joint_b(), gear.settings().ratio, gear.settings().offset, &contradiction);
    }
  }
  for (const auto& gear : gears_.list()) {
    GearUnionFind::Relation relation = GearUnionFind::Relation::independent;
    if (gear->enabled()) {
      relation = groups.join(&gear->joint_a().constraint(), &gear->joint_b().constraint(), gear->ratio(),
                             gear->offset(), &contradiction);
    }
    const bool redundant = relation != GearUnionFind::Relation::independent;
    if (redundant && !gear->redundant()) warn_unused(*gear, relation, contradiction);
    gear->set_redundant(redundant);
  }
}

void GearList::update() {
  if (gears_.list().empty()) return;
  if (std::exchange(state_.dirty, false)) find_redundant();
  for (const auto& gear : gears_.list()) gear->update_constraint();
}

void GearList::reset_constraints(const Body& body) {
  for (const auto& gear : gears_.list()) {
    if (gear->couples(body)) gear->constraint().reset();
  }
}

void GearList::warn_slipping() {
  for (const auto& gear : gears_.list()) {
    bullet::GearConstraint& constraint = gear->constraint();
    if (!constraint.is_slipping() || !constraint.report_slip()) continue;
    log_warning(
        "gear '{}': joint '{}/{}' is {:.3g} away from the position set by the gear: limits, locks or contacts prevent "
        "it. Widen the limits, or set max_force to let the gear slip",
        gear->name(), gear->joint_b().body().name(), gear->joint_b().name(), std::abs(constraint.error()));
  }
}

std::vector<GearList::Detached> GearList::detach(const Body& body) {
  std::vector<Detached> detached;
  std::vector<std::unique_ptr<Gear>>& gears = gears_.objects();
  for (std::size_t i = gears.size(); i-- > 0;) {
    Gear& gear = *gears[i];
    if (!gear.couples(body)) continue;
    gear.remove_constraint();
    const auto name_on_body = [&](const Joint& joint) { return &joint.body() == &body ? joint.name() : std::string(); };
    detached.push_back({std::move(gears[i]), i, name_on_body(gear.joint_a()), name_on_body(gear.joint_b())});
    gears.erase(gears.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return detached;
}

void GearList::attach(std::vector<Detached> detached, const Body& replacement) {
  std::vector<std::unique_ptr<Gear>>& gears = gears_.objects();
  for (auto entry = detached.rbegin(); entry != detached.rend(); ++entry) {
    Gear& gear = *entry->gear;
    Joint* const a = entry->joint_a.empty() ? &gear.joint_a() : replacement.find_joint(entry->joint_a);
    Joint* const b = entry->joint_b.empty() ? &gear.joint_b() : replacement.find_joint(entry->joint_b);
    if (a == nullptr || b == nullptr || !check_gear_joint(*a) || !check_gear_joint(*b)) continue;
    gear.replace_joints(*a, *b);
    const std::size_t index = std::min(entry->index, gears.size());
    gears.insert(gears.begin() + static_cast<std::ptrdiff_t>(index), std::move(entry->gear));
  }
}

void GearList::serialize(Archive& archive) {
  archive.serialize(state_);
  for (const auto& gear : gears_.list()) gear->serialize(archive);
}

}  // namespace limber::sim

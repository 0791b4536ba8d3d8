// Gear: its properties; detection of redundant gears; mimic relations of a body's joints.
#include "sim/world/gear.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/log/log.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/world/world.h"

namespace limber {

namespace {

using namespace properties;

struct GearProperties {
  const Property *enabled, *ratio, *offset, *max_force;
};

const GearProperties& gear_properties() {
  static const auto at = [](const char* name) { return &Gear::table().at(name); };
  static const GearProperties found{at("enabled"), at("ratio"), at("offset"), at("max_force")};
  return found;
}

// Positions coupled by gears (union-find): each is factor·(position of the root) + offset.
class GearUnionFind {
 public:
  enum class Relation : std::uint8_t { independent, redundant, contradictory };

  /// Relation of another gear b = ratio·a + offset to those joined before; joins it if it is independent.
  Relation join(const JointConstraint* a, const JointConstraint* b, double ratio, double offset,
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
    const JointConstraint* root = nullptr;
    double factor = 1;
    double offset = 0;
  };
  Position find(const JointConstraint* joint) {
    Position at{joint, 1, 0};
    for (auto parent = positions_.find(joint); parent != positions_.end(); parent = positions_.find(at.root)) {
      at = {parent->second.root, at.factor * parent->second.factor, at.factor * parent->second.offset + at.offset};
    }
    return at;
  }
  std::unordered_map<const JointConstraint*, Position> positions_;
};

}  // namespace

const PropertyTable& Gear::table() {
  static const PropertyTable table(
      "gear", "/physics/gear/<gear>", "",
      {
          on_change<&Gear::apply_settings>(boolean("enabled", true, "False: the gear does not couple its joints.")),
          validated_by<&Gear::validate_ratio>(on_change<&Gear::apply_settings>(
              number("ratio", "", 1, -1e6, 1e6, "Travel of joint b per travel of joint a; not 0."))),
          on_change<&Gear::apply_settings>(
              number("offset", "m | rad", 0, -1e4, 1e4, "Position of joint b where joint a is at 0.")),
          on_change<&Gear::apply_settings>(
              number("max_force", "N | N·m", 0, 0, 1e9,
                     "Largest force or torque on joint b's axis; beyond it the gear slips. 0: no limit.")),
          computed<&Gear::read_error>(
              readout(number("error", "m | rad", 0, -kUnbounded, kUnbounded, "Position error of joint b."))),
          computed<&Gear::read_force>(readout(
              number("force", "N | N·m", 0, -kUnbounded, kUnbounded,
                     "Force or torque on joint b's axis, mean of the last tick; joint a gets −ratio times this."))),
          invokes<&Gear::act_remove>(action("remove", 0, 0, "Removes the gear.")),
      });
  return table;
}

Gear::Gear(World& world, NodeId group, std::string name, Joint& joint_a, Joint& joint_b)
    : world_(world),
      id_(world.store().add(table(), group, std::move(name), this)),
      joint_a_(&joint_a),
      joint_b_(&joint_b) {
  make_constraint();
}

Gear::~Gear() {
  remove_constraint();
  world_.store().remove(id_);
}

const std::string& Gear::name() const { return world_.store().name(id_); }
double Gear::ratio() const { return world_.store().values(id_, *gear_properties().ratio)[0]; }
double Gear::offset() const { return world_.store().values(id_, *gear_properties().offset)[0]; }
bool Gear::enabled() const { return world_.store().values(id_, *gear_properties().enabled)[0] != 0; }

bool Gear::couples(const Body& body) const { return &joint_a_->body() == &body || &joint_b_->body() == &body; }

void Gear::make_constraint() {
  const BulletMemory::Scope scope(&world_.bullet_memory());
  constraint_ = std::make_unique<GearConstraint>(joint_a_->constraint(), joint_a_->own_axis(), joint_b_->constraint(),
                                                 joint_b_->own_axis());
}

void Gear::replace_joints(Joint& joint_a, Joint& joint_b) {
  remove_constraint();
  joint_a_ = &joint_a;
  joint_b_ = &joint_b;
  make_constraint();
  apply_settings();
}

void Gear::apply_settings() {
  const GearSettings settings{ratio(), offset(), world_.store().values(id_, *gear_properties().max_force)[0]};
  if (!(settings == constraint_->settings())) {
    joint_a_->wake();
    joint_b_->wake();
  }
  constraint_->set(settings);
  world_.mark_gears_dirty();
}

void Gear::update_constraint() {
  const bool active = enabled() && !state_.redundant && joint_a_->in_world() && joint_b_->in_world();
  if (!active) return remove_constraint();
  if (!std::exchange(state_.in_world, true)) world_.bullet().addConstraint(constraint_.get(), false);
}

void Gear::remove_constraint() {
  if (std::exchange(state_.in_world, false)) world_.bullet().removeConstraint(constraint_.get());
}

void Gear::read_error(double* out) const { out[0] = constraint_->error(); }

void Gear::read_force(double* out) const { out[0] = state_.in_world ? constraint_->applied() : 0; }

Result<void> Gear::validate_ratio(const double* in) const {
  if (in[0] != 0) return {};
  return Error{"a gear's ratio must not be 0; set enabled to false to uncouple its joints"};
}

Result<void> Gear::act_remove(std::span<const double>) {
  world_.remove_gear(*this);
  return {};
}

Result<void> check_gear_joint(const Joint& joint) {
  const JointType type = joint.type();
  if (type == JointType::revolute || type == JointType::continuous || type == JointType::prismatic) return {};
  return Error{fmt::format("joint '{}/{}' is {}; a gear needs a revolute, continuous or prismatic joint",
                           joint.body().name(), joint.name(), joint_type_name(type))};
}

// Called once all joints exist, because a leader may be listed after its follower in the file.
void Body::couple_followers() {
  for (const auto& joint : joints_) {
    if (!joint->spec().mimic || !check_gear_joint(*joint)) continue;
    Joint* const leader = find_joint(joint->spec().mimic->leader);
    if (leader == nullptr || leader == joint.get() || !check_gear_joint(*leader)) continue;
    joint->couple_to(*leader);
    followers_.push_back(joint.get());
  }
}

void Body::warn_slipping_joints() const {
  for (const Joint* follower : followers_) {
    GearConstraint& gear = *follower->mimic_gear();
    if (!gear.is_slipping() || !gear.report_slip()) continue;
    log_warning(
        "joint '{}/{}' is {:.3g} away from the position set by its leader '{}': limits, locks or contacts block it. "
        "Widen its limits or keep the leader within its range",
        name(), follower->name(), std::abs(gear.error()), follower->spec().mimic->leader);
  }
}

// Adds gears to Bullet's world or removes them, after detecting redundant ones: in order of creation, after all mimic
// relations, which a model guarantees to be consistent.
void World::update_gears() {
  if (gears_.empty()) return;
  if (state_.gears_dirty) {
    state_.gears_dirty = false;
    GearUnionFind groups;
    double contradiction = 0;
    for (const auto& body : bodies_) {
      for (const Joint* follower : body->followers()) {
        const GearConstraint& gear = *follower->mimic_gear();
        groups.join(&gear.joint_a(), &gear.joint_b(), gear.settings().ratio, gear.settings().offset, &contradiction);
      }
    }
    for (const auto& gear : gears_) {
      GearUnionFind::Relation relation = GearUnionFind::Relation::independent;
      if (gear->enabled()) {
        relation = groups.join(&gear->joint_a().constraint(), &gear->joint_b().constraint(), gear->ratio(),
                               gear->offset(), &contradiction);
      }
      const bool redundant = relation != GearUnionFind::Relation::independent;
      if (redundant && !gear->redundant()) {
        if (relation == GearUnionFind::Relation::redundant) {
          log_warning(
              "gear '{}': other gears couple its joints with the same ratio already; ignored. Remove one of them",
              gear->name());
        } else {
          log_warning(
              "gear '{}': contradicts other gears: '{}/{}' would be {:.6g} off; ignored. Change its offset or "
              "remove one of them",
              gear->name(), gear->joint_b().body().name(), gear->joint_b().name(), contradiction);
        }
      }
      gear->set_redundant(redundant);
    }
  }
  for (const auto& gear : gears_) gear->update_constraint();
}

Result<Gear*> World::add_gear(std::string name, Joint& joint_a, Joint& joint_b, double ratio,
                              std::optional<double> offset) {
  if (const Result<void> free = check_new_name(gear_group_, "gear", name); !free) return Error{free.error()};
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
  gears_.push_back(std::make_unique<Gear>(*this, gear_group_, std::move(name), joint_a, joint_b));
  Gear& gear = *gears_.back();
  store_.mutable_values(gear.id(), *gear_properties().ratio)[0] = ratio;
  store_.mutable_values(gear.id(), *gear_properties().offset)[0] = initial_offset;
  gear.apply_settings();
  transaction_.record([](void* world, std::size_t) { static_cast<World*>(world)->gears_.pop_back(); }, this);
  return &gear;
}

void World::remove_gear(Gear& gear) {
  const auto at = std::ranges::find_if(gears_, [&](const std::unique_ptr<Gear>& g) { return g.get() == &gear; });
  if (at == gears_.end()) return;
  mark_gears_dirty();
  if (transaction_.active()) return transaction_.hide(gears_, static_cast<std::size_t>(at - gears_.begin()));
  gears_.erase(at);
}

Gear* World::find_gear(std::string_view name) const {
  const NodeId id = store_.child(gear_group_, name);
  return id.null() ? nullptr : static_cast<Gear*>(store_.object(id));
}

}  // namespace limber

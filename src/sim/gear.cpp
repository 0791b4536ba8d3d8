// Gear: its properties; which of a world's gears are redundant; the gears of a body's mimic relations.
#include "sim/gear.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/log.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

struct GearRows {
  const Row *enabled, *ratio, *offset, *max_force;
};

const GearRows& gear_rows() {
  static const auto at = [](const char* name) { return &Gear::table().at(name); };
  static const GearRows found{at("enabled"), at("ratio"), at("offset"), at("max_force")};
  return found;
}

// Joints whose positions gears couple: each is factor·(position of a root) + offset.
class GearGroups {
 public:
  enum class Relation : std::uint8_t { independent, redundant, contradictory };

  /// How a further gear b = ratio·a + offset relates to those joined before; joins it when it is independent.
  Relation join(const JointConstraint* a, const JointConstraint* b, double ratio, double offset,
                double* contradiction) {
    if (ratio == 0) return Relation::independent;
    const Place at_a = find(a);
    const Place at_b = find(b);
    const double factor = ratio * at_a.factor;
    const double shift = ratio * at_a.offset + offset - at_b.offset;
    if (at_a.root != at_b.root) {
      places_[at_b.root] = {at_a.root, factor / at_b.factor, shift / at_b.factor};
      return Relation::independent;
    }
    // another ratio leaves one position, which is a law of its own
    if (std::fabs(at_b.factor - factor) > 1e-9 * (std::fabs(at_b.factor) + std::fabs(factor))) {
      return Relation::independent;
    }
    *contradiction = shift;
    return std::fabs(shift) < 1e-6 ? Relation::redundant : Relation::contradictory;
  }

 private:
  struct Place {
    const JointConstraint* root = nullptr;
    double factor = 1;
    double offset = 0;
  };
  Place find(const JointConstraint* joint) {
    Place at{joint, 1, 0};
    for (auto up = places_.find(joint); up != places_.end(); up = places_.find(at.root)) {
      at = {up->second.root, at.factor * up->second.factor, at.factor * up->second.offset + at.offset};
    }
    return at;
  }
  std::unordered_map<const JointConstraint*, Place> places_;
};

}  // namespace

const Table& Gear::table() {
  static const Table table(
      "gear", "/physics/gear/<gear>", "",
      {
          effect<&Gear::effect_settings>(boolean("enabled", true, "False: the joints are free of each other.")),
          refuse<&Gear::refuse_ratio>(effect<&Gear::effect_settings>(
              number("ratio", "", 1, -1e6, 1e6, "Travel of joint b per travel of joint a; not 0."))),
          effect<&Gear::effect_settings>(
              number("offset", "m | rad", 0, -1e4, 1e4, "Position of joint b where joint a is at 0.")),
          effect<&Gear::effect_settings>(
              number("max_force", "N | N·m", 0, 0, 1e9,
                     "Largest force or torque on joint b's axis; beyond it the gear slips. 0: no limit.")),
          view<&Gear::read_error>(readout(number("error", "m | rad", 0, -kUnbounded, kUnbounded,
                                                 "How far joint b is from its position by the gear."))),
          view<&Gear::read_force>(readout(
              number("force", "N | N·m", 0, -kUnbounded, kUnbounded,
                     "Force or torque on joint b's axis, mean of the last tick; joint a gets −ratio times this."))),
          act<&Gear::act_remove>(action("remove", 0, 0, "Removes the gear.")),
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
  leave();
  world_.store().remove(id_);
}

const std::string& Gear::name() const { return world_.store().name(id_); }
double Gear::ratio() const { return world_.store().values(id_, *gear_rows().ratio)[0]; }
double Gear::offset() const { return world_.store().values(id_, *gear_rows().offset)[0]; }
bool Gear::enabled() const { return world_.store().values(id_, *gear_rows().enabled)[0] != 0; }

bool Gear::couples(const Body& body) const { return &joint_a_->body() == &body || &joint_b_->body() == &body; }

void Gear::make_constraint() {
  const BulletMemory::Scope scope(&world_.bullet_memory());
  constraint_ = std::make_unique<GearConstraint>(joint_a_->constraint(), joint_a_->own_axis(), joint_b_->constraint(),
                                                 joint_b_->own_axis());
}

void Gear::attach(Joint& joint_a, Joint& joint_b) {
  leave();
  joint_a_ = &joint_a;
  joint_b_ = &joint_b;
  make_constraint();
  effect_settings();
}

void Gear::effect_settings() {
  const GearSettings settings{ratio(), offset(), world_.store().values(id_, *gear_rows().max_force)[0]};
  if (!(settings == constraint_->settings())) {
    joint_a_->wake();
    joint_b_->wake();
  }
  constraint_->set(settings);
  world_.gears_changed();
}

void Gear::settle() {
  const bool active = enabled() && !redundant_ && joint_a_->in_world() && joint_b_->in_world();
  if (!active) return leave();
  if (!std::exchange(in_world_, true)) world_.bullet().addConstraint(constraint_.get(), false);
}

void Gear::leave() {
  if (std::exchange(in_world_, false)) world_.bullet().removeConstraint(constraint_.get());
}

void Gear::read_error(double* out) const { out[0] = constraint_->error(); }

void Gear::read_force(double* out) const { out[0] = in_world_ ? constraint_->applied() : 0; }

Result<void> Gear::refuse_ratio(const double* in) const {
  if (in[0] != 0) return {};
  return Error{"a gear's ratio must not be 0; set enabled to false to free its joints"};
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

// Once all joints are there: a leader may come after its follower.
void Body::couple_followers() {
  for (const auto& joint : joints_) {
    if (!joint->spec().mimic || !check_gear_joint(*joint)) continue;
    Joint* const leader = find_joint(joint->spec().mimic->leader);
    if (leader == nullptr || leader == joint.get() || !check_gear_joint(*leader)) continue;
    joint->couple_to(*leader);
    followers_.push_back(joint.get());
  }
}

void Body::report_slips() const {
  for (const Joint* follower : followers_) {
    GearConstraint& gear = *follower->mimic_gear();
    if (!gear.slips() || !gear.report_slip()) continue;
    log_warning(
        "joint '{}/{}' is {:.3g} away from where it follows '{}': limits, locks or contacts hold it. Widen its limits "
        "or keep the leader within its reach",
        name(), follower->name(), std::abs(gear.error()), follower->spec().mimic->leader);
  }
}

// Gears in their order after all mimic relations, which a model keeps free of contradictions.
void World::settle_gears() {
  if (gears_.empty()) return;
  if (gears_changed_) {
    gears_changed_ = false;
    GearGroups groups;
    double contradiction = 0;
    for (const auto& body : bodies_) {
      for (const Joint* follower : body->followers()) {
        const GearConstraint& gear = *follower->mimic_gear();
        groups.join(&gear.joint_a(), &gear.joint_b(), gear.settings().ratio, gear.settings().offset, &contradiction);
      }
    }
    for (const auto& gear : gears_) {
      GearGroups::Relation relation = GearGroups::Relation::independent;
      if (gear->enabled()) {
        relation = groups.join(&gear->joint_a().constraint(), &gear->joint_b().constraint(), gear->ratio(),
                               gear->offset(), &contradiction);
      }
      const bool redundant = relation != GearGroups::Relation::independent;
      if (redundant && !gear->redundant()) {
        if (relation == GearGroups::Relation::redundant) {
          log_warning(
              "gear '{}': other gears couple its joints with the same ratio already; ignored. Remove one of them",
              gear->name());
        } else {
          log_warning(
              "gear '{}': contradicts other gears, which put '{}/{}' {:.6g} elsewhere; ignored. Change its offset or "
              "remove one of them",
              gear->name(), gear->joint_b().body().name(), gear->joint_b().name(), contradiction);
        }
      }
      gear->set_redundant(redundant);
    }
  }
  for (const auto& gear : gears_) gear->settle();
}

Result<Gear*> World::add_gear(std::string name, Joint& joint_a, Joint& joint_b, double ratio,
                              std::optional<double> offset) {
  if (const Result<void> free = name_is_free(gear_group_, "gear", name); !free) return Error{free.error()};
  const auto fault = [&](std::string_view what) { return Error{fmt::format("gear '{}': {}", name, what)}; };
  for (const Joint* joint : {&joint_a, &joint_b}) {
    if (const Result<void> can = check_gear_joint(*joint); !can) return fault(can.error());
  }
  if (&joint_a == &joint_b) return fault("needs two different joints");
  const Row& range = Gear::table().at("ratio");
  if (ratio == 0 || !(std::fabs(ratio) <= range.max)) {
    return fault(fmt::format("the ratio must be {} .. {} and not 0, got {}", range.min, range.max, ratio));
  }
  // parts are put where they were set before the joints' positions are read
  for (Joint* joint : {&joint_a, &joint_b}) {
    joint->parent().settle();
    joint->child().settle();
    if (joint->body().moved_) joint->read_anew();
  }
  const double from = offset ? *offset : joint_b.value() - ratio * joint_a.value();
  const Row& offsets = Gear::table().at("offset");
  if (!(std::fabs(from) <= offsets.max)) {
    return fault(fmt::format("the offset must be {} .. {}, got {}", offsets.min, offsets.max, from));
  }
  gears_.push_back(std::make_unique<Gear>(*this, gear_group_, std::move(name), joint_a, joint_b));
  Gear& gear = *gears_.back();
  store_.tell(gear.id(), *gear_rows().ratio)[0] = ratio;
  store_.tell(gear.id(), *gear_rows().offset)[0] = from;
  gear.effect_settings();
  undo_.made_gear();
  return &gear;
}

void World::remove_gear(Gear& gear) {
  const auto at = std::ranges::find_if(gears_, [&](const std::unique_ptr<Gear>& g) { return g.get() == &gear; });
  if (at == gears_.end()) return;
  gears_changed();
  if (undo_.active()) undo_.hide(std::move(*at), static_cast<std::size_t>(at - gears_.begin()));
  gears_.erase(at);
}

Gear* World::find_gear(std::string_view name) const {
  const NodeId id = store_.child(gear_group_, name);
  return id.null() ? nullptr : static_cast<Gear*>(store_.thing(id));
}

}  // namespace limber

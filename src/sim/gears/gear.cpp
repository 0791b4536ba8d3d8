// Gear: its properties; mimic relations of a body's joints.
#include "sim/gears/gear.h"

#include <utility>

#include <fmt/format.h>

#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/gears/gear_list.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/world.h"

namespace limber::sim {

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
  const bullet::BulletMemory::Scope scope(&world_.bullet_memory());
  constraint_ = std::make_unique<bullet::GearConstraint>(joint_a_->constraint(), joint_a_->own_axis(),
                                                         joint_b_->constraint(), joint_b_->own_axis());
}

void Gear::replace_joints(Joint& joint_a, Joint& joint_b) {
  remove_constraint();
  joint_a_ = &joint_a;
  joint_b_ = &joint_b;
  make_constraint();
  apply_settings();
}

void Gear::apply_settings() {
  const bullet::GearSettings settings{ratio(), offset(), world_.store().values(id_, *gear_properties().max_force)[0]};
  if (!(settings == constraint_->settings())) {
    joint_a_->wake();
    joint_b_->wake();
  }
  constraint_->set(settings);
  world_.gears().mark_dirty();
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
  world_.gears().remove(*this);
  return {};
}

Result<void> check_gear_joint(const Joint& joint) {
  const model::JointType type = joint.type();
  if (type == model::JointType::revolute || type == model::JointType::continuous || type == model::JointType::prismatic)
    return {};
  return Error{fmt::format("joint '{}/{}' is {}; a gear needs a revolute, continuous or prismatic joint",
                           joint.body().name(), joint.name(), model::joint_type_name(type))};
}

std::vector<Joint*> couple_mimic_joints(const Body& body) {
  std::vector<Joint*> followers;
  for (const auto& joint : body.joints()) {
    if (!joint->spec().mimic || !check_gear_joint(*joint)) continue;
    Joint* const leader = body.find_joint(joint->spec().mimic->leader);
    if (leader == nullptr || leader == joint.get() || !check_gear_joint(*leader)) continue;
    joint->couple_to(*leader);
    followers.push_back(joint.get());
  }
  return followers;
}

}  // namespace limber::sim

// Joint: its properties, and their connection to Bullet's constraint.
#include "sim/world/joint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/sensors/readouts.h"
#include "sim/world/body.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

/// Smaller gaps, m, never count as an instability, however small the parts are.
constexpr double kMinGap = 0.01;
/// This many consecutive ticks with a gap larger than the parts count as an instability; a short push doesn't.
constexpr int kSeparatedTicks = 15;

struct JointReadouts {
  const Property *value, *speed, *angles, *offsets, *relrot, *position, *rotation;
};

const JointReadouts& joint_readouts() {
  static const auto at = [](const char* name) { return &Joint::table().at(name); };
  static const JointReadouts found{at("value"),  at("speed"),    at("angles"),  at("offsets"),
                                   at("relrot"), at("position"), at("rotation")};
  return found;
}

struct LimitProperties {
  std::array<const Property*, 2> lower, upper, stop_erp, stop_cfm;  // linear, angular
  const Property *armature, *cone, *twist_lower, *twist_upper, *rotation;
};

const LimitProperties& limit_properties() {
  static const auto at = [](const char* name) { return &Joint::table().at(name); };
  static const LimitProperties found{{at("linear_lower_limit"), at("angular_lower_limit")},
                                     {at("linear_upper_limit"), at("angular_upper_limit")},
                                     {at("linear_stop_erp"), at("angular_stop_erp")},
                                     {at("linear_stop_cfm"), at("angular_stop_cfm")},
                                     at("armature"),
                                     at("cone_limit"),
                                     at("twist_lower"),
                                     at("twist_upper"),
                                     at("rotation_limit")};
  return found;
}

// Returns relrot(), or the constraint's angles where both are the same (equal axis order, unambiguous, no full turns),
// since relrot() is costly.
Vec3 stream_angles(const bullet::JointConstraint& constraint) {
  const Vec3 angles = constraint.pose().angles();
  const bool same = constraint.pose().order() == std::array<int, 3>{2, 1, 0} && constraint.axis(4).locked() &&
                    std::abs(angles.x) <= kPi && std::abs(angles.y) <= kPi / 2 && std::abs(angles.z) <= kPi;
  return same ? angles : constraint.pose().relrot();
}

// True if a joint type leaves an axis free, apart from limits; axes 0..2 are linear, 3..5 angular.
bool is_free_by_type(model::JointType type, int axis) {
  switch (type) {
    case model::JointType::revolute:
    case model::JointType::continuous:
      return axis == 5;
    case model::JointType::prismatic:
      return axis == 2;
    case model::JointType::planar:
      return axis == 0 || axis == 1 || axis == 5;
    case model::JointType::spherical:
      return axis >= 3;
    case model::JointType::floating:
      return true;
    case model::JointType::fixed:
      return false;
  }
  return false;
}

Property limit_property(std::string name, const char* unit, double range, std::string doc) {
  return axes(on_change<&Joint::apply_limits>(vec3(std::move(name), unit, {0, 0, 0}, -range, range, std::move(doc))));
}

Property stop_property(std::string name, const char* unit, double initial, std::string doc) {
  return axes(
      on_change<&Joint::apply_limits>(vec3(std::move(name), unit, {initial, initial, initial}, 0, 1, std::move(doc))));
}

/// Smallest cone, rad, since a swing of 0 has no direction.
constexpr double kMinCone = 0.01;

Property ball_limit(std::string name, double initial, double min, double max, std::string doc) {
  return on_change<&Joint::apply_limits>(number(std::move(name), "rad", initial, min, max, std::move(doc)));
}

}  // namespace

const PropertyTable& Joint::table() {
  static const PropertyTable table(
      "joint", "/physics/body/<body>/joint/<joint>", "/physics/joint",
      {
          limit_property("linear_lower_limit", "m", 1e4,
                         "Lower limit along each axis; equal to the upper: locked; above it: free."),
          limit_property("linear_upper_limit", "m", 1e4, "Upper limit along each axis."),
          limit_property("angular_lower_limit", "rad", 1e4,
                         "Lower limit about each axis; equal to the upper: locked; above it: free."),
          limit_property("angular_upper_limit", "rad", 1e4, "Upper limit about each axis; limits may lie beyond ±π."),
          stop_property("linear_stop_erp", "", 0.2,
                        "Share of the error of a lock or limit corrected per substep, along the axis."),
          stop_property("linear_stop_cfm", "m/N", 0, "Compliance of locks and limits along the axis."),
          stop_property("angular_stop_erp", "", 0.2,
                        "Share of the error of a lock or limit corrected per substep, about the axis."),
          stop_property("angular_stop_cfm", "rad/(N·m)", 0, "Compliance of locks and limits about the axis."),
          on_change<&Joint::apply_limits>(
              number("armature", "kg | kg·m²", 0, 0, 1e6,
                     "Inertia of the motor's rotor along or about the own axis, as it acts on the joint (with a gear, "
                     "times the square of its ratio); it adds to that of the parts.")),
          ball_limit("cone_limit", kPi, kMinCone, kPi,
                     "Largest swing: the angle between the joint's z axes on both parts, for ball joints; π: free."),
          ball_limit("twist_lower", kPi, -kPi, kPi,
                     "Lower limit of the twist of a ball joint; equal to the upper: locked; above it: free."),
          ball_limit("twist_upper", -kPi, -kPi, kPi, "Upper limit of the twist of a ball joint."),
          ball_limit("rotation_limit", kPi, kMinCone, kPi,
                     "Largest angle of the whole rotation of a ball joint, about any axis; π: free."),
          transient(
              hashed(readout(number("value", "m | rad", 0, -kUnbounded, kUnbounded, "Position of the own axis.")))),
          transient(
              hashed(readout(number("speed", "m/s | rad/s", 0, -kUnbounded, kUnbounded, "Speed of the own axis.")))),
          transient(hashed(readout(vec3("angles", "rad", {0, 0, 0}, -kUnbounded, kUnbounded,
                                        "Angles in the joint's own order of axes, as used by limits and servos.")))),
          transient(hashed(readout(vec3("offsets", "m", {0, 0, 0}, -kUnbounded, kUnbounded,
                                        "Offset of the child along the parent's joint axes.")))),
          transient(
              hashed(readout(vec3("relrot", "rad", {0, 0, 0}, -kUnbounded, kUnbounded,
                                  "Rotation of the child's joint frame in the parent's, R = Rz·Ry·Rx, as streamed.")))),
          transient(hashed(readout(vec3("position", "m", {0, 0, 0}, -kUnbounded, kUnbounded,
                                        "Position of the joint on the parent, world.")))),
          transient(hashed(readout(quat("rotation", "Rotation of the child's joint frame, world: x y z w.")))),
          computed<&read_reaction_force>(readout(
              vec3("reaction_force", "N", {0, 0, 0}, -kUnbounded, kUnbounded,
                   "Force of the parent on the child at the joint, joint's frame on the parent, mean of the last "
                   "tick."))),
          computed<&read_reaction_torque>(readout(
              vec3("reaction_torque", "N·m", {0, 0, 0}, -kUnbounded, kUnbounded,
                   "Torque of the parent on the child about the joint, joint's frame on the parent, mean of the last "
                   "tick."))),
          computed<&Joint::read_swing>(readout(
              number("swing", "rad", 0, 0, kPi, "Angle between the joint's z axes on both parts, as cone_limit."))),
          computed<&Joint::read_twist>(readout(number(
              "twist", "rad", 0, -2 * kPi, 2 * kPi,
              "Rotation about the z axis that precedes the swing; within ±π, or nearest to the twist's limits."))),
          computed<&Joint::read_axis>(readout(vec3("axis", "", {0, 0, 1}, -1, 1, "Direction of the own axis, world."))),
      });
  return table;
}

std::unique_ptr<bullet::JointConstraint> Joint::make_constraint(Part& parent, Part& child, const JointSpec& spec) {
  const bullet::BulletMemory::Scope scope(&parent.body().world().bullet_memory());
  return std::make_unique<bullet::JointConstraint>(
      parent.rigid(), child.rigid(), bullet::to_bt(parent.geometry()->frame.inverse() * spec.frame_in_parent),
      bullet::to_bt(child.geometry()->frame.inverse() * spec.frame_in_child));
}

Joint::Joint(Body& body, NodeId group, std::string name, Part& parent, Part& child, const JointSpec& spec)
    : body_(body),
      id_(body.store().add(table(), group, std::move(name), this)),
      parent_(parent),
      child_(child),
      constraint_(make_constraint(parent, child, spec)),
      spec_(spec) {
  Store& store = body_.store();
  for (int axis = 0; axis < 6; axis++) {
    const auto half = static_cast<std::size_t>(axis / 3);
    const bool is_limited = axis == own_axis() && spec.limited;
    const bool is_free = is_free_by_type(spec.type, axis) && !is_limited;
    store.mutable_values(id_, *limit_properties().lower[half])[axis % 3] = is_limited ? spec.lower : is_free ? 1 : 0;
    store.mutable_values(id_, *limit_properties().upper[half])[axis % 3] = is_limited ? spec.upper : is_free ? -1 : 0;
  }
}

Joint::~Joint() {
  remove_from_world();
  body_.store().remove(id_);
}

void Joint::add_to_world() {
  if (std::exchange(state_.in_world, true)) return;
  constraint_->target_interpolator().restart();
  body_.world().bullet().addConstraint(constraint_.get());
}

void Joint::couple_to(Joint& leader) {
  const bullet::BulletMemory::Scope scope(&body_.world().bullet_memory());
  mimic_gear_ =
      std::make_unique<bullet::GearConstraint>(*leader.constraint_, leader.own_axis(), *constraint_, own_axis());
  mimic_gear_->set({spec_.mimic->multiplier, spec_.mimic->offset, 0});
}

void Joint::add_mimic_gear() {
  if (mimic_gear_ == nullptr || std::exchange(state_.gear_in_world, true)) return;
  body_.world().bullet().addConstraint(mimic_gear_.get(), false);
}

void Joint::remove_from_world() {
  if (std::exchange(state_.gear_in_world, false)) body_.world().bullet().removeConstraint(mimic_gear_.get());
  if (std::exchange(state_.in_world, false)) body_.world().bullet().removeConstraint(constraint_.get());
}

void Joint::wake() {
  if (!state_.in_world) return;
  bullet::SleepTracker& sleep = body_.world().bullet().sleep();
  if (!parent_.is_static()) sleep.wake(parent_.rigid());
  if (!child_.is_static()) sleep.wake(child_.rigid());
}

const std::string& Joint::name() const { return body_.store().name(id_); }

int Joint::own_axis() const {
  if (spec_.type == model::JointType::fixed) return -1;
  return spec_.type == model::JointType::prismatic ? 2 : 5;
}

double Joint::value() const { return own_axis() < 0 ? 0 : constraint_->value(own_axis()); }

void Joint::apply_limits() {
  const Store& store = body_.store();
  const unsigned before = state_.open_axes;
  unsigned open = 0;
  for (int axis = 0; axis < 6; axis++) {
    const auto half = static_cast<std::size_t>(axis / 3);
    const auto value_of = [&](const std::array<const Property*, 2>& properties) {
      return static_cast<float>(store.values(id_, *properties[half])[axis % 3]);
    };
    bullet::AxisSettings settings = constraint_->axis(axis);
    settings.lower = value_of(limit_properties().lower);
    settings.upper = value_of(limit_properties().upper);
    settings.stop_erp = value_of(limit_properties().stop_erp);
    settings.stop_cfm = value_of(limit_properties().stop_cfm);
    settings.friction = axis == own_axis() ? static_cast<float>(spec_.friction) : 0;
    settings.armature = axis == own_axis() ? static_cast<float>(store.values(id_, *limit_properties().armature)[0]) : 0;
    if (!(settings == constraint_->axis(axis))) wake();
    constraint_->set_axis(axis, settings);
    if (!settings.locked()) open |= 1u << axis;
  }
  state_.open_axes = static_cast<std::uint8_t>(open);
  apply_ball_limits();
  if ((open & ~before) != 0 && motor_ != nullptr) motor_->apply_axes();
}

void Joint::apply_ball_limits() {
  const auto value_of = [this](const Property* property) {
    return static_cast<float>(body_.store().values(id_, *property)[0]);
  };
  const LimitProperties& properties = limit_properties();
  const bullet::BallLimitSettings settings{value_of(properties.cone), value_of(properties.twist_lower),
                                           value_of(properties.twist_upper), value_of(properties.rotation)};
  if (settings == constraint_->ball_limits().settings()) return;
  constraint_->set_ball_limits(settings);
  wake();
}

void Joint::update_from_parts() {
  // the published angles, since the constraint's may be NaN after an instability
  const double* published = body_.store().transient_block(id_) + joint_readouts().angles->offset;
  constraint_->reset({published[0], published[1], published[2]});
  if (mimic_gear_ != nullptr) mimic_gear_->reset();
  state_.separated_ticks = 0;
  publish();
}

void Joint::save_start() { state_.start_angles = constraint_->pose().angles(); }
void Joint::save_start(const Joint& other) { state_.start_angles = other.constraint_->pose().angles(); }

void Joint::restore_start() {
  Store& store = body_.store();
  store.save_before_write(id_, *joint_readouts().angles);
  put(store.transient_block(id_) + joint_readouts().angles->offset, state_.start_angles);
}

void Joint::publish() {
  double* transient = body_.store().transient_block(id_);
  const JointReadouts& properties = joint_readouts();
  const btTransform& parent = parent_.rigid().getCenterOfMassTransform();
  const btTransform& frame = constraint_->pose().frame_in_parent();
  const int axis = own_axis();
  transient[properties.value->offset] = axis < 0 ? 0 : constraint_->value(axis);
  transient[properties.speed->offset] = axis < 0 ? 0 : constraint_->rate(axis);
  put(transient + properties.angles->offset, constraint_->pose().angles());
  put(transient + properties.offsets->offset, constraint_->pose().offsets());
  put(transient + properties.relrot->offset, stream_angles(*constraint_));
  put(transient + properties.position->offset, bullet::from_bt(parent * frame.getOrigin()));
  const Quat q = child_.pose().rotation * spec_.frame_in_child.rotation;
  double* rotation = transient + properties.rotation->offset;
  rotation[0] = q.x;
  rotation[1] = q.y;
  rotation[2] = q.z;
  rotation[3] = q.w;
}

double Joint::gap() const {
  const Vec3 offsets = constraint_->pose().offsets();
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    if (is_open(axis) || constraint_->axis(axis).stop_cfm > 0) continue;
    const double off = offsets[axis] - static_cast<double>(constraint_->axis(axis).lower);
    sum += off * off;
  }
  return std::sqrt(sum);
}

bool Joint::check_separation() {
  const double distance = gap();
  if (!(distance > kMinGap)) {
    state_.separated_ticks = 0;
    return false;
  }
  double size = 0;
  for (const Part* part : {&parent_, &child_}) {
    if (part->is_static()) continue;
    btVector3 low, high;
    part->geometry()->shape->getAabb(btTransform::getIdentity(), low, high);
    const btVector3 sides = high - low;
    size += static_cast<double>(sides[sides.maxAxis()]);
  }
  state_.separated_ticks = distance > size ? state_.separated_ticks + 1 : 0;
  return state_.separated_ticks >= kSeparatedTicks;
}

void Joint::read_swing(double* out) const { out[0] = bullet::swing_twist(constraint_->pose().rotation()).swing; }

void Joint::read_twist(double* out) const {
  const bullet::BallLimitSettings& limits = constraint_->ball_limits().settings();
  const double twist = bullet::swing_twist(constraint_->pose().rotation()).twist;
  const bool limited = limits.twist_lower <= limits.twist_upper;
  out[0] = limited ? bullet::turned_into(twist, static_cast<double>(limits.twist_lower),
                                         static_cast<double>(limits.twist_upper))
                   : twist;
}

void Joint::read_axis(double* out) const {
  const btMatrix3x3& frame = constraint_->pose().frame_in_parent().getBasis();
  put(out, bullet::from_bt(parent_.rigid().getCenterOfMassTransform().getBasis() * frame.getColumn(2)));
}

}  // namespace limber::sim

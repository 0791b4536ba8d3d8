// Motor: its properties, and applying them to the axes of the constraint.
#include "sim/world/motor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/log/log.h"
#include "sim/bullet/bullet.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

// Properties that exist for linear and for angular axes.
struct AxisProperties {
  std::array<const Property*, 2> active, velocity, max_force, servo_active, servo_position, spring_active, rest,
      stiffness, damping, torque_active, torque;
  const Property *bounce, *passive_damping, *smoothing, *no_load_speed;
};

const AxisProperties& axis_properties() {
  static const auto at = [](const char* name) { return &Motor::table().at(name); };
  static const AxisProperties found{{at("linear_active"), at("angular_active")},
                                    {at("linear_velocity"), at("angular_velocity")},
                                    {at("max_linear_force"), at("max_angular_force")},
                                    {at("linear_servo_active"), at("angular_servo_active")},
                                    {at("linear_servo_position"), at("angular_servo_position")},
                                    {at("linear_spring_active"), at("angular_spring_active")},
                                    {at("linear_spring_rest_length"), at("angular_spring_rest_length")},
                                    {at("linear_spring_stiffness"), at("angular_spring_stiffness")},
                                    {at("linear_spring_damping"), at("angular_spring_damping")},
                                    {at("linear_force_active"), at("angular_torque_active")},
                                    {at("linear_force"), at("angular_torque")},
                                    at("bounce"),
                                    at("damping"),
                                    at("target_smoothing"),
                                    at("no_load_speed")};
  return found;
}

Property flags_property(std::string name, std::string doc) {
  return axes(on_change<&Motor::apply_axes>(flags3(std::move(name), {false, false, false}, std::move(doc))));
}

Property numbers_property(std::string name, const char* unit, double initial, double min, double max, std::string doc) {
  return axes(on_change<&Motor::apply_axes>(
      vec3(std::move(name), unit, {initial, initial, initial}, min, max, std::move(doc))));
}

// A target position or velocity of an axis; these properties may be set at every tick.
Property target_property(std::string name, const char* unit, std::string doc) {
  return axes(
      independent(on_change<&Motor::apply_targets>(vec3(std::move(name), unit, {0, 0, 0}, -1e4, 1e4, std::move(doc)))));
}

Property applied_readout(std::string name, const char* unit, std::string doc) {
  return readout(vec3(std::move(name), unit, {0, 0, 0}, -kUnbounded, kUnbounded, std::move(doc)));
}

// Adds the properties of the linear or of the angular axes.
void add_axes(std::vector<Property>& out, const std::string& side, bool angular) {
  const char* length = angular ? "rad" : "m";
  const char* speed = angular ? "rad/s" : "m/s";
  const char* force = angular ? "N·m" : "N";
  const char* stiffness = angular ? "N·m/rad" : "N/m";
  const char* damping = angular ? "N·m·s/rad" : "N·s/m";
  const std::string where = angular ? "about each axis" : "along each axis";
  out.push_back(flags_property(side + "_active", "Motor on " + where + ": a spin, or a servo if that is active too."));
  out.push_back(
      target_property(side + "_velocity", speed,
                      "Speed of a spin " + where + "; maximal speed of a servo (0: limited by its force only)."));
  out.push_back(numbers_property(
      "max_" + side + "_force", force, 10000, 0, 1e9,
      (angular ? "Maximal torque of a spin or servo " : "Maximal force of a spin or servo ") + where + "."));
  out.push_back(flags_property(side + "_servo_active", "Servo on " + where + " (needs the motor active)."));
  out.push_back(target_property(side + "_servo_position", length,
                                "Target position of a servo " + where + (angular ? "; full turns count." : ".")));
  out.push_back(flags_property(side + "_spring_active", "Spring on " + where + "; it replaces spin and servo."));
  out.push_back(target_property(side + "_spring_rest_length", length, "Rest position of a spring " + where + "."));
  out.push_back(numbers_property(side + "_spring_stiffness", stiffness, 0, 0, 1e6, "Spring stiffness " + where + "."));
  out.push_back(numbers_property(side + "_spring_damping", damping, 0, 0, 1e6, "Spring damping " + where + "."));
  const std::string load = angular ? "torque" : "force";
  out.push_back(flags_property(side + "_" + load + "_active",
                               "Given " + load + " " + where + "; it replaces spin and servo, a spring replaces it."));
  Property given =
      target_property(side + "_" + load, force, "The given " + load + " " + where + ", up to max_" + side + "_force.");
  given.min = -1e9;
  given.max = 1e9;
  out.push_back(std::move(given));
  Property stiff = applied_readout(side + "_spring_stiffness_applied", stiffness,
                                   "Stiffness in effect " + where + ", capped for stability.");
  Property damp = applied_readout(side + "_spring_damping_applied", damping, "Spring damping in effect " + where + ".");
  out.push_back(angular ? computed<&Motor::read_angular_stiffness>(std::move(stiff))
                        : computed<&Motor::read_linear_stiffness>(std::move(stiff)));
  out.push_back(angular ? computed<&Motor::read_angular_damping>(std::move(damp))
                        : computed<&Motor::read_linear_damping>(std::move(damp)));
}

}  // namespace

const PropertyTable& Motor::table() {
  static const PropertyTable table = [] {
    std::vector<Property> list;
    list.push_back(validated_by<&Motor::validate_own_axis>(state(computed<&Motor::read_mode, &Motor::write_mode>(
        choice("mode", {"off", "spin", "servo", "spring", "torque"}, 2,
               "Mode of the own axis; setting it sets the axis's four flags.")))));
    list.push_back(validated_by<&Motor::validate_own_axis>(state(computed<&Motor::read_target, &Motor::write_target>(
        number("target", "m | rad", 0, -1e4, 1e4,
               "Target of the own axis's servo or spring; full turns count: 20π is ten.")))));
    list.push_back(validated_by<&Motor::validate_own_axis>(state(computed<&Motor::read_speed, &Motor::write_speed>(
        number("speed", "m/s | rad/s", 0, -1e4, 1e4,
               "Speed of the own axis's spin; maximal speed of its servo. From 500 m/s on, the stability check "
               "restores the body.")))));
    list.push_back(
        validated_by<&Motor::validate_own_axis>(state(computed<&Motor::read_target_torque, &Motor::write_target_torque>(
            number("target_torque", "N | N·m", 0, -1e9, 1e9,
                   "Torque or force of the own axis in mode torque, up to its maximal force.")))));
    list.push_back(on_change<&Motor::apply_axes>(
        number("no_load_speed", "m/s | rad/s", 0, 0, 1e4,
               "Speed of the own axis at which its motor has no force left: the maximal force in the direction of "
               "motion decreases linearly from rest to this speed. 0: it doesn't depend on the speed.")));
    list.push_back(on_change<&Motor::apply_axes>(number(
        "bounce", "", 0, 0, 1, "Restitution of limits: after an impact at speed v the axis has speed −bounce·v.")));
    list.push_back(on_change<&Motor::apply_axes>(
        number("damping", "N·s/m | N·m·s/rad", 0, 0, 1e6, "Passive damping of every free axis in any mode.")));
    list.push_back(on_change<&Motor::apply_axes>(
        number("target_smoothing", "s", 0, 0, 2,
               "Smoothing time for targets that arrive irregularly, ideally two periods of the stream; delays the "
               "motion by 1.5 times this and up to three ticks. 0: a target is reached in one tick.")));
    add_axes(list, "linear", false);
    add_axes(list, "angular", true);
    list.push_back(computed<&Motor::read_force>(applied_readout(
        "applied_force", "N",
        "Mean force of motors and springs along each axis in the last tick; against a limit, its full force.")));
    list.push_back(computed<&Motor::read_torque>(applied_readout(
        "applied_torque", "N·m",
        "Mean torque of motors and springs about each axis in the last tick; against a limit, its full torque.")));
    return PropertyTable("motor", "/physics/body/<body>/motor/<motor>", "/physics/motor", std::move(list),
                         &Motor::prefetch_targets);
  }();
  return table;
}

Motor::Motor(Joint& joint, NodeId group)
    : joint_(joint),
      constraint_(joint.constraint()),
      id_(joint.body().store().add(table(), group, joint.name(), this)) {
  Store& store = joint_.body().store();
  const int axis = joint_.own_axis();
  if (axis >= 0) {
    const auto half = static_cast<std::size_t>(axis / 3);
    store.mutable_values(id_, *axis_properties().active[half])[axis % 3] = 1;
    store.mutable_values(id_, *axis_properties().servo_active[half])[axis % 3] = 1;
    store.mutable_values(id_, *axis_properties().servo_position[half])[axis % 3] = joint_.value();
  }
  save_held_position();
  joint_.set_motor(this);
}

Motor::~Motor() {
  joint_.set_motor(nullptr);
  joint_.body().store().remove(id_);
}

MotorMode Motor::mode(int axis) const {
  const AxisProperties& properties = axis_properties();
  const double* persistent = std::as_const(joint_.body().store()).persistent_block(id_) + axis % 3;
  const auto half = static_cast<std::size_t>(axis / 3);
  if (persistent[properties.spring_active[half]->offset] != 0) return MotorMode::spring;
  if (persistent[properties.torque_active[half]->offset] != 0) return MotorMode::torque;
  if (persistent[properties.active[half]->offset] == 0) return MotorMode::off;
  return persistent[properties.servo_active[half]->offset] != 0 ? MotorMode::servo : MotorMode::spin;
}

void Motor::set_own_axis(const Property& linear_property, const Property& angular_property, double value) {
  const int axis = joint_.own_axis();
  if (axis < 0) return;
  const Property& property = axis < 3 ? linear_property : angular_property;
  Store& store = joint_.body().store();
  std::array<double, 3> values{};
  store.get(id_, property, values.data());
  values[static_cast<std::size_t>(axis % 3)] = value;
  (void)store.set(id_, property, values);  // the number was validated for the calling property already
}

void Motor::set_mode(MotorMode mode) {
  const AxisProperties& properties = axis_properties();
  set_own_axis(*properties.spring_active[0], *properties.spring_active[1], mode == MotorMode::spring ? 1 : 0);
  set_own_axis(*properties.active[0], *properties.active[1],
               mode == MotorMode::spin || mode == MotorMode::servo ? 1 : 0);
  set_own_axis(*properties.servo_active[0], *properties.servo_active[1], mode == MotorMode::servo ? 1 : 0);
  // written only if it changes, so that scenes without this mode never set it
  const bool torque = mode == MotorMode::torque;
  const int axis = joint_.own_axis();
  if (axis < 0) return;
  const Property& active = *properties.torque_active[static_cast<std::size_t>(axis / 3)];
  if ((joint_.body().store().values(id_, active)[axis % 3] != 0) != torque)
    set_own_axis(*properties.torque_active[0], *properties.torque_active[1], torque ? 1 : 0);
}

void Motor::set_target(double target) {
  const AxisProperties& properties = axis_properties();
  set_own_axis(*properties.servo_position[0], *properties.servo_position[1], target);
  set_own_axis(*properties.rest[0], *properties.rest[1], target);
}

void Motor::step_towards(const Vec3& target, double max_step) {
  Store& store = joint_.body().store();
  const AxisProperties& properties = axis_properties();
  const Vec3 angles = constraint_.pose().angles();
  for (const MotorMode wanted_mode : {MotorMode::servo, MotorMode::spring}) {
    const Property& property = wanted_mode == MotorMode::servo ? *properties.servo_position[1] : *properties.rest[1];
    std::array<double, 3> values{};
    store.get(id_, property, values.data());
    bool any = false;
    for (int axis = 0; axis < 3; axis++) {
      if (mode(3 + axis) != wanted_mode) continue;
      double difference = target[axis] - angles[axis];
      if (constraint_.axis(3 + axis).free()) {
        difference = std::remainder(difference, 2 * kPi);
        if (difference <= -kPi) difference = kPi;
      }
      values[static_cast<std::size_t>(axis)] = angles[axis] + std::clamp(difference, -max_step, max_step);
      any = true;
    }
    if (any) (void)store.set(id_, property, values);
  }
}

void Motor::save_held_position() {
  for (int axis = 0; axis < 6; axis++) state_.held_position[bullet::at(axis)] = constraint_.value(axis);
  constraint_.target_interpolator().restart();
}

void Motor::apply_axes() {
  const Store& store = joint_.body().store();
  const double* persistent = store.persistent_block(id_);
  const AxisProperties& properties = axis_properties();
  const Panic& panic = joint_.body().world().panic();
  for (int axis = 0; axis < 6; axis++) {
    const auto half = static_cast<std::size_t>(axis / 3);
    const auto value_of = [&](const std::array<const Property*, 2>& r) {
      return static_cast<float>(persistent[r[half]->offset + static_cast<std::uint32_t>(axis % 3)]);
    };
    if (!joint_.is_open(axis)) continue;  // Joint::apply_limits() calls this again when the axis is unlocked
    bullet::AxisSettings settings = constraint_.axis(axis);
    settings.drive = panic.drive(mode(axis));
    settings.max_force = value_of(properties.max_force);
    settings.stiffness = value_of(properties.stiffness);
    settings.spring_damping = value_of(properties.damping);
    settings.no_load_speed =
        axis == joint_.own_axis() ? static_cast<float>(store.values(id_, *properties.no_load_speed)[0]) : 0;
    if (!(settings == constraint_.axis(axis))) joint_.wake();
    constraint_.set_axis(axis, settings);
    if (mode(axis) == MotorMode::spring && value_of(properties.active) != 0) warn_contradiction(axis);
  }
  const btScalar bounce = constraint_.bounce();
  const btScalar damping = constraint_.damping();
  constraint_.set_bounce(store.values(id_, *properties.bounce)[0]);
  constraint_.set_damping(store.values(id_, *properties.passive_damping)[0]);
  if (constraint_.bounce() != bounce || constraint_.damping() != damping) joint_.wake();
  const double smoothing = store.values(id_, *properties.smoothing)[0];
  if (constraint_.target_interpolator().smoothing() != smoothing) {
    joint_.wake();
    const bullet::BulletMemory::Scope scope(&joint_.body().world().bullet_memory());
    constraint_.target_interpolator().set_smoothing(smoothing);
  }
  apply_targets();
}

// Prefetches the settings of the own axis, since nearly all targets are for it.
void Motor::prefetch_targets(const void* object) {
  const auto& motor = *static_cast<const Motor*>(object);
  __builtin_prefetch(&motor.joint_);
  for (const int axis : {2, 5}) __builtin_prefetch(&motor.constraint_.axis(axis));
}

void Motor::apply_targets() {
  if (update_targets()) joint_.wake();
}

bool Motor::update_targets() {
  // runs at every tick for every animated motor: reads the values directly and skips locked axes
  const double* persistent = std::as_const(joint_.body().store()).persistent_block(id_);
  const AxisProperties& properties = axis_properties();
  const Panic& panic = joint_.body().world().panic();
  const bool holding = panic.on() && panic.holds_motors();
  bool changed = false;
  for (int axis = 0; axis < 6; axis++) {
    if (!joint_.is_open(axis)) continue;
    const auto half = static_cast<std::size_t>(axis / 3);
    const double* const values = persistent + axis % 3;
    changed |= constraint_.set_target(
        axis, holding ? state_.held_position[bullet::at(axis)] : values[properties.servo_position[half]->offset],
        values[properties.rest[half]->offset],
        holding ? Panic::kTerminalSpeed : values[properties.velocity[half]->offset],
        values[properties.torque[half]->offset]);
  }
  return changed;
}

void Motor::warn_contradiction(int axis) {
  if (std::exchange(state_.warned_contradiction, true)) return;
  const char* const names[] = {"linear x", "linear y", "linear z", "angular x", "angular y", "angular z"};
  log_warning("motor '{}/{}': spring_active and active are both on for {}; the spring has priority, active is ignored",
              joint_.body().name(), name(), names[axis]);
}

void Motor::warn_capped() {
  if (std::exchange(state_.warned_capped, true)) return;
  const Store& store = joint_.body().store();
  for (int axis = 0; axis < 6; axis++) {
    const double requested =
        store.values(id_, *axis_properties().stiffness[static_cast<std::size_t>(axis / 3)])[axis % 3];
    if (mode(axis) != MotorMode::spring || !joint_.is_open(axis)) continue;
    if (constraint_.drives().stiffness_applied(axis) >= 0.999 * requested) continue;
    const double h =
        std::sqrt((constraint_.pose().effective_inertia(axis) + static_cast<double>(constraint_.axis(axis).armature)) /
                  (16 * requested));
    const double substeps = std::ceil(joint_.body().world().timestep() / std::max(h, 1e-9));
    log_warning(
        "motor '{}/{}': spring stiffness {} is capped at {:.4g} for stability; about {} substeps would allow it",
        joint_.body().name(), name(), requested, constraint_.drives().stiffness_applied(axis), substeps);
    return;
  }
}

void Motor::warn_target_outside() {
  // a mimic joint's target is determined by its leader, independently of the limits of the joint itself
  if (joint_.spec().mimic || std::exchange(state_.warned_target_outside, true)) return;
  for (int axis = 0; axis < 6; axis++) {
    if (!constraint_.drives().target_outside(axis)) continue;
    const bullet::AxisSettings& s = constraint_.axis(axis);
    const char* const names[] = {"x", "y", "z"};
    const bool angular = axis >= 3;
    const std::string axis_text =
        axis == joint_.own_axis() ? "" : fmt::format("{} {} ", angular ? "about" : "along", names[axis % 3]);
    log_warning("motor '{}/{}': target {:.4g} {} {}is outside the limits {:.4g}..{:.4g}{}", joint_.body().name(),
                name(), s.target, angular ? "rad" : "m", axis_text, s.lower, s.upper,
                angular ? "; angles are radians" : "");
    return;
  }
}

void Motor::read_force(double* out) const { put(out, constraint_.drives().applied_force()); }

void Motor::read_torque(double* out) const { put(out, constraint_.drives().applied_torque()); }

void Motor::read_linear_stiffness(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.drives().stiffness_applied(axis);
}

void Motor::read_angular_stiffness(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.drives().stiffness_applied(3 + axis);
}

void Motor::read_linear_damping(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.axis(axis).damping_applied();
}

void Motor::read_angular_damping(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.axis(3 + axis).damping_applied();
}

void Motor::read_mode(double* out) const {
  out[0] = joint_.own_axis() < 0 ? 0 : static_cast<double>(mode(joint_.own_axis()));
}

void Motor::write_mode(const double* in) { set_mode(static_cast<MotorMode>(static_cast<int>(in[0]))); }

void Motor::read_target(double* out) const {
  const int axis = joint_.own_axis();
  const auto half = static_cast<std::size_t>(axis / 3);
  const AxisProperties& properties = axis_properties();
  const Property& property =
      axis >= 0 && mode(axis) == MotorMode::spring ? *properties.rest[half] : *properties.servo_position[half];
  out[0] = axis < 0 ? 0 : joint_.body().store().values(id_, property)[axis % 3];
}

void Motor::write_target(const double* in) { set_target(in[0]); }

void Motor::read_target_torque(double* out) const {
  const int axis = joint_.own_axis();
  const auto& torque = axis_properties().torque;
  out[0] = axis < 0 ? 0 : joint_.body().store().values(id_, *torque[static_cast<std::size_t>(axis / 3)])[axis % 3];
}

void Motor::write_target_torque(const double* in) {
  set_own_axis(*axis_properties().torque[0], *axis_properties().torque[1], in[0]);
}

void Motor::read_speed(double* out) const {
  const int axis = joint_.own_axis();
  out[0] = axis < 0 ? 0
                    : joint_.body().store().values(
                          id_, *axis_properties().velocity[static_cast<std::size_t>(axis / 3)])[axis % 3];
}

void Motor::write_speed(const double* in) {
  set_own_axis(*axis_properties().velocity[0], *axis_properties().velocity[1], in[0]);
}

Result<void> Motor::validate_own_axis(const double*) const {
  if (joint_.own_axis() >= 0) return {};
  return Error{"a fixed joint has no axis of its own"};
}

}  // namespace limber::sim

// Motor: its rows, and what of them is in force on each axis.
#include "sim/motor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/log.h"
#include "sim/body.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

// the rows of one kind for linear and angular axes
struct AxisRows {
  std::array<const Row*, 2> active, velocity, max_force, servo_active, servo_position, spring_active, rest, stiffness,
      damping;
  const Row *bounce, *passive_damping, *smoothing;
};

const AxisRows& axis_rows() {
  static const auto at = [](const char* name) { return &Motor::table().at(name); };
  static const AxisRows found{{at("linear_active"), at("angular_active")},
                              {at("linear_velocity"), at("angular_velocity")},
                              {at("max_linear_force"), at("max_angular_force")},
                              {at("linear_servo_active"), at("angular_servo_active")},
                              {at("linear_servo_position"), at("angular_servo_position")},
                              {at("linear_spring_active"), at("angular_spring_active")},
                              {at("linear_spring_rest_length"), at("angular_spring_rest_length")},
                              {at("linear_spring_stiffness"), at("angular_spring_stiffness")},
                              {at("linear_spring_damping"), at("angular_spring_damping")},
                              at("bounce"),
                              at("damping"),
                              at("target_smoothing")};
  return found;
}

Row axis_flags(std::string name, std::string doc) {
  return axes(effect<&Motor::effect_axes>(flags3(std::move(name), {false, false, false}, std::move(doc))));
}

Row axis_numbers(std::string name, const char* unit, double initial, double min, double max, std::string doc) {
  return axes(
      effect<&Motor::effect_axes>(vec3(std::move(name), unit, {initial, initial, initial}, min, max, std::move(doc))));
}

// where an axis is to go, and how fast: what is played at every tick
Row axis_goals(std::string name, const char* unit, std::string doc) {
  return axes(apart(effect<&Motor::effect_goals>(vec3(std::move(name), unit, {0, 0, 0}, -1e4, 1e4, std::move(doc)))));
}

Row applied(std::string name, const char* unit, std::string doc) {
  return readout(vec3(std::move(name), unit, {0, 0, 0}, -kUnbounded, kUnbounded, std::move(doc)));
}

// the nine rows of the linear or the angular axes
void add_axes(std::vector<Row>& out, const std::string& side, bool angular) {
  const char* length = angular ? "rad" : "m";
  const char* speed = angular ? "rad/s" : "m/s";
  const char* force = angular ? "N·m" : "N";
  const char* stiffness = angular ? "N·m/rad" : "N/m";
  const char* damping = angular ? "N·m·s/rad" : "N·s/m";
  const std::string where = angular ? "about each axis" : "along each axis";
  out.push_back(axis_flags(side + "_active", "Motor on " + where + ": a spin, or a servo when that is active too."));
  out.push_back(axis_goals(side + "_velocity", speed,
                           "Speed of a spin " + where + "; how fast a servo may go (0: as fast as its force allows)."));
  out.push_back(
      axis_numbers("max_" + side + "_force", force, 10000, 0, 1e9, "Most that a spin or servo applies " + where + "."));
  out.push_back(axis_flags(side + "_servo_active", "Servo on " + where + " (needs the motor active)."));
  out.push_back(axis_goals(side + "_servo_position", length,
                           "Where a servo goes " + where + (angular ? "; full turns count." : ".")));
  out.push_back(axis_flags(side + "_spring_active", "Spring on " + where + "; spin and servo are off then."));
  out.push_back(axis_goals(side + "_spring_rest_length", length, "Where a spring rests " + where + "."));
  out.push_back(axis_numbers(side + "_spring_stiffness", stiffness, 0, 0, 1e6, "Spring stiffness " + where + "."));
  out.push_back(axis_numbers(side + "_spring_damping", damping, 0, 0, 1e6, "Spring damping " + where + "."));
  Row stiff = applied(side + "_spring_stiffness_applied", stiffness,
                      "Stiffness in force " + where + ", held stable for the step.");
  Row damp = applied(side + "_spring_damping_applied", damping, "Spring damping in force " + where + ".");
  out.push_back(angular ? view<&Motor::read_angular_stiffness>(std::move(stiff))
                        : view<&Motor::read_linear_stiffness>(std::move(stiff)));
  out.push_back(angular ? view<&Motor::read_angular_damping>(std::move(damp))
                        : view<&Motor::read_linear_damping>(std::move(damp)));
}

}  // namespace

const Table& Motor::table() {
  static const Table table = [] {
    std::vector<Row> list;
    list.push_back(refuse<&Motor::refuse_own_axis>(state(view<&Motor::read_mode, &Motor::write_mode>(
        choice("mode", {"off", "spin", "servo", "spring"}, 2,
               "What is in force on the own axis; setting it sets the three flags.")))));
    list.push_back(refuse<&Motor::refuse_own_axis>(state(view<&Motor::read_target, &Motor::write_target>(
        number("target", "m | rad", 0, -1e4, 1e4,
               "Where the own axis's servo or spring goes; full turns count: 20π is ten.")))));
    list.push_back(refuse<&Motor::refuse_own_axis>(state(
        view<&Motor::read_speed, &Motor::write_speed>(number("speed", "m/s | rad/s", 0, -1e4, 1e4,
                                                             "Speed of the own axis's spin; how fast its servo may go. "
                                                             "The stability check restores what moves at 500 m/s.")))));
    list.push_back(effect<&Motor::effect_axes>(
        number("bounce", "", 0, 0, 1, "What a limit gives back: met at speed v, it is left at −bounce·v.")));
    list.push_back(effect<&Motor::effect_axes>(
        number("damping", "N·s/m | N·m·s/rad", 0, 0, 1e6, "Passive damping of every free axis in any mode.")));
    list.push_back(effect<&Motor::effect_axes>(number(
        "target_smoothing", "s", 0, 0, 2,
        "Smooths targets that arrive at irregular times, best over two periods of the stream; motion is later by 1.5 "
        "times this and up to three ticks. 0: a target is reached in one tick.")));
    add_axes(list, "linear", false);
    add_axes(list, "angular", true);
    list.push_back(view<&Motor::read_force>(
        applied("applied_force", "N",
                "What motors and springs applied along each axis, mean of the last tick; at a stop, "
                "what presses against it.")));
    list.push_back(view<&Motor::read_torque>(
        applied("applied_torque", "N·m",
                "What motors and springs applied about each axis, mean of the last tick; at a stop, "
                "what presses against it.")));
    return Table("motor", "/physics/body/<body>/motor/<motor>", "/physics/motor", std::move(list), &Motor::fetch);
  }();
  return table;
}

Motor::Motor(Joint& joint, NodeId group)
    : joint_(joint),
      constraint_(joint.constraint()),
      id_(joint.body().store().add(table(), group, joint.name(), this)) {
  Store& store = joint_.body().store();
  const int own = joint_.own_axis();
  if (own >= 0) {
    const auto half = static_cast<std::size_t>(own / 3);
    store.tell(id_, *axis_rows().active[half])[own % 3] = 1;
    store.tell(id_, *axis_rows().servo_active[half])[own % 3] = 1;
    store.tell(id_, *axis_rows().servo_position[half])[own % 3] = joint_.value();
  }
  hold_here();
  joint_.set_motor(this);
}

Motor::~Motor() {
  joint_.set_motor(nullptr);
  joint_.body().store().remove(id_);
}

MotorMode Motor::mode(int axis) const {
  const AxisRows& rows = axis_rows();
  const double* kept = std::as_const(joint_.body().store()).kept_block(id_) + axis % 3;
  const auto half = static_cast<std::size_t>(axis / 3);
  if (kept[rows.spring_active[half]->offset] != 0) return MotorMode::spring;
  if (kept[rows.active[half]->offset] == 0) return MotorMode::off;
  return kept[rows.servo_active[half]->offset] != 0 ? MotorMode::servo : MotorMode::spin;
}

void Motor::set_own(const Row& linear_row, const Row& angular_row, double value) {
  const int own = joint_.own_axis();
  if (own < 0) return;
  const Row& row = own < 3 ? linear_row : angular_row;
  Store& store = joint_.body().store();
  std::array<double, 3> values{};
  store.get(id_, row, values.data());
  values[static_cast<std::size_t>(own % 3)] = value;
  (void)store.set(id_, row, values);  // the view's own row has checked the number already
}

void Motor::set_mode(MotorMode mode) {
  const AxisRows& rows = axis_rows();
  set_own(*rows.spring_active[0], *rows.spring_active[1], mode == MotorMode::spring ? 1 : 0);
  set_own(*rows.active[0], *rows.active[1], mode == MotorMode::spin || mode == MotorMode::servo ? 1 : 0);
  set_own(*rows.servo_active[0], *rows.servo_active[1], mode == MotorMode::servo ? 1 : 0);
}

void Motor::set_target(double target) {
  const AxisRows& rows = axis_rows();
  set_own(*rows.servo_position[0], *rows.servo_position[1], target);
  set_own(*rows.rest[0], *rows.rest[1], target);
}

void Motor::lead_to(const Vec3& target, double most) {
  Store& store = joint_.body().store();
  const AxisRows& rows = axis_rows();
  const Vec3 now = constraint_.angles();
  for (const MotorMode by : {MotorMode::servo, MotorMode::spring}) {
    const Row& row = by == MotorMode::servo ? *rows.servo_position[1] : *rows.rest[1];
    std::array<double, 3> values{};
    store.get(id_, row, values.data());
    bool any = false;
    for (int axis = 0; axis < 3; axis++) {
      if (mode(3 + axis) != by) continue;
      double way = target[axis] - now[axis];
      if (constraint_.axis(3 + axis).free()) {
        way = std::remainder(way, 2 * kPi);
        if (way <= -kPi) way = kPi;
      }
      values[static_cast<std::size_t>(axis)] = now[axis] + std::clamp(way, -most, most);
      any = true;
    }
    if (any) (void)store.set(id_, row, values);
  }
}

void Motor::hold_here() {
  for (int axis = 0; axis < 6; axis++) hold_[at(axis)] = constraint_.value(axis);
  constraint_.restart_goals();
}

void Motor::effect_axes() {
  const Store& store = joint_.body().store();
  const double* kept = store.kept_block(id_);
  const AxisRows& rows = axis_rows();
  const Panic& panic = joint_.body().world().panic();
  for (int axis = 0; axis < 6; axis++) {
    const auto half = static_cast<std::size_t>(axis / 3);
    const auto number = [&](const std::array<const Row*, 2>& r) {
      return static_cast<float>(kept[r[half]->offset + static_cast<std::uint32_t>(axis % 3)]);
    };
    if (!joint_.is_open(axis)) continue;  // its drive comes when its limits open
    AxisSettings settings = constraint_.axis(axis);
    settings.drive = panic.drive(mode(axis));
    settings.max_force = number(rows.max_force);
    settings.stiffness = number(rows.stiffness);
    settings.spring_damping = number(rows.damping);
    if (!(settings == constraint_.axis(axis))) joint_.wake();
    constraint_.set_axis(axis, settings);
    if (mode(axis) == MotorMode::spring && number(rows.active) != 0) say_contradiction(axis);
  }
  const btScalar bounce = constraint_.bounce();
  const btScalar damping = constraint_.damping();
  constraint_.set_bounce(store.values(id_, *rows.bounce)[0]);
  constraint_.set_damping(store.values(id_, *rows.passive_damping)[0]);
  if (constraint_.bounce() != bounce || constraint_.damping() != damping) joint_.wake();
  const double smoothing = store.values(id_, *rows.smoothing)[0];
  if (constraint_.smoothing() != smoothing) {
    joint_.wake();
    const BulletMemory::Scope scope(&joint_.body().world().bullet_memory());
    constraint_.set_smoothing(smoothing);
  }
  effect_goals();
}

// what its goals are set in, which are those of the own axis nearly always
void Motor::fetch(const void* thing) {
  const auto& motor = *static_cast<const Motor*>(thing);
  __builtin_prefetch(&motor.joint_);
  for (const int own : {2, 5}) __builtin_prefetch(&motor.constraint_.axis(own));
}

void Motor::effect_goals() {
  if (set_goals()) joint_.wake();
}

bool Motor::set_goals() {
  // at every tick for every motor that is played: values straight from the block, nothing for what is locked
  const double* kept = std::as_const(joint_.body().store()).kept_block(id_);
  const AxisRows& rows = axis_rows();
  const Panic& panic = joint_.body().world().panic();
  const bool held = panic.on() && panic.holds_motors();
  bool changed = false;
  for (int axis = 0; axis < 6; axis++) {
    if (!joint_.is_open(axis)) continue;
    const auto half = static_cast<std::size_t>(axis / 3);
    const double* const own = kept + axis % 3;
    changed |=
        constraint_.set_goal(axis, held ? hold_[at(axis)] : own[rows.servo_position[half]->offset],
                             own[rows.rest[half]->offset], held ? Panic::kSink : own[rows.velocity[half]->offset]);
  }
  return changed;
}

void Motor::say_contradiction(int axis) {
  if (std::exchange(said_contradiction_, true)) return;
  const char* const names[] = {"linear x", "linear y", "linear z", "angular x", "angular y", "angular z"};
  log_warning(
      "motor '{}/{}': spring_active and active are both on for {}; the spring is in force, spin and servo are off",
      joint_.body().name(), name(), names[axis]);
}

void Motor::say_cap() {
  if (std::exchange(said_cap_, true)) return;
  const Store& store = joint_.body().store();
  for (int axis = 0; axis < 6; axis++) {
    const double wanted = store.values(id_, *axis_rows().stiffness[static_cast<std::size_t>(axis / 3)])[axis % 3];
    if (mode(axis) != MotorMode::spring || !joint_.is_open(axis)) continue;
    if (constraint_.stiffness_applied(axis) >= 0.999 * wanted) continue;
    const double h = std::sqrt(constraint_.effective_inertia(axis) / (16 * wanted));
    const double substeps = std::ceil(joint_.body().world().timestep() / std::max(h, 1e-9));
    log_warning("motor '{}/{}': a spring of {} is held at {:.4g} to stay stable; about {} substeps would allow it",
                joint_.body().name(), name(), wanted, constraint_.stiffness_applied(axis), substeps);
    return;
  }
}

void Motor::warn_outside() {
  // a follower's target is its leader's; its own limits are another matter
  if (joint_.spec().mimic || std::exchange(warned_outside_, true)) return;
  for (int axis = 0; axis < 6; axis++) {
    if (!constraint_.target_outside(axis)) continue;
    const AxisSettings& s = constraint_.axis(axis);
    const char* const names[] = {"x", "y", "z"};
    const bool angular = axis >= 3;
    const std::string which =
        axis == joint_.own_axis() ? "" : fmt::format("{} {} ", angular ? "about" : "along", names[axis % 3]);
    log_warning("motor '{}/{}': target {:.4g} {} {}is outside the limits {:.4g}..{:.4g}{}", joint_.body().name(),
                name(), s.target, angular ? "rad" : "m", which, s.lower, s.upper,
                angular ? "; angles are radians" : "");
    return;
  }
}

void Motor::read_force(double* out) const { put(out, constraint_.applied_force()); }

void Motor::read_torque(double* out) const { put(out, constraint_.applied_torque()); }

void Motor::read_linear_stiffness(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.stiffness_applied(axis);
}

void Motor::read_angular_stiffness(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.stiffness_applied(3 + axis);
}

void Motor::read_linear_damping(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.damping_applied(axis);
}

void Motor::read_angular_damping(double* out) const {
  for (int axis = 0; axis < 3; axis++) out[axis] = constraint_.damping_applied(3 + axis);
}

void Motor::read_mode(double* out) const {
  out[0] = joint_.own_axis() < 0 ? 0 : static_cast<double>(mode(joint_.own_axis()));
}

void Motor::write_mode(const double* in) { set_mode(static_cast<MotorMode>(static_cast<int>(in[0]))); }

void Motor::read_target(double* out) const {
  const int own = joint_.own_axis();
  const auto half = static_cast<std::size_t>(own / 3);
  const AxisRows& rows = axis_rows();
  const Row& row = own >= 0 && mode(own) == MotorMode::spring ? *rows.rest[half] : *rows.servo_position[half];
  out[0] = own < 0 ? 0 : joint_.body().store().values(id_, row)[own % 3];
}

void Motor::write_target(const double* in) { set_target(in[0]); }

void Motor::read_speed(double* out) const {
  const int own = joint_.own_axis();
  out[0] = own < 0
               ? 0
               : joint_.body().store().values(id_, *axis_rows().velocity[static_cast<std::size_t>(own / 3)])[own % 3];
}

void Motor::write_speed(const double* in) { set_own(*axis_rows().velocity[0], *axis_rows().velocity[1], in[0]); }

Result<void> Motor::refuse_own_axis(const double*) const {
  if (joint_.own_axis() >= 0) return {};
  return Error{"a fixed joint has no axis of its own"};
}

}  // namespace limber

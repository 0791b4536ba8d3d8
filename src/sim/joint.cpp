// Joint: its rows, and the constraint behind them.
#include "sim/joint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/body.h"
#include "sim/motor.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

/// Smaller gaps are no instability, whatever the size of the parts, m.
constexpr double kLeastGap = 0.01;
/// Consecutive ticks with a gap larger than the parts that are an instability: a push of a moment is none.
constexpr int kTornTicks = 15;

struct JointLiveRows {
  const Row *value, *speed, *angles, *offsets, *relrot, *position, *rotation;
};

const JointLiveRows& joint_live_rows() {
  static const auto at = [](const char* name) { return &Joint::table().at(name); };
  static const JointLiveRows found{at("value"),  at("speed"),    at("angles"),  at("offsets"),
                                   at("relrot"), at("position"), at("rotation")};
  return found;
}

struct LimitRows {
  std::array<const Row*, 2> lower, upper, stop_erp, stop_cfm;  // linear, angular
};

const LimitRows& limit_rows() {
  static const auto at = [](const char* name) { return &Joint::table().at(name); };
  static const LimitRows found{{at("linear_lower_limit"), at("angular_lower_limit")},
                               {at("linear_upper_limit"), at("angular_upper_limit")},
                               {at("linear_stop_erp"), at("angular_stop_erp")},
                               {at("linear_stop_cfm"), at("angular_stop_cfm")}};
  return found;
}

// relrot(), which is costly, where the angles do not say it already: same order, one reading, no turns to count off
Vec3 stream_angles(const JointConstraint& constraint) {
  const Vec3 angles = constraint.angles();
  const bool same = constraint.order() == std::array<int, 3>{2, 1, 0} && constraint.axis(4).locked() &&
                    std::abs(angles.x) <= kPi && std::abs(angles.y) <= kPi / 2 && std::abs(angles.z) <= kPi;
  return same ? angles : constraint.relrot();
}

// the axes that a type leaves free, before limits; 0..2 linear, 3..5 angular
bool free_by_type(JointType type, int axis) {
  switch (type) {
    case JointType::revolute:
    case JointType::continuous:
      return axis == 5;
    case JointType::prismatic:
      return axis == 2;
    case JointType::planar:
      return axis == 0 || axis == 1 || axis == 5;
    case JointType::spherical:
      return axis >= 3;
    case JointType::floating:
      return true;
    case JointType::fixed:
      return false;
  }
  return false;
}

Row limit(std::string name, const char* unit, double reach, std::string doc) {
  return axes(effect<&Joint::effect_limits>(vec3(std::move(name), unit, {0, 0, 0}, -reach, reach, std::move(doc))));
}

Row stop(std::string name, const char* unit, double initial, std::string doc) {
  return axes(
      effect<&Joint::effect_limits>(vec3(std::move(name), unit, {initial, initial, initial}, 0, 1, std::move(doc))));
}

}  // namespace

const Table& Joint::table() {
  static const Table table(
      "joint", "/physics/body/<body>/joint/<joint>", "/physics/joint",
      {
          limit("linear_lower_limit", "m", 1e4,
                "Lower limit along each axis; equal to the upper: locked; above it: free."),
          limit("linear_upper_limit", "m", 1e4, "Upper limit along each axis."),
          limit("angular_lower_limit", "rad", 1e4,
                "Lower limit about each axis; equal to the upper: locked; above it: free."),
          limit("angular_upper_limit", "rad", 1e4, "Upper limit about each axis; limits may lie beyond ±π."),
          stop("linear_stop_erp", "", 0.2, "Part of a lock's or limit's error that one internal step repairs, along."),
          stop("linear_stop_cfm", "m/N", 0, "How far a lock or limit yields per load, along."),
          stop("angular_stop_erp", "", 0.2, "Part of a lock's or limit's error that one internal step repairs, about."),
          stop("angular_stop_cfm", "rad/(N·m)", 0, "How far a lock or limit yields per load, about."),
          live(hashed(readout(number("value", "m | rad", 0, -kUnbounded, kUnbounded, "Where the own axis stands.")))),
          live(hashed(
              readout(number("speed", "m/s | rad/s", 0, -kUnbounded, kUnbounded, "How fast the own axis moves.")))),
          live(hashed(readout(vec3("angles", "rad", {0, 0, 0}, -kUnbounded, kUnbounded,
                                   "Angles in the joint's own order, the one its limits and servos act in.")))),
          live(hashed(readout(vec3("offsets", "m", {0, 0, 0}, -kUnbounded, kUnbounded,
                                   "Shift of the child along the parent's joint axes.")))),
          live(hashed(readout(vec3("relrot", "rad", {0, 0, 0}, -kUnbounded, kUnbounded,
                                   "Child's joint frame in the parent's, R = Rz·Ry·Rx, as the stream has it.")))),
          live(hashed(readout(vec3("position", "m", {0, 0, 0}, -kUnbounded, kUnbounded,
                                   "The joint's point on the parent's side, world.")))),
          live(
              hashed(readout(quat("rotation", "The child's joint frame, world, its own rotation included: x y z w.")))),
          view<&Joint::read_axis>(readout(vec3("axis", "", {0, 0, 1}, -1, 1, "The own axis, world."))),
      });
  return table;
}

std::unique_ptr<JointConstraint> Joint::make_constraint(Part& parent, Part& child, const JointSpec& spec) {
  const BulletMemory::Scope scope(&parent.body().world().bullet_memory());
  return std::make_unique<JointConstraint>(parent.rigid(), child.rigid(),
                                           to_bt(parent.geometry()->frame.inverse() * spec.frame_in_parent),
                                           to_bt(child.geometry()->frame.inverse() * spec.frame_in_child));
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
    const bool limits_it = axis == own_axis() && spec.limited;
    const bool is_free = free_by_type(spec.type, axis) && !limits_it;
    store.tell(id_, *limit_rows().lower[half])[axis % 3] = limits_it ? spec.lower : is_free ? 1 : 0;
    store.tell(id_, *limit_rows().upper[half])[axis % 3] = limits_it ? spec.upper : is_free ? -1 : 0;
  }
}

Joint::~Joint() {
  leave();
  body_.store().remove(id_);
}

void Joint::enter() {
  if (std::exchange(in_world_, true)) return;
  constraint_->restart_goals();
  body_.world().bullet().addConstraint(constraint_.get());
}

void Joint::couple_to(Joint& leader) {
  const BulletMemory::Scope scope(&body_.world().bullet_memory());
  mimic_gear_ = std::make_unique<GearConstraint>(*leader.constraint_, leader.own_axis(), *constraint_, own_axis());
  mimic_gear_->set({spec_.mimic->multiplier, spec_.mimic->offset, 0});
}

void Joint::enter_mimic_gear() {
  if (mimic_gear_ == nullptr || std::exchange(gear_in_world_, true)) return;
  body_.world().bullet().addConstraint(mimic_gear_.get(), false);
}

void Joint::leave() {
  if (std::exchange(gear_in_world_, false)) body_.world().bullet().removeConstraint(mimic_gear_.get());
  if (std::exchange(in_world_, false)) body_.world().bullet().removeConstraint(constraint_.get());
}

void Joint::wake() {
  if (!in_world_) return;
  SleepTracker& sleep = body_.world().bullet().sleep();
  if (!parent_.is_static()) sleep.wake(parent_.rigid());
  if (!child_.is_static()) sleep.wake(child_.rigid());
}

const std::string& Joint::name() const { return body_.store().name(id_); }

int Joint::own_axis() const {
  if (spec_.type == JointType::fixed) return -1;
  return spec_.type == JointType::prismatic ? 2 : 5;
}

double Joint::value() const { return own_axis() < 0 ? 0 : constraint_->value(own_axis()); }

void Joint::effect_limits() {
  const Store& store = body_.store();
  const unsigned before = open_;
  unsigned open = 0;
  for (int axis = 0; axis < 6; axis++) {
    const auto half = static_cast<std::size_t>(axis / 3);
    const auto number = [&](const std::array<const Row*, 2>& rows) {
      return static_cast<float>(store.values(id_, *rows[half])[axis % 3]);
    };
    AxisSettings settings = constraint_->axis(axis);
    settings.lower = number(limit_rows().lower);
    settings.upper = number(limit_rows().upper);
    settings.stop_erp = number(limit_rows().stop_erp);
    settings.stop_cfm = number(limit_rows().stop_cfm);
    settings.friction = axis == own_axis() ? static_cast<float>(spec_.friction) : 0;
    if (!(settings == constraint_->axis(axis))) wake();
    constraint_->set_axis(axis, settings);
    if (!settings.locked()) open |= 1u << axis;
  }
  open_ = static_cast<std::uint8_t>(open);
  if ((open & ~before) != 0 && motor_ != nullptr) motor_->effect_axes();
}

void Joint::read_anew() {
  // told ones, since the constraint's may be no numbers after a blow-up
  const double* told = body_.store().live_block(id_) + joint_live_rows().angles->offset;
  constraint_->reset({told[0], told[1], told[2]});
  if (mimic_gear_ != nullptr) mimic_gear_->reset();
  torn_ticks_ = 0;
  tell();
}

void Joint::take_start() { start_angles_ = constraint_->angles(); }

void Joint::go_to_start() {
  Store& store = body_.store();
  store.keep(id_, *joint_live_rows().angles);
  put(store.live_block(id_) + joint_live_rows().angles->offset, start_angles_);
}

void Joint::tell() {
  double* live = body_.store().live_block(id_);
  const JointLiveRows& rows = joint_live_rows();
  const btTransform& parent = parent_.rigid().getCenterOfMassTransform();
  const btTransform& frame = constraint_->frame_in_parent();
  const int own = own_axis();
  live[rows.value->offset] = own < 0 ? 0 : constraint_->value(own);
  live[rows.speed->offset] = own < 0 ? 0 : constraint_->rate(own);
  put(live + rows.angles->offset, constraint_->angles());
  put(live + rows.offsets->offset, constraint_->offsets());
  put(live + rows.relrot->offset, stream_angles(*constraint_));
  put(live + rows.position->offset, from_bt(parent * frame.getOrigin()));
  const Quat q = child_.pose().rotation * spec_.frame_in_child.rotation;
  double* rotation = live + rows.rotation->offset;
  rotation[0] = q.x;
  rotation[1] = q.y;
  rotation[2] = q.z;
  rotation[3] = q.w;
}

double Joint::gap() const {
  const Vec3 offsets = constraint_->offsets();
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    if (is_open(axis) || constraint_->axis(axis).stop_cfm > 0) continue;
    const double off = offsets[axis] - static_cast<double>(constraint_->axis(axis).lower);
    sum += off * off;
  }
  return std::sqrt(sum);
}

bool Joint::comes_apart() {
  const double apart = gap();
  if (!(apart > kLeastGap)) {
    torn_ticks_ = 0;
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
  torn_ticks_ = apart > size ? torn_ticks_ + 1 : 0;
  return torn_ticks_ >= kTornTicks;
}

void Joint::read_axis(double* out) const {
  const btMatrix3x3& frame = constraint_->frame_in_parent().getBasis();
  put(out, from_bt(parent_.rigid().getCenterOfMassTransform().getBasis() * frame.getColumn(2)));
}

}  // namespace limber

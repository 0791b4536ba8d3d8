// GearConstraint: its row, from the Jacobians of two joints.
#include "sim/gear_constraint.h"

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

/// Part of the position error that one internal step repairs.
constexpr double kRepair = 0.5;
/// Fastest repair, rad/s or m/s, as for a joint's locks.
constexpr double kFastestRepair = 20;
/// Softness relative to the mobility of the bodies alone. Gears that contradict each other get bounded impulses; under
/// load the position error is far below 1e-6 rad.
constexpr double kSoftness = 1e-8;
/// Part of the last step's impulse that the sweeps start from, as for joints.
constexpr float kWarmStart = 0.5f;

// Of a joint's two bodies one that moves: the joint connects it with the other.
btRigidBody& moving_body(JointConstraint& joint) {
  return joint.getRigidBodyB().getInvMass() > 0 ? joint.getRigidBodyB() : joint.getRigidBodyA();
}

}  // namespace

GearConstraint::GearConstraint(JointConstraint& joint_a, int axis_a, JointConstraint& joint_b, int axis_b)
    : btTypedConstraint(kType, moving_body(joint_a), moving_body(joint_b)),
      joint_a_(&joint_a),
      joint_b_(&joint_b),
      axis_a_(axis_a),
      axis_b_(axis_b) {}

void GearConstraint::getInfo1(btConstraintInfo1* info) { *info = {0, 0}; }

double GearConstraint::error() const {
  return settings_.ratio * joint_a_->value(axis_a_) + settings_.offset - joint_b_->value(axis_b_);
}

void GearConstraint::add_side(btRigidBody& body, const btVector3& linear, const btVector3& angular) {
  if (body.getInvMass() == 0) return;
  auto* const end = sides_.data() + side_count_;
  auto* side = std::find_if(sides_.data(), end, [&](const Side& s) { return s.body == &body; });
  if (side == end) {
    *side = {};
    side->body = &body;
    side_count_++;
  }
  side->linear += linear;
  side->angular += angular;
}

void GearConstraint::add_sides(JointConstraint& joint, int axis, double factor) {
  const JointConstraint::Jacobian j = joint.jacobian(axis);
  const btScalar f = to_scalar(factor);
  const btVector3 linear = axis < 3 ? j.linear * f : btVector3(0, 0, 0);
  add_side(joint.getRigidBodyA(), -linear, j.angular_a * f);
  add_side(joint.getRigidBodyB(), linear, j.angular_b * f);
}

void GearConstraint::plan(btScalar h) {
  h_ = h;
  side_count_ = 0;
  add_sides(*joint_a_, axis_a_, -settings_.ratio);
  add_sides(*joint_b_, axis_b_, 1);
  double mobility = 0;
  for (const Side& side : sides()) {
    const btVector3 turn = side.body->getInvInertiaTensorWorld() * side.angular * side.body->getAngularFactor();
    mobility += static_cast<double>(side.linear.length2() * side.body->getInvMass() + turn.dot(side.angular));
  }
  const double step = static_cast<double>(h);
  row_.velocity = std::clamp(kRepair * error() / step, -kFastestRepair, kFastestRepair);
  row_.mobility = mobility;
  row_.softness = kSoftness * mobility;
  row_.bound = settings_.max_force > 0 ? settings_.max_force * step : 2 * kTreeInfinity;
  warm_ = kWarmStart * std::exchange(last_impulse_, 0.0f);
}

void GearConstraint::take_impulse(double impulse) {
  last_impulse_ = static_cast<float>(std::clamp(impulse, -1e12, 1e12));
  tick_impulse_ += last_impulse_;
  tick_time_ += h_;
}

void GearConstraint::end_tick() {
  applied_ = tick_time_ > 0 ? tick_impulse_ / tick_time_ : 0;
  const bool missed = settings_.max_force == 0 && std::fabs(error()) > kMiss;
  missed_for_ = missed ? missed_for_ + tick_time_ : 0;
  tick_impulse_ = tick_time_ = 0;
}

}  // namespace limber

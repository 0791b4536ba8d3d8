// GearConstraint: computes its row from the Jacobians of two joints.
#include "sim/bullet/joints/gear_constraint.h"

#include <algorithm>
#include <cmath>

#include "sim/solver/forest/axis_active_set.h"

namespace limber::sim::bullet {
namespace {

/// Fraction of the position error that one substep corrects.
constexpr double kCorrectedFraction = 0.5;
/// Fastest correction, rad/s or m/s, as for a joint's locks.
constexpr double kMaxCorrectionSpeed = 20;
/// Softness relative to the mobility of the bodies alone. It bounds the impulses of gears that contradict each other;
/// the position error that it allows under load is far below 1e-6 rad.
constexpr double kSoftness = 1e-8;

// Returns one dynamic body of the joint; the joint itself connects the other one to the island.
btRigidBody& moving_body(JointConstraint& joint) {
  return joint.getRigidBodyB().getInvMass() > 0 ? joint.getRigidBodyB() : joint.getRigidBodyA();
}

}  // namespace

GearConstraint::GearConstraint(JointConstraint& joint_a, int axis_a, JointConstraint& joint_b, int axis_b)
    : CoupledConstraint(kType, moving_body(joint_a), moving_body(joint_b), 4),
      joint_a_(&joint_a),
      joint_b_(&joint_b),
      axis_a_(axis_a),
      axis_b_(axis_b) {}

double GearConstraint::error() const {
  return settings_.ratio * joint_a_->value(axis_a_) + settings_.offset - joint_b_->value(axis_b_);
}

void GearConstraint::add_jacobians(JointConstraint& joint, int axis, double factor) {
  const AxisJacobian j = joint.pose().jacobian(axis);
  const btScalar f = to_scalar(factor);
  const btVector3 linear = axis < 3 ? j.linear * f : btVector3(0, 0, 0);
  add_jacobian(joint.getRigidBodyA(), -linear, j.angular_a * f);
  add_jacobian(joint.getRigidBodyB(), linear, j.angular_b * f);
}

void GearConstraint::plan(btScalar h) {
  begin_row(h);
  add_jacobians(*joint_a_, axis_a_, -settings_.ratio);
  add_jacobians(*joint_b_, axis_b_, 1);
  const double step = static_cast<double>(h);
  row_.velocity =
      std::clamp(kCorrectedFraction * error() / step, -kMaxCorrectionSpeed, kMaxCorrectionSpeed) - static_rate();
  row_.mobility = mobility();
  row_.softness = kSoftness * row_.mobility;
  row_.upper = settings_.max_force > 0 ? settings_.max_force * step : 2 * solver::AxisRow::kInfinity;
  row_.lower = -row_.upper;
}

void GearConstraint::reset() {
  CoupledConstraint::reset();
  slip_time_ = 0;
}

void GearConstraint::end_tick() {
  const bool is_off = settings_.max_force == 0 && std::fabs(error()) > kSlipThreshold;
  slip_time_ = is_off ? slip_time_ + tick_time() : 0;
  CoupledConstraint::end_tick();
}

}  // namespace limber::sim::bullet

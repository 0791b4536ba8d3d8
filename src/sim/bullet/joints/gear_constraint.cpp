// GearConstraint: computes its row from the Jacobians of two joints.
#include "sim/bullet/joints/gear_constraint.h"

#include <algorithm>
#include <cmath>

#include "sim/bullet/surface_motion.h"
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
/// Warm-start factor of the sweeps, as for joints.
constexpr float kGearWarmStart = 0.5f;

// Returns one dynamic body of the joint; the joint itself connects the other one to the island.
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

void GearConstraint::add_jacobian(btRigidBody& body, const btVector3& linear, const btVector3& angular) {
  if (body.getInvMass() == 0) {
    if (is_moving_static(body)) {
      static_rate_ +=
          static_cast<double>(linear.dot(body.getLinearVelocity()) + angular.dot(body.getAngularVelocity()));
    }
    return;
  }
  auto* const end = jacobians_.data() + jacobian_count_;
  auto* jacobian = std::find_if(jacobians_.data(), end, [&](const BodyJacobian& s) { return s.body == &body; });
  if (jacobian == end) {
    *jacobian = {};
    jacobian->body = &body;
    jacobian_count_++;
  }
  jacobian->linear += linear;
  jacobian->angular += angular;
}

void GearConstraint::add_jacobians(JointConstraint& joint, int axis, double factor) {
  const AxisJacobian j = joint.pose().jacobian(axis);
  const btScalar f = to_scalar(factor);
  const btVector3 linear = axis < 3 ? j.linear * f : btVector3(0, 0, 0);
  add_jacobian(joint.getRigidBodyA(), -linear, j.angular_a * f);
  add_jacobian(joint.getRigidBodyB(), linear, j.angular_b * f);
}

void GearConstraint::plan(btScalar h) {
  h_ = h;
  jacobian_count_ = 0;
  static_rate_ = 0;
  add_jacobians(*joint_a_, axis_a_, -settings_.ratio);
  add_jacobians(*joint_b_, axis_b_, 1);
  double mobility = 0;
  for (const BodyJacobian& jacobian : jacobians()) {
    const btVector3 angular_response =
        jacobian.body->getInvInertiaTensorWorld() * jacobian.angular * jacobian.body->getAngularFactor();
    mobility += static_cast<double>(jacobian.linear.length2() * jacobian.body->getInvMass() +
                                    angular_response.dot(jacobian.angular));
  }
  const double step = static_cast<double>(h);
  row_.velocity =
      std::clamp(kCorrectedFraction * error() / step, -kMaxCorrectionSpeed, kMaxCorrectionSpeed) - static_rate_;
  row_.mobility = mobility;
  row_.softness = kSoftness * mobility;
  row_.bound = settings_.max_force > 0 ? settings_.max_force * step : 2 * solver::AxisRow::kInfinity;
  warm_impulse_ = kGearWarmStart * std::exchange(last_impulse_, 0.0f);
}

void GearConstraint::set_impulse(double impulse) {
  last_impulse_ = static_cast<float>(std::clamp(impulse, -1e12, 1e12));
  tick_impulse_ += last_impulse_;
  tick_time_ += h_;
}

void GearConstraint::end_tick() {
  applied_ = tick_time_ > 0 ? tick_impulse_ / tick_time_ : 0;
  const bool is_off = settings_.max_force == 0 && std::fabs(error()) > kSlipThreshold;
  slip_time_ = is_off ? slip_time_ + tick_time_ : 0;
  tick_impulse_ = tick_time_ = 0;
}

}  // namespace limber::sim::bullet

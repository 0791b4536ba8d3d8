// CoupledConstraint: its Jacobians, and the impulses of a tick.
#include "sim/bullet/joints/coupled_constraint.h"

#include <algorithm>
#include <utility>

#include "sim/bullet/surface_motion.h"

namespace limber::sim::bullet {
namespace {

/// Warm-start factor of the sweeps, as for joints.
constexpr float kCoupledWarmStart = 0.5f;

}  // namespace

CoupledConstraint::CoupledConstraint(btTypedConstraintType type, btRigidBody& a, btRigidBody& b, int max_bodies)
    : btTypedConstraint(type, a, b) {
  jacobians_.resize(max_bodies);
}

void CoupledConstraint::begin_row(btScalar h) {
  h_ = h;
  jacobian_count_ = 0;
  static_rate_ = 0;
  warm_impulse_ = kCoupledWarmStart * std::exchange(last_impulse_, 0.0f);
}

void CoupledConstraint::add_jacobian(btRigidBody& body, const btVector3& linear, const btVector3& angular) {
  if (body.getInvMass() == 0) {
    if (is_moving_static(body)) {
      static_rate_ +=
          static_cast<double>(linear.dot(body.getLinearVelocity()) + angular.dot(body.getAngularVelocity()));
    }
    return;
  }
  BodyJacobian* const first = &jacobians_[0];
  BodyJacobian* const end = first + jacobian_count_;
  BodyJacobian* jacobian = std::find_if(first, end, [&](const BodyJacobian& s) { return s.body == &body; });
  if (jacobian == end) {
    *jacobian = {};
    jacobian->body = &body;
    jacobian_count_++;
  }
  jacobian->linear += linear;
  jacobian->angular += angular;
}

double CoupledConstraint::mobility() const {
  double mobility = 0;
  for (const BodyJacobian& jacobian : jacobians()) {
    const btVector3 angular_response =
        jacobian.body->getInvInertiaTensorWorld() * jacobian.angular * jacobian.body->getAngularFactor();
    mobility += static_cast<double>(jacobian.linear.length2() * jacobian.body->getInvMass() +
                                    angular_response.dot(jacobian.angular));
  }
  return mobility;
}

void CoupledConstraint::set_impulse(double impulse) {
  last_impulse_ = static_cast<float>(std::clamp(impulse, -1e12, 1e12));
  tick_impulse_ += last_impulse_;
  tick_time_ += h_;
}

void CoupledConstraint::end_tick() {
  applied_ = tick_time_ > 0 ? tick_impulse_ / tick_time_ : 0;
  tick_impulse_ = tick_time_ = 0;
}

}  // namespace limber::sim::bullet

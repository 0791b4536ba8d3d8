// BallLimits: distances to the limits, and the rows that stop the joint there.
#include "sim/bullet/joints/ball_limits.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::bullet {
namespace {

/// Least cosine of half the swing with which the twist is limited: up to a swing of 3.1 rad. Beyond, a small rotation
/// changes the twist by any amount.
constexpr double kMinHalfSwingCosine = 0.02;

}  // namespace

/// The joint at the start of a substep.
struct BallLimits::Step {
  const JointPose& pose;
  const Stops& stops;
  btScalar h;
  SwingTwist now;
  btVector3 velocity;  // of the child relative to the parent, world

  btVector3 to_world(const Vec3& v) const {
    return pose.linear_axis(0) * to_scalar(v.x) + pose.linear_axis(1) * to_scalar(v.y) +
           pose.linear_axis(2) * to_scalar(v.z);
  }
  // An axis of the joint, or, where it is undefined, that of the present motion perpendicular to `normal`.
  btVector3 axis_or_motion(const Vec3& axis, const btVector3& normal) const {
    if (axis != Vec3(0)) return to_world(axis);
    const btVector3 motion = velocity - normal * normal.dot(velocity);
    return motion.length2() > btScalar(1e-12) ? motion.normalized() : pose.linear_axis(0);
  }
  // An angle that is limited to a circle or sphere grows while the joint moves along the limit: by curvature·u²/2·h²
  // per step, with the speed u along it. Without this term, a joint that circles along its cone would drift outwards.
  btScalar bend(double curvature, btScalar speed2) const {
    const btScalar speed = std::sqrt(std::max(speed2, btScalar(0)));
    return std::clamp(to_scalar(curvature) * speed * speed * h / 2, -speed, speed);
  }
};

void BallLimits::plan(const JointPose& pose, const Stops& stops, btScalar h) {
  count_ = 0;
  if (!settings_.any()) return;
  plan_all({pose, stops, h, swing_twist(pose.rotation()), pose.angular_velocity()});
  reset();
}

void BallLimits::plan_all(const Step& step) {
  if (settings_.cone < BallLimitSettings::kFree) plan_cone(step);
  if (settings_.twist_lower <= settings_.twist_upper) plan_twist(step);
  if (settings_.angle < BallLimitSettings::kFree) plan_angle(step);
}

// Adds the row of a limit whose distance changes at the rate axis·velocity.
void BallLimits::add_limit(const Step& step, Slot slot, const btVector3& axis, double distance, btScalar bend) {
  const btScalar soft = stop_softness(step.stops.stop_erp, step.stops.stop_cfm, step.h);
  const LimitState limit{to_scalar(distance), axis.dot(step.velocity), kAngularLimitMargin, step.stops.stop_erp, soft,
                         step.stops.bounce,   repair_impulse_[slot]};
  if (!limit_is_near(limit, step.h)) return;
  const LimitRow row = limit_row(limit, step.h);
  rows_[at(count_++)] = {
      {row.min_speed + bend, row.softness, -row.repair_impulse, JointRow::kUnbounded, slot, row.kind}, axis};
}

void BallLimits::plan_cone(const Step& step) {
  const SwingTwist& now = step.now;
  const btVector3 axis = step.axis_or_motion(now.swing_axis, step.pose.linear_axis(2));
  const btScalar rate = axis.dot(step.velocity);
  const btScalar speed2 = step.velocity.cross(step.to_world(now.z)).length2() - rate * rate;
  const double sine = std::max(fixed::hypot(now.z.x, now.z.y), 1e-6);
  add_limit(step, cone, -axis, static_cast<double>(settings_.cone) - now.swing, step.bend(now.z.z / sine, speed2));
}

void BallLimits::plan_twist(const Step& step) {
  if (!((1 + step.now.z.z) / 2 > kMinHalfSwingCosine * kMinHalfSwingCosine)) return;
  const auto lower = static_cast<double>(settings_.twist_lower);
  const auto upper = static_cast<double>(settings_.twist_upper);
  const double twist = turned_into(step.now.twist, lower, upper);
  const btVector3 axis = step.to_world(step.now.twist_axis);
  if (lower < upper) {
    add_limit(step, twist_lower, axis, twist - lower, 0);
    add_limit(step, twist_upper, -axis, upper - twist, 0);
    return;
  }
  const btScalar soft = stop_softness(step.stops.stop_erp, step.stops.stop_cfm, step.h);
  const btScalar repair = to_scalar(lower - twist) * step.stops.stop_erp / step.h;
  const btScalar speed = soft == 0 ? std::clamp(repair, -kMaxLockRepairSpeed, kMaxLockRepairSpeed) : repair;
  rows_[at(count_++)] = {{speed, soft, -JointRow::kUnbounded, JointRow::kUnbounded, twist_lower, JointRow::Kind::lock},
                         axis};
}

void BallLimits::plan_angle(const Step& step) {
  const SwingTwist& now = step.now;
  const btVector3 axis = step.axis_or_motion(now.angle_axis, btVector3(0, 0, 0));
  const btScalar rate = axis.dot(step.velocity);
  const double half_tangent = std::max(fixed::tan(now.angle / 2), 1e-6);
  add_limit(step, angle, -axis, static_cast<double>(settings_.angle) - now.angle,
            step.bend(0.5 / half_tangent, step.velocity.length2() - rate * rate));
}

void BallLimits::set_impulse(int i, btScalar impulse, btScalar inverse_mobility) {
  const JointRow& row = rows_[at(i)].row;
  if (row.kind == JointRow::Kind::repair) {
    repair_impulse_[row.axis] = std::min(std::fabs(impulse), std::fabs(row.velocity) * inverse_mobility);
  }
}

}  // namespace limber::sim::bullet

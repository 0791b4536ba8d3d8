// TendonConstraint: its geometry, and the row that integrates its spring implicitly.
#include "sim/bullet/joints/tendon_constraint.h"

#include <algorithm>

#include "sim/solver/forest/axis_active_set.h"

namespace limber::sim::bullet {
namespace {

/// Segments shorter than this have no direction, m.
constexpr double kMinSegment = 1e-9;
/// Weight of the change of speed in the step. With 1/4, Newmark's method (Newmark, A method of computation for
/// structural dynamics, 1959) is stable for any stiffness, and neither adds nor removes energy.
constexpr double kNewmark = 0.25;
/// Largest ratio of softness to mobility; above it, the tension is nearly independent of the motion in the step, and is
/// prescribed.
constexpr double kMaxSoftness = 1e6;

}  // namespace

TendonConstraint::TendonConstraint(solver::IndexedSpan<const TendonPoint> points)
    : CoupledConstraint(kType, *points[0].body, *points[points.size() - 1].body, points.size()) {
  points_.resize(points.size());
  for (int i = 0; i < points.size(); ++i) points_[i] = points[i];
}

Vec3 TendonConstraint::world_point(int i) const {
  const btTransform& pose = points_[i].body->getWorldTransform();
  const Vec3& p = points_[i].position;
  Vec3 out = from_bt(pose.getOrigin());
  for (int axis = 0; axis < 3; ++axis) out[axis] += glm::dot(from_bt(pose.getBasis()[axis]), p);
  return out;
}

TendonConstraint::Measure TendonConstraint::measure() const {
  Measure out;
  const auto velocity = [this](int i, const Vec3& point) {
    const btRigidBody& body = *points_[i].body;
    return from_bt(body.getLinearVelocity()) +
           glm::cross(from_bt(body.getAngularVelocity()), point - from_bt(body.getWorldTransform().getOrigin()));
  };
  Vec3 from = world_point(0);
  Vec3 from_velocity = velocity(0, from);
  for (int i = 1; i < points_.size(); ++i) {
    const Vec3 to = world_point(i);
    const Vec3 to_velocity = velocity(i, to);
    const double length = glm::length(to - from);
    out.length += length;
    if (length > kMinSegment) out.speed += glm::dot(to - from, to_velocity - from_velocity) / length;
    from = to;
    from_velocity = to_velocity;
  }
  return out;
}

void TendonConstraint::plan(btScalar h) {
  begin_row(h);
  // a unit tension pulls each point towards its two neighbors
  Vec3 before(0);
  Vec3 point = world_point(0);
  for (int i = 0; i < points_.size(); ++i) {
    Vec3 next = point;
    Vec3 after(0);
    if (i + 1 < points_.size()) {
      next = world_point(i + 1);
      const double length = glm::length(next - point);
      if (length > kMinSegment) after = (next - point) / length;
    }
    btRigidBody& body = *points_[i].body;
    const Vec3 pull = after - before;
    const Vec3 arm = point - from_bt(body.getWorldTransform().getOrigin());
    add_jacobian(body, to_bt(pull), to_bt(glm::cross(arm, pull)));
    before = after;
    point = next;
  }
  plan_tension(measure(), static_cast<double>(h));
}

// With the stretch x, the speeds of the length v before and w after the step:
//   tension = stiffness·(x + h·(θ·w + (w - v)/4)) + damping·w + added tension.
// θ = 0 conserves the energy of oscillations, θ = 1 (implicit Euler) removes that of those that the step can't resolve.
// θ increases with the ratio of the step to the period that the bodies would have without joints. If a cable becomes
// slack or taut in the step, θ is 1: the step must not begin with a stretch that no force has resisted.
void TendonConstraint::plan_tension(const Measure& now, double h) {
  const TendonSettings& s = settings_;
  row_.mobility = mobility();
  const double max_impulse = s.max_tension > 0 ? s.max_tension * h : 2 * solver::AxisRow::kInfinity;
  const double added = s.tension * h;
  row_.upper = max_impulse;
  row_.lower = s.pushes ? -max_impulse : std::min(added, max_impulse);
  const double stretch = now.length - s.rest_length;
  const bool slack = !s.pushes && stretch <= 0;
  const bool crosses = slack || (!s.pushes && stretch + h * now.speed <= 0);
  const double ratio = h * h * s.stiffness * row_.mobility;
  const double theta = crosses ? 1 : ratio / (1 + ratio);
  const double newmark = crosses ? 0 : kNewmark;
  const double damping = slack ? 0 : s.damping;
  const double gain = h * s.stiffness * (theta + newmark) + damping;  // tension per speed after the step
  const double force = s.stiffness * (stretch - h * newmark * now.speed) + s.tension;
  if (gain * h * row_.mobility * kMaxSoftness > 1) {
    row_.softness = 1 / (h * gain);
    row_.velocity = force / gain - static_rate();
    return;
  }
  row_.softness = row_.mobility;
  row_.velocity = 0;
  row_.lower = row_.upper = std::clamp((force + gain * now.speed) * h, row_.lower, row_.upper);
}

}  // namespace limber::sim::bullet

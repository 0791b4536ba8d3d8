// TendonConstraint: a massless cable that slides through points on bodies, with the same tension along its length. One
// solver row: its rate is the speed at which the cable shortens, its impulse the tension times the step.
#pragma once

#include "base/vec.h"
#include "sim/bullet/joints/coupled_constraint.h"

namespace limber::sim::bullet {

struct TendonSettings {
  double stiffness = 0;    ///< N/m
  double damping = 0;      ///< N·s/m
  double rest_length = 0;  ///< m
  double tension = 0;      ///< Added tension, N.
  double max_tension = 0;  ///< N; 0: no limit.
  bool pushes = false;     ///< True: a spring that also pushes.
  bool operator==(const TendonSettings&) const = default;
};

/// A point on a body, in the frame of its center of mass.
struct TendonPoint {
  btRigidBody* body = nullptr;
  Vec3 position{0};
};

/// tension = stiffness·(length - rest_length) + damping·(speed of the length) while this is positive (or `pushes`) and
/// the length exceeds the rest length, plus the added tension. The bodies must be in the world whenever it is, and
/// outlive it. [sim]
class TendonConstraint final : public CoupledConstraint {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// At least two points.
  explicit TendonConstraint(solver::IndexedSpan<const TendonPoint> points);

  void set(const TendonSettings& settings) { settings_ = settings; }
  const TendonSettings& settings() const { return settings_; }
  /// Length of the polyline through the points in the present poses, and its rate of change.
  struct Measure {
    double length = 0;
    double speed = 0;
  };
  Measure measure() const;

  void plan(btScalar h) override;

  /// Calls f(body, other) for pairs of bodies that together connect all its bodies; the first one of each is dynamic if
  /// any is.
  template <class F>
  void for_each_link(F&& f) const {
    int anchor = 0;
    for (int i = 0; i < points_.size() && points_[anchor].body->isStaticObject(); ++i) anchor = i;
    if (points_[anchor].body->isStaticObject()) anchor = 0;
    for (int i = 0; i < points_.size(); ++i) {
      if (i != anchor) f(*points_[anchor].body, *points_[i].body);
    }
  }

  static constexpr auto kType = CoupledConstraint::kLastType;

 private:
  Vec3 world_point(int i) const;
  void plan_tension(const Measure& now, double h);

  btAlignedObjectArray<TendonPoint> points_;
  TendonSettings settings_;
};

inline bool is_tendon(const btTypedConstraint& constraint) {
  return constraint.getConstraintType() == TendonConstraint::kType;
}

/// Calls f(a, b) for the pairs of bodies that a joint, gear or tendon connects; a tendon's first one is dynamic if any
/// of its bodies is.
template <class F>
void for_each_link(const btTypedConstraint& constraint, F&& f) {
  if (is_tendon(constraint)) {
    static_cast<const TendonConstraint&>(constraint).for_each_link(f);
  } else {
    f(constraint.getRigidBodyA(), constraint.getRigidBodyB());
  }
}

}  // namespace limber::sim::bullet

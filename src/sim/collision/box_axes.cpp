// Separating-axis test of two boxes: three axes of each, and the cross products of their edges.
#include "sim/collision/box_axes.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::collision {
namespace {

/// An axis of an edge pair or of the second box is preferred only if its separation is larger by this (relative, and in
/// m), which keeps the choice stable from step to step.
constexpr btScalar kMinRelativeGain = 0.02F;
constexpr btScalar kMinGain = 1e-4F;

// Decrease of the signed `distance` along an axis if the second box moves by `motion` along it.
btScalar closing_distance(btScalar distance, btScalar motion) {
  return std::max(distance > 0 ? -motion : motion, btScalar(0));
}

// Tests axes one by one; each function returns true if its axis separates the boxes until the end of the step.
class AxisTest {
 public:
  AxisTest(const Box& a, const Box& b, const ManifoldBuilder& points)
      : a_(a),
        b_(b),
        max_distance_(points.max_rotation_distance()),
        motion_a_(points.relative_motion() * a.axes),
        motion_b_(points.relative_motion() * b.axes),
        from_a_((b.center - a.center) * a.axes),
        from_b_((b.center - a.center) * b.axes),
        rotation_(a.axes.transposeTimes(b.axes)) {
    for (int i = 0; i < 3; ++i) abs_rotation_[i] = rotation_[i].absolute();
  }

  bool separates_face_a(int i) {
    const btScalar separation = std::fabs(from_a_[i]) - a_.half[i] - abs_rotation_[i].dot(b_.half);
    if (separation - closing_distance(from_a_[i], motion_a_[i]) > max_distance_) return true;
    if (separation > best_.separation + (best_.kind == BoxAxis::none ? 0 : kMinGain)) {
      best_ = {BoxAxis::face_a, a_.axis(i) * (from_a_[i] > 0 ? btScalar(-1) : btScalar(1)), separation, 0, 0};
    }
    return false;
  }
  bool separates_face_b(int i) {
    const btScalar separation = std::fabs(from_b_[i]) - b_.half[i] - abs_rotation_.getColumn(i).dot(a_.half);
    if (separation - closing_distance(from_b_[i], motion_b_[i]) > max_distance_) return true;
    if (separation > preferred_separation()) {
      best_ = {BoxAxis::face_b, b_.axis(i) * (from_b_[i] > 0 ? btScalar(-1) : btScalar(1)), separation, 0, 0};
    }
    return false;
  }
  void begin_edges() { min_edge_separation_ = preferred_separation(); }
  // The axis is the cross product of a's axis i and b's axis k.
  bool separates_edges(int i, int k) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    const int k1 = (k + 1) % 3;
    const int k2 = (k + 2) % 3;
    // in the frame of a, where the length of the axis is the sine of the edges' angle
    const btScalar sine2 = 1 - rotation_[i][k] * rotation_[i][k];
    if (sine2 < 1e-4F) return false;
    const btScalar along = from_a_[i2] * rotation_[i1][k] - from_a_[i1] * rotation_[i2][k];
    const btScalar radius_a = a_.half[i1] * abs_rotation_[i2][k] + a_.half[i2] * abs_rotation_[i1][k];
    const btScalar radius_b = b_.half[k1] * abs_rotation_[i][k2] + b_.half[k2] * abs_rotation_[i][k1];
    const btScalar scaled = std::fabs(along) - radius_a - radius_b;  // times the sine
    const btScalar threshold = best_.kind == BoxAxis::edges
                                   ? std::max(min_edge_separation_, best_.separation + kMinGain)
                                   : min_edge_separation_;
    if (scaled <= std::min(threshold, btScalar(0))) return false;
    const btScalar inverse = 1 / std::sqrt(sine2);
    const btScalar separation = scaled * inverse;
    const btScalar motion = (motion_a_[i2] * rotation_[i1][k] - motion_a_[i1] * rotation_[i2][k]) * inverse;
    if (separation - closing_distance(along, motion) > max_distance_) return true;
    if (separation > threshold) {
      btVector3 normal = a_.axis(i).cross(b_.axis(k)) * inverse;
      if (normal.dot(b_.center - a_.center) > 0) normal = -normal;
      best_ = {BoxAxis::edges, normal, separation, i, k};
    }
    return false;
  }

  const BoxAxis& best() const { return best_; }

 private:
  // Separation above which an axis other than a's is preferred to the best one.
  btScalar preferred_separation() const {
    return best_.separation + kMinGain + kMinRelativeGain * std::fabs(best_.separation);
  }

  const Box& a_;
  const Box& b_;
  const btScalar max_distance_;
  const btVector3 motion_a_;  // in the frames of the boxes
  const btVector3 motion_b_;
  const btVector3 from_a_;  // from center to center, in the frames of the boxes
  const btVector3 from_b_;
  const btMatrix3x3 rotation_;  // axes of b in the frame of a
  btMatrix3x3 abs_rotation_;
  BoxAxis best_;
  btScalar min_edge_separation_ = 0;
};

}  // namespace

bool SeparatingAxis::separates(const Box& a, const Box& b, const ManifoldBuilder& points) const {
  if (a_ == kNone && b_ == kNone) return false;
  const btVector3 direction = b_ == kNone ? a.axis(a_) : a_ == kNone ? b.axis(b_) : a.axis(a_).cross(b.axis(b_));
  const btScalar radius = (direction * a.axes).absolute().dot(a.half) + (direction * b.axes).absolute().dot(b.half);
  const btScalar center_distance = direction.dot(b.center - a.center);
  const btScalar length = a_ == kNone || b_ == kNone ? btScalar(1) : direction.length();
  return std::fabs(center_distance) - radius -
             closing_distance(center_distance, direction.dot(points.relative_motion())) >
         (points.max_rotation_distance() + kMinGain) * length;
}

BoxAxis SeparatingAxis::find(const Box& a, const Box& b, const ManifoldBuilder& points) {
  AxisTest test(a, b, points);
  const auto separated_along = [this](int first, int second) {
    a_ = first;
    b_ = second;
    return BoxAxis{};
  };
  for (int i = 0; i < 3; ++i) {
    if (test.separates_face_a(i)) return separated_along(i, kNone);
  }
  for (int i = 0; i < 3; ++i) {
    if (test.separates_face_b(i)) return separated_along(kNone, i);
  }
  test.begin_edges();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (test.separates_edges(i, k)) return separated_along(i, k);
    }
  }
  return test.best();
}

}  // namespace limber::sim::collision

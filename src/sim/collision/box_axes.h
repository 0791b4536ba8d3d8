// Separating-axis test of two boxes (Gottschalk, Lin and Manocha, OBBTree, 1996). It considers their motion in the
// present step.
#pragma once

#include "sim/bullet/bullet.h"
#include "sim/collision/manifold_builder.h"

namespace limber::sim::collision {

struct Box {
  const btVector3& center;
  const btMatrix3x3& axes;  // columns
  btVector3 half;

  Box(const btBoxShape& shape, const btTransform& pose)
      : center(pose.getOrigin()), axes(pose.getBasis()), half(shape.getHalfExtentsWithoutMargin()) {
    const btScalar margin = shape.getMarginNV();
    half += btVector3(margin, margin, margin);
  }
  btVector3 axis(int i) const { return axes.getColumn(i); }
};

/// Axis of least overlap of two boxes.
struct BoxAxis {
  enum Kind : unsigned char { none, face_a, face_b, edges } kind = none;
  btVector3 normal{0, 0, 0};  ///< From b to a.
  btScalar separation = -BT_LARGE_FLOAT;
  int edge_a = 0;
  int edge_b = 0;
};

/// The axis that separated two boxes in the last step; most likely it does so in the next one, too. [any]
class SeparatingAxis {
 public:
  /// True if it separates the boxes until the end of the step by more than rounding errors, so that find() would return
  /// none.
  bool separates(const Box& a, const Box& b, const ManifoldBuilder& points) const;
  /// Returns the axis of least overlap, or none if an axis separates the boxes until the end of the step; remembers
  /// that axis.
  BoxAxis find(const Box& a, const Box& b, const ManifoldBuilder& points);

 private:
  static constexpr int kNone = -1;
  int a_ = kNone;  // axis of the first box
  int b_ = kNone;  // of the second one; both: the cross product
};

}  // namespace limber::sim::collision

// Bounds: boxes along the world's axes around the collision geometry of bodies.
#pragma once

#include <limits>
#include <optional>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::sim {

class Body;
class Part;

/// A box along the world's axes, m. Initially empty.
struct Bounds {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x); }
  Vec3 center() const { return (low + high) / 2.0; }
  Vec3 size() const { return empty() ? Vec3(0) : high - low; }
  /// Extends the box to contain another one.
  void add(const Bounds& other);
  /// Returns the box moved by an offset.
  Bounds moved(const Vec3& offset) const { return {low + offset, high + offset}; }
  /// True if the boxes have more than a face in common.
  bool overlaps(const Bounds& other) const;
};

/// Returns the box around a shape at this pose, exact for each kind; empty for a plane, which has no end.
Bounds bounds_of(const model::ShapeModel& shape, const Pose& pose);
/// Returns the box around the collision shapes of a part in its present pose; empty if it has none, or if its pose is
/// not finite. [sim]
Bounds bounds_of(const Part& part);
/// Returns the box around a body in its present pose: of its collision shapes or, if it has none, of its visuals. Empty
/// if it has neither, or if a pose is not finite. [sim]
Bounds bounds_of(const Body& body);
/// Returns the box around a model at its start pose, of the same shapes. [any]
Bounds bounds_of(const model::BodyModel& model);

}  // namespace limber::sim

// Solid: a convex shape or a surface for rays and distances, in double precision and without Bullet's margins. [any]
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::sim {

/// Where a ray enters a solid.
struct SolidHit {
  double distance = 0;  ///< Along the ray, m.
  Vec3 normal{0};       ///< Outward, unit length.
};

class Solid {
 public:
  /// `shape`: any kind but a compound; `origin`: its pose in the link's frame.
  explicit Solid(const model::PlacedShape& shape);

  const Pose& origin() const { return origin_; }
  /// True for a plane, which fills a half-space and has no bounds.
  bool infinite() const { return kind_ == model::ShapeKind::plane; }
  /// Half the edges of a box around it, centered on center(), in its frame.
  const Vec3& half_size() const { return half_; }
  const Vec3& center() const { return center_; }

  /// Returns the first point at which the ray enters the solid, at most `max` away; none if it starts inside. The ray
  /// is given in the solid's frame; `direction` has unit length.
  std::optional<SolidHit> intersect(const Vec3& from, const Vec3& direction, double max) const;
  /// Distance of a point in the solid's frame from the surface; negative inside.
  double signed_distance(const Vec3& point) const;

 private:
  struct Face {
    Vec3 a, b, c;
    Vec3 normal;
    double offset;  // points of the face: normal · p = offset
  };
  void add_hull(const model::MeshModel& mesh);
  std::optional<SolidHit> intersect_hull(const Vec3& from, const Vec3& direction, double max) const;
  double hull_distance(const Vec3& point) const;

  model::ShapeKind kind_;
  Pose origin_;
  Vec3 normal_;
  Vec3 half_{0};  // of a box: half its edges; else of the box around it
  Vec3 center_{0};
  double radius_;
  double half_height_;
  std::shared_ptr<const std::vector<Face>> faces_;  // of a hull
  std::shared_ptr<const model::Surface> surface_;
};

}  // namespace limber::sim

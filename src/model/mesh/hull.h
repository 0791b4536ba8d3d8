// Convex hulls of point clouds: complete hulls, and hulls with fewer vertices for contact.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace limber::model {

struct Hull {
  std::vector<Vec3> vertices;
  std::vector<unsigned> triangles;  ///< Three indices each, counter-clockwise seen from outside; a closed surface.
  double error = 0;                 ///< Largest distance of an omitted point from the surface, meters.
};

/// The plane of a face: points p of it have normal · p = offset.
struct FacePlane {
  Vec3 normal;  ///< Outward, unit length.
  double offset;
};
/// Returns the planes of a hull's faces, except those of slivers, whose normals consist of rounding errors. [any]
std::vector<FacePlane> planes_of(const Hull& hull);

/// Stop criteria of reduced_hull().
struct HullLimits {
  int min_vertices = 16;    ///< Fewer only if the cloud's hull has fewer.
  int max_vertices = 64;    ///< Takes precedence over the tolerance.
  double tolerance = 0.02;  ///< Largest distance of an omitted point, relative to the cloud's largest extent.
};

/// Returns the convex hull of finite points, by quickhull. Points within a millionth of the size of the surface are not
/// made vertices. Flat, straight and single-point clouds are thickened (by 0.1 % of the size to each side, at least
/// 0.1 mm and the resolution of single precision), so that the result always has a volume. Empty for no points. [any]
Hull convex_hull(std::span<const Vec3> points);

/// Like convex_hull(), but exact also for clipped meshes, where many points lie in one plane: if rounding errors of
/// such points leave others outside, displaces all by up to a thousandth of the size. [any]
Hull checked_convex_hull(std::span<const Vec3> points);

/// Returns a hull with fewer vertices: starts from a tetrahedron and adds the farthest vertex until the limits are met.
/// Deterministic. [any]
Hull reduced_hull(std::span<const Vec3> points, const HullLimits& limits = {});
/// Reduces a complete hull from convex_hull(). [any]
Hull reduced_hull(const Hull& whole, const HullLimits& limits = {});

/// The point of a triangle that is nearest to `p`. [any]
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
/// Distance of a point from a triangle. [any]
double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limber::model

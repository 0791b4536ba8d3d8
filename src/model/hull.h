// Convex hulls of point clouds: whole, and reduced for contact.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace limber {

struct Hull {
  std::vector<Vec3> vertices;
  std::vector<unsigned> triangles;  ///< Three indices each, counter-clockwise seen from outside; a closed surface.
  double error = 0;                 ///< Distance of the farthest point left outside, metres.
};

/// When a reduced hull is fine enough.
struct HullLimits {
  int min_vertices = 16;    ///< Or all, when there are fewer.
  int max_vertices = 64;    ///< Wins over the tolerance.
  double tolerance = 0.02;  ///< Largest distance of a point left out, as a part of the cloud's largest extent.
};

/// The hull of finite points; points within a millionth of the size inside it don't count as vertices. Flat, straight
/// and single-point clouds become thin solids (0.1 % of the size to each side, at least 0.1 mm and what single
/// precision tells apart), so that the result always has a volume. Empty for no points. [any]
Hull convex_hull(std::span<const Vec3> points);

/// Vertices of the hull, the farthest from what is there first, until the limits are met. Deterministic. [any]
Hull reduced_hull(std::span<const Vec3> points, const HullLimits& limits = {});
/// The same of a hull that is there already. [any]
Hull reduced_hull(const Hull& whole, const HullLimits& limits = {});

/// Distance of a point from the nearest point of a triangle. [any]
double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limber

// The surface of a mesh for its decomposition: ordered triangles, samples, clipping, and a test for points inside.
// Internal to the module: only decompose*.cpp includes it.
#pragma once

#include <array>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace limber::model {

using Triangle = std::array<Vec3, 3>;

/// The triangles, each with its smallest corner first, in ascending order.
std::vector<Triangle> ordered_triangles(std::span<const Vec3> vertices, std::span<const unsigned> triangles);

/// Rotates the triangles to their principal axes of inertia if their bounding box becomes clearly smaller, as for a
/// bracket that is placed askew. Returns the rotation back; the identity if they stay.
Quat align_to_axes(std::vector<Triangle>& triangles);

/// A point of the surface.
struct SurfaceSample {
  Vec3 point;
  Vec3 normal;  ///< Outward, unit length.
  double free;  ///< Distance along the normal to the next surface; infinite if there is none.
};
/// Spreads samples evenly over the surface.
std::vector<SurfaceSample> sample_surface(std::span<const Triangle> triangles, std::size_t count);

/// A plane orthogonal to an axis.
struct AxisPlane {
  int axis = 0;
  double position = 0;
};

/// A convex polygon.
struct Polygon {
  std::vector<Vec3> corners;
  Vec3 normal;  ///< Outward; any length.
};
/// Appends the parts of a polygon below and above a plane. One in the plane belongs to the side of the solid.
void split_polygon(const Polygon& polygon, const AxisPlane& plane, double epsilon, std::vector<Polygon>& below,
                   std::vector<Polygon>& above);

/// Returns triangles that close the surface of one side of a cut: from `apex` in the plane to each edge in the plane.
std::vector<Polygon> caps_of_cut(std::span<const Polygon> polygons, const AxisPlane& plane, double epsilon,
                                 const Vec3& apex);
/// The volume between the polygons and `origin`; summed over a closed surface: its volume.
double enclosed_volume(std::span<const Polygon> polygons, const Vec3& origin);

/// Tests whether points are inside of a closed surface, by the crossings of lines parallel to the axes.
class InsideTest {
 public:
  /// `size`: largest extent of the surface.
  InsideTest(std::span<const Triangle> triangles, double size) : triangles_(triangles), size_(size) {}

  /// True if a point is inside. If it is nearer to the surface than a millionth of the size, the result may be wrong.
  /// Caches the crossings of the line through the point along `axis`.
  bool contains(const Vec3& point, int axis);

 private:
  using Crossings = std::vector<std::pair<double, int>>;  // position along the line; 1: it enters, -1: it leaves

  Crossings crossings_along(const Vec3& point, int axis) const;

  std::span<const Triangle> triangles_;
  double size_;
  std::map<std::tuple<int, double, double>, Crossings> lines_;
};

}  // namespace limber::model

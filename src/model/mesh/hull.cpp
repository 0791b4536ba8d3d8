// Complete hulls by quickhull with outside sets; reduced hulls by repeatedly adding the farthest vertex.
#include "model/mesh/hull.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>

#include "base/hash.h"
#include "model/mesh/hull_surface.h"

namespace limber::model {

namespace {

struct Extent {
  double size = 0;      // largest edge of the bounding box
  double farthest = 0;  // largest coordinate
};

Extent extent_of(std::span<const Vec3> points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const Vec3 d = high - low;
  const Vec3 m = glm::max(glm::abs(low), glm::abs(high));
  return {std::max({d.x, d.y, d.z}), std::max({m.x, m.y, m.z})};
}

// mesh files hold single precision: points within its rounding error of a plane are treated as in the plane
double tolerance_for(const Extent& e) { return 1e-6 * e.size + 2e-7 * e.farthest + 1e-12; }

// a cloud thinner than a ten-thousandth of its size is treated as flat: the faces along its rim would be slivers, with
// planes dominated by rounding errors
double min_thickness_for(const Extent& e) { return 100 * tolerance_for(e); }

/// Two copies of the cloud, shifted to both sides along each direction in which it has no thickness.
std::vector<Vec3> thickened(std::span<const Vec3> points, const Extent& extent) {
  const double min_extent = 2 * min_thickness_for(extent);
  const double offset = std::max({1e-3 * extent.size, 1e-4, 0.75 * min_thickness_for(extent)});
  const Vec3 base = points[0];
  const auto farthest = [&](const auto& measure) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& a, const Vec3& b) { return measure(a) < measure(b); });
  };
  std::vector<Vec3> flat_directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec3 far = farthest([&](const Vec3& p) { return glm::length(p - base); });
  if (glm::length(far - base) > min_extent) {
    const Vec3 along = normalized(far - base);
    const Vec3 helper = std::abs(along.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 side = farthest([&](const Vec3& p) { return glm::length(glm::cross(p - base, along)); });
    const Vec3 out = glm::cross(along, side - base);
    const Vec3 up = normalized(glm::cross(along, helper));
    if (glm::length(out) > min_extent) {
      flat_directions = {normalized(out)};
    } else {
      flat_directions = {up, glm::cross(along, up)};
    }
  }
  std::vector<Vec3> out_points(points.begin(), points.end());
  for (const Vec3& direction : flat_directions) {
    const std::size_t count = out_points.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = out_points[i];
      out_points[i] = p + offset * direction;
      out_points.push_back(p - offset * direction);
    }
  }
  return out_points;
}

/// Quickhull: assigns each point outside the surface to the face it is farthest above (the face's outside set), and
/// adds the farthest point of each face until all sets are empty.
class Quickhull {
 public:
  explicit Quickhull(HullSurface& surface) : surface_(surface) {}

  void run(int points) {
    std::vector<int> all(static_cast<std::size_t>(points));
    for (int i = 0; i < points; ++i) all[static_cast<std::size_t>(i)] = i;
    assign_points(all, {0, 1, 2, 3});
    while (!pending_.empty()) {
      const int f = pending_.back();
      HullSurface::Face& face = surface_.faces()[static_cast<std::size_t>(f)];
      if (!face.alive || face.outside_set.empty()) {
        pending_.pop_back();
        continue;
      }
      const int point = face.outside_set.back();
      face.outside_set.pop_back();
      if (surface_.add(point, f)) {
        std::vector<int> unassigned;
        for (const int dead : surface_.dead_faces()) {
          std::vector<int>& list = surface_.faces()[static_cast<std::size_t>(dead)].outside_set;
          unassigned.insert(unassigned.end(), list.begin(), list.end());
          std::vector<int>().swap(list);
        }
        assign_points(unassigned, surface_.added_faces());
      } else {
        move_farthest_to_back(face);
      }
    }
  }

 private:
  void assign_points(const std::vector<int>& points, const std::vector<int>& faces) {
    for (const int p : points) {
      int best = -1;
      double max_height = surface_.epsilon();
      for (const int f : faces) {
        const double d = surface_.signed_distance(surface_.faces()[static_cast<std::size_t>(f)], p);
        if (d > max_height) max_height = d, best = f;
      }
      if (best >= 0) surface_.faces()[static_cast<std::size_t>(best)].outside_set.push_back(p);
    }
    for (const int f : faces) {
      HullSurface::Face& face = surface_.faces()[static_cast<std::size_t>(f)];
      if (face.outside_set.empty()) continue;
      move_farthest_to_back(face);
      pending_.push_back(f);
    }
  }
  void move_farthest_to_back(HullSurface::Face& face) {
    if (face.outside_set.empty()) return;
    const auto farthest = std::max_element(face.outside_set.begin(), face.outside_set.end(), [&](int a, int b) {
      return surface_.signed_distance(face, a) < surface_.signed_distance(face, b);
    });
    std::iter_swap(farthest, face.outside_set.end() - 1);
  }

  HullSurface& surface_;
  std::vector<int> pending_;
};

// True if no point is outside of the planes of the faces. Of a large hull, only every n-th face is compared.
bool contains_all(const Hull& hull, std::span<const Vec3> points, double tolerance) {
  constexpr std::size_t kMaxComparisons = 20'000'000;
  const std::vector<FacePlane> planes = planes_of(hull);
  const std::size_t step = 1 + planes.size() * points.size() / kMaxComparisons;
  for (std::size_t i = 0; i < planes.size(); i += step) {
    const double max = planes[i].offset + tolerance;
    const auto is_outside = [&](const Vec3& p) { return glm::dot(planes[i].normal, p) > max; };
    if (std::any_of(points.begin(), points.end(), is_outside)) return false;
  }
  return true;
}

// True if the nearest point of a triangle is on an edge: the point is outside of it (`area`) and between its ends.
bool is_beside_edge(double area, double from_begin, double from_end) {
  return area <= 0 && from_begin >= 0 && from_end <= 0;
}

}  // namespace

std::vector<FacePlane> planes_of(const Hull& hull) {
  constexpr double kMinAspect = 1e-3;
  std::vector<FacePlane> out;
  out.reserve(hull.triangles.size() / 3);
  for (std::size_t i = 0; i + 2 < hull.triangles.size(); i += 3) {
    const Vec3& a = hull.vertices[hull.triangles[i]];
    const Vec3& b = hull.vertices[hull.triangles[i + 1]];
    const Vec3& c = hull.vertices[hull.triangles[i + 2]];
    const Vec3 across = glm::cross(b - a, c - a);
    const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - a, c - a), glm::dot(c - b, c - b)});
    if (!(glm::length(across) > kMinAspect * longest)) continue;
    const Vec3 normal = normalized(across);
    out.push_back({normal, glm::dot(normal, (a + b + c) / 3.0)});
  }
  return out;
}

Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // Ericson, Real-Time Collision Detection, 5.1.5: finds the corner, edge or interior region that is nearest
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (is_beside_edge(vc, d1, d3)) return a + d1 / (d1 - d3) * ab;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (is_beside_edge(vb, d2, d6)) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? a + vb / sum * ab + vc / sum * ac : a;
}

double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::length(p - nearest_on_triangle(p, a, b, c));
}

Hull convex_hull(std::span<const Vec3> points) {
  if (points.empty()) return {};
  const Extent extent = extent_of(points);
  HullSurface surface(points, tolerance_for(extent));
  if (surface.build_tetrahedron(min_thickness_for(extent))) {
    Quickhull(surface).run(static_cast<int>(points.size()));
    return surface.result();
  }
  const std::vector<Vec3> thick = thickened(points, extent);
  HullSurface solid(thick, tolerance_for(extent_of(thick)));
  if (!solid.build_tetrahedron(min_thickness_for(extent_of(thick)))) return {};
  Quickhull(solid).run(static_cast<int>(thick.size()));
  return solid.result();
}

Hull checked_convex_hull(std::span<const Vec3> points) {
  Hull hull = convex_hull(points);
  if (points.empty()) return hull;
  const Extent extent = extent_of(points);
  const double size = extent.size;
  const double tolerance = 1e-5 * size + tolerance_for(extent);
  std::uint64_t random = 0;
  for (double offset = 1e-6; offset <= 1e-3 && !contains_all(hull, points, tolerance + offset * size); offset *= 10) {
    std::vector<Vec3> displaced(points.begin(), points.end());
    for (Vec3& p : displaced) {
      for (int i = 0; i < 3; ++i)
        p[i] += offset * size * (static_cast<double>(splitmix64(random) >> 11u) * 0x1p-52 - 1);
    }
    hull = convex_hull(displaced);
  }
  return hull;
}

Hull reduced_hull(const Hull& whole, const HullLimits& limits) {
  const int count = static_cast<int>(whole.vertices.size());
  if (count <= std::min(limits.min_vertices, limits.max_vertices)) return whole;
  const Extent extent = extent_of(whole.vertices);
  HullSurface surface(whole.vertices, tolerance_for(extent) * 0.1);
  if (!surface.build_tetrahedron(10 * surface.epsilon())) return whole;
  // distances only shrink while the surface grows: a stored distance is an upper bound, so only the top is recomputed
  std::priority_queue<std::pair<double, int>> farthest;
  for (int i = 0; i < count; ++i) farthest.emplace(surface.distance(i), -i);
  int vertices = 4;
  double max_omitted = 0;
  while (!farthest.empty()) {
    const auto [upper_bound, index] = farthest.top();
    farthest.pop();
    const double distance = surface.distance(-index);
    if (!farthest.empty() && distance < farthest.top().first) {
      farthest.emplace(distance, index);
      continue;
    }
    const bool accurate_enough = distance <= limits.tolerance * extent.size && vertices >= limits.min_vertices;
    if (distance <= surface.epsilon() || vertices >= limits.max_vertices || accurate_enough) {
      max_omitted = std::max(max_omitted, distance);
      break;
    }
    const int visible_face = surface.highest_visible_face(-index);
    if (visible_face >= 0 && surface.add(-index, visible_face)) {
      ++vertices;
    } else {
      max_omitted = std::max(max_omitted, distance);
    }
  }
  Hull out = surface.result();
  out.error = max_omitted;
  return out;
}

Hull reduced_hull(std::span<const Vec3> points, const HullLimits& limits) {
  return reduced_hull(convex_hull(points), limits);
}

}  // namespace limber::model

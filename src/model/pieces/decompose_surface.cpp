// Samples, cuts and crossings of a surface.
#include "model/pieces/decompose_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "model/mesh/mass_properties.h"

namespace limber::model {

namespace {

bool is_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

Vec3 normal_times_area(const Triangle& t) { return glm::cross(t[1] - t[0], t[2] - t[0]) / 2.0; }

struct RayHit {
  double distance;
  bool enters;  // the ray enters the solid
};

// Returns the intersection of a line and a triangle, by Möller and Trumbore; empty if there is none.
std::optional<RayHit> hit_of(const Triangle& t, const Vec3& from, const Vec3& direction) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0];
  const Vec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return {};
  const Vec3 s = from - t[0];
  const double u = glm::dot(s, p) / determinant;
  if (!(u >= 0 && u <= 1)) return {};
  const Vec3 q = glm::cross(s, ab);
  const double v = glm::dot(direction, q) / determinant;
  if (!(v >= 0 && u + v <= 1)) return {};
  return RayHit{glm::dot(ac, q) / determinant, determinant > 0};
}

// Free distance in front of a point of the surface: 0 if it is inside of, or touches, another solid of the mesh.
double free_distance(const SurfaceSample& sample, std::span<const Triangle> triangles, double tolerance) {
  RayHit nearest{std::numeric_limits<double>::infinity(), true};
  for (const Triangle& t : triangles) {
    const std::optional<RayHit> hit = hit_of(t, sample.point, sample.normal);
    if (!hit || hit->distance >= nearest.distance) continue;
    if (hit->distance > (hit->enters ? -tolerance : tolerance)) nearest = *hit;
  }
  return nearest.enters ? std::max(0.0, nearest.distance) : 0;
}

double box_volume(std::span<const Triangle> triangles, const Quat& rotation) {
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Triangle& t : triangles) {
    for (const Vec3& corner : t) {
      const Vec3 p = rotation * corner;
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  const Vec3 extent = high - low;
  return extent.x * extent.y * extent.z;
}

double fraction(double x) { return x - std::floor(x); }

}  // namespace

std::vector<Triangle> ordered_triangles(std::span<const Vec3> vertices, std::span<const unsigned> triangles) {
  std::vector<Triangle> out;
  out.reserve(triangles.size() / 3);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    Triangle t{vertices[triangles[i]], vertices[triangles[i + 1]], vertices[triangles[i + 2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end(), is_before), t.end());
    out.push_back(t);
  }
  std::sort(out.begin(), out.end(), [](const Triangle& a, const Triangle& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_before);
  });
  return out;
}

Quat align_to_axes(std::vector<Triangle>& triangles) {
  constexpr double kClearlySmaller = 0.9;
  std::vector<Vec3> corners;
  std::vector<unsigned> numbers;
  for (const Triangle& t : triangles) {
    for (const Vec3& corner : t) {
      numbers.push_back(static_cast<unsigned>(corners.size()));
      corners.push_back(corner);
    }
  }
  const Mat3 axes = principal_axes(unit_inertial_of(corners, numbers).tensor).axes;
  const Quat frame = glm::normalize(glm::quat_cast(axes));
  const Quat to_frame = glm::conjugate(frame);
  if (!is_finite(frame)) return quat_identity();
  if (!(box_volume(triangles, to_frame) < kClearlySmaller * box_volume(triangles, quat_identity())))
    return quat_identity();
  for (Triangle& t : triangles) {
    for (Vec3& corner : t) corner = to_frame * corner;
  }
  return frame;
}

std::vector<SurfaceSample> sample_surface(std::span<const Triangle> triangles, std::size_t count) {
  double total = 0;
  for (const Triangle& t : triangles) total += glm::length(normal_times_area(t));
  std::vector<SurfaceSample> out;
  if (!(total > 0)) return out;
  const double spacing = total / static_cast<double>(count);
  double passed = 0;
  for (const Triangle& t : triangles) {
    const Vec3 across = normal_times_area(t);
    passed += glm::length(across);
    while (out.size() < count && (static_cast<double>(out.size()) + 0.5) * spacing < passed) {
      // the additive sequence R2 of Roberts spreads points evenly
      const auto number = static_cast<double>(out.size() + 1);
      double u = fraction(0.7548776662466927 * number), v = fraction(0.5698402909980532 * number);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      out.push_back(
          {t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), normalized(across), std::numeric_limits<double>::infinity()});
    }
  }
  Vec3 low = triangles[0][0], high = low;
  for (const Triangle& t : triangles) {
    for (const Vec3& corner : t) low = glm::min(low, corner), high = glm::max(high, corner);
  }
  const double tolerance = 1e-6 * glm::length(high - low);
  for (SurfaceSample& sample : out) sample.free = free_distance(sample, triangles, tolerance);
  return out;
}

void split_polygon(const Polygon& polygon, const AxisPlane& plane, double epsilon, std::vector<Polygon>& below,
                   std::vector<Polygon>& above) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& corner : polygon.corners) {
    low = std::min(low, corner[plane.axis] - plane.position);
    high = std::max(high, corner[plane.axis] - plane.position);
  }
  if (low >= -epsilon && high <= epsilon) {
    (polygon.normal[plane.axis] >= 0 ? below : above).push_back(polygon);
    return;
  }
  if (high <= epsilon) return below.push_back(polygon);
  if (low >= -epsilon) return above.push_back(polygon);
  Polygon under{{}, polygon.normal}, over{{}, polygon.normal};
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const Vec3& a = polygon.corners[i];
    const Vec3& b = polygon.corners[(i + 1) % polygon.corners.size()];
    const double from = a[plane.axis] - plane.position, to = b[plane.axis] - plane.position;
    if (from <= 0) under.corners.push_back(a);
    if (from >= 0) over.corners.push_back(a);
    if (!((from < 0 && to > 0) || (from > 0 && to < 0))) continue;
    Vec3 cut = a + from / (from - to) * (b - a);
    cut[plane.axis] = plane.position;
    under.corners.push_back(cut);
    over.corners.push_back(cut);
  }
  below.push_back(std::move(under));
  above.push_back(std::move(over));
}

std::vector<Polygon> caps_of_cut(std::span<const Polygon> polygons, const AxisPlane& plane, double epsilon,
                                 const Vec3& apex) {
  std::vector<Polygon> out;
  const auto in_plane = [&](const Vec3& p) { return std::abs(p[plane.axis] - plane.position) <= epsilon; };
  for (const Polygon& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
      const Vec3& a = polygon.corners[i];
      const Vec3& b = polygon.corners[(i + 1) % polygon.corners.size()];
      if (in_plane(a) && in_plane(b)) out.push_back({{apex, b, a}, glm::cross(b - apex, a - apex)});
    }
  }
  return out;
}

double enclosed_volume(std::span<const Polygon> polygons, const Vec3& origin) {
  double sum = 0;
  for (const Polygon& polygon : polygons) {
    const Vec3 a = polygon.corners[0] - origin;
    for (std::size_t i = 1; i + 1 < polygon.corners.size(); ++i)
      sum += glm::dot(a, glm::cross(polygon.corners[i] - origin, polygon.corners[i + 1] - origin));
  }
  return sum / 6;
}

bool InsideTest::contains(const Vec3& point, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto [line, is_new] = lines_.try_emplace({axis, point[u], point[v]});
  if (is_new) line->second = crossings_along(point, axis);
  int depth = 0;
  for (const auto& [position, sign] : line->second) {
    if (position < point[axis]) depth += sign;
  }
  return depth > 0;
}

InsideTest::Crossings InsideTest::crossings_along(const Vec3& point, int axis) const {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  // displaced, because cells have edges in common with the mesh
  const double x = point[u] + 0.734e-7 * size_, y = point[v] + 0.417e-7 * size_;
  Crossings out;
  for (const Triangle& t : triangles_) {
    std::array<double, 3> area{};  // of the triangles that the line forms with the edges, seen along the axis
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& a = t[i];
      const Vec3& b = t[(i + 1) % 3];
      area[i] = (a[u] - x) * (b[v] - y) - (a[v] - y) * (b[u] - x);
    }
    const bool up = area[0] > 0 && area[1] > 0 && area[2] > 0;
    const bool down = area[0] < 0 && area[1] < 0 && area[2] < 0;
    if (!up && !down) continue;
    const double sum = area[0] + area[1] + area[2];
    const double at = (area[1] * t[0][axis] + area[2] * t[1][axis] + area[0] * t[2][axis]) / sum;
    out.emplace_back(at, up ? -1 : 1);
  }
  return out;
}

}  // namespace limber::model

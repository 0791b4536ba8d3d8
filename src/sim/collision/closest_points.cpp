// GJK: a simplex within the difference A - B approaches the origin. Its point nearest to the origin is found by the
// Voronoi regions of its features (Ericson, Real-Time Collision Detection, 2005, 5.1 and 9.5).
#include "sim/collision/closest_points.h"

#include <algorithm>
#include <array>

#include "sim/collision/penetration.h"

namespace limber::sim::collision {
namespace {

using bullet::to_bt;
using bullet::to_scalar;

constexpr int kMaxGjkIterations = 64;
/// The distance is exact to this share of it, and to this share of the shapes' size, since support points are of single
/// precision.
constexpr double kGjkAccuracy = 1e-6;
constexpr double kGjkRounding = 1e-7;

/// Points of the difference, and the weights with which they sum up to the point nearest to the origin.
class Simplex {
 public:
  void add(const DifferencePoint& point) { points_[static_cast<std::size_t>(count_++)] = point; }
  bool contains(const DifferencePoint& point) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
      if (points_[i].difference == point.difference) return true;
    }
    return false;
  }
  /// Reduces the simplex to the feature that is nearest to the origin; false if the origin is inside.
  bool reduce();
  Vec3 nearest() const {
    Vec3 sum(0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) sum += weights_[i] * points_[i].difference;
    return sum;
  }
  Vec3 on_b() const {
    Vec3 sum(0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) sum += weights_[i] * points_[i].on_b;
    return sum;
  }

 private:
  struct Feature {
    int count = 0;
    std::array<int, 3> points{};
    std::array<double, 3> weights{};
  };
  const Vec3& at(int i) const { return points_[static_cast<std::size_t>(i)].difference; }
  Feature nearest_on_segment(int a, int b) const;
  Feature nearest_on_triangle(int a, int b, int c) const;
  bool outside(int a, int b, int c, int opposite) const;
  Vec3 point_of(const Feature& feature) const;
  void keep(const Feature& feature);

  int count_ = 0;
  std::array<DifferencePoint, 4> points_;
  std::array<double, 4> weights_{};
};

Simplex::Feature Simplex::nearest_on_segment(int a, int b) const {
  const Vec3 ab = at(b) - at(a);
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0 ? -glm::dot(at(a), ab) / length2 : 0;
  if (t <= 0) return {1, {a}, {1}};
  if (t >= 1) return {1, {b}, {1}};
  return {2, {a, b}, {1 - t, t}};
}

// The products d1 to d6 decide as in Ericson's book.
Simplex::Feature Simplex::nearest_on_triangle(int a, int b, int c) const {
  const Vec3 ab = at(b) - at(a);
  const Vec3 ac = at(c) - at(a);
  const double d1 = -glm::dot(ab, at(a));
  const double d2 = -glm::dot(ac, at(a));
  if (std::max(d1, d2) <= 0) return {1, {a}, {1}};
  const double d3 = -glm::dot(ab, at(b));
  const double d4 = -glm::dot(ac, at(b));
  if (d3 >= 0 && d4 <= d3) return {1, {b}, {1}};
  const double d5 = -glm::dot(ab, at(c));
  const double d6 = -glm::dot(ac, at(c));
  if (d6 >= 0 && d5 <= d6) return {1, {c}, {1}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && std::min(d1, -d3) >= 0) return nearest_on_segment(a, b);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && std::min(d2, -d6) >= 0) return nearest_on_segment(a, c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && std::min(d4 - d3, d5 - d6) >= 0) return nearest_on_segment(b, c);
  const double sum = va + vb + vc;
  return {3, {a, b, c}, {va / sum, vb / sum, vc / sum}};
}

// True if the origin and the opposite corner are on different sides of a face of the tetrahedron, which may be flat.
bool Simplex::outside(int a, int b, int c, int opposite) const {
  const Vec3 normal = glm::cross(at(b) - at(a), at(c) - at(a));
  const double side = glm::dot(normal, at(opposite) - at(a));
  return -glm::dot(normal, at(a)) * side <= 0;
}

Vec3 Simplex::point_of(const Feature& feature) const {
  Vec3 sum(0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(feature.count); ++i)
    sum += feature.weights[i] * at(feature.points[i]);
  return sum;
}

void Simplex::keep(const Feature& feature) {
  std::array<DifferencePoint, 3> kept;
  for (std::size_t i = 0; i < static_cast<std::size_t>(feature.count); ++i)
    kept[i] = points_[static_cast<std::size_t>(feature.points[i])];
  std::ranges::copy(kept, points_.begin());
  std::ranges::copy(feature.weights, weights_.begin());
  count_ = feature.count;
}

bool Simplex::reduce() {
  if (count_ < 4) {
    keep(count_ == 1 ? Feature{1, {0}, {1}} : (count_ == 2 ? nearest_on_segment(0, 1) : nearest_on_triangle(0, 1, 2)));
    return true;
  }
  constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  Feature best;
  double shortest = 0;
  for (const auto& [a, b, c, opposite] : kFaces) {
    if (!outside(a, b, c, opposite)) continue;
    const Feature feature = nearest_on_triangle(a, b, c);
    const Vec3 point = point_of(feature);
    if (best.count > 0 && glm::dot(point, point) >= shortest) continue;
    best = feature;
    shortest = glm::dot(point, point);
  }
  if (best.count == 0) return false;
  keep(best);
  return true;
}

// The point of the difference nearest to the origin; false if the shapes overlap or touch.
bool find_nearest(const ShapeDifference& shapes, Vec3& nearest, Vec3& on_b) {
  Simplex simplex;
  nearest = bullet::from_bt(shapes.pose_a.getOrigin() - shapes.pose_b.getOrigin());
  if (nearest == Vec3(0)) nearest = Vec3(1, 0, 0);
  double size2 = 0;
  double distance2 = 0;
  for (int i = 0; i < kMaxGjkIterations; ++i) {
    const DifferencePoint point = shapes.support(-nearest);
    size2 = std::max(size2, glm::dot(point.difference, point.difference));
    if (i > 0) {
      const double gain = distance2 - glm::dot(nearest, point.difference);
      if (gain <= kGjkAccuracy * distance2 || gain * gain <= kGjkRounding * kGjkRounding * size2 * distance2)
        return true;
      if (simplex.contains(point)) return true;
    }
    Simplex grown = simplex;
    grown.add(point);
    if (!grown.reduce()) return false;
    const Vec3 next = grown.nearest();
    const double next2 = glm::dot(next, next);
    if (i > 0 && next2 >= distance2) return true;
    simplex = grown;
    nearest = next;
    distance2 = next2;
    on_b = simplex.on_b();
    if (distance2 <= kGjkRounding * kGjkRounding * size2) return false;
  }
  return true;
}

}  // namespace

ClosestPoints closest_points(const btConvexShape& a, const btTransform& pose_a, const btConvexShape& b,
                             const btTransform& pose_b) {
  const btScalar margins = a.getMargin() + b.getMargin();
  const ShapeDifference cores{a, pose_a, b, pose_b, false};
  Vec3 nearest(0);
  Vec3 on_b(0);
  if (find_nearest(cores, nearest, on_b)) {
    const double distance = glm::length(nearest);
    const btVector3 normal = to_bt(nearest / distance);
    return {true, to_scalar(distance) - margins, normal, to_bt(on_b) + normal * b.getMargin()};
  }
  // rounding adds to the depth and doesn't change the normal
  if (const Penetration core = find_penetration(cores); core.found) {
    const btVector3 normal = to_bt(core.normal);
    return {true, -to_scalar(core.depth) - margins, normal, to_bt(core.point_on_b) + normal * b.getMargin()};
  }
  const Penetration whole = find_penetration({a, pose_a, b, pose_b, true});
  return {whole.found, -to_scalar(whole.depth), to_bt(whole.normal), to_bt(whole.point_on_b)};
}

}  // namespace limber::sim::collision

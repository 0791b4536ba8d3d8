// Penetration depth by the expanding polytope algorithm (EPA, Gino van den Bergen) on the Minkowski difference, in
// double precision on the exact shapes; sweep and prune over bounding boxes finds the candidate pairs.
#include "model/overlap.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "model/pieces/pieces.h"

namespace limber::model {

namespace {

// Limit for deciding whether the depth exceeds the tolerance; for the precision of the depth, a quarter of it.
constexpr int kMaxExpansions = 160;
constexpr double kDepthPrecision = 1e-7;  // m
constexpr double kRelativeDepthPrecision = 0.02;
// Work limit of find_overlaps(), in box comparisons; a comparison of two shapes costs about 200 of them.
constexpr std::size_t kMaxOverlapWork = 10'000'000;
constexpr std::size_t kShapePairWork = 200;

struct OverlapBox {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};

  void add(const OverlapBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
};

// The smallest overlap of two boxes along an axis: an upper bound of the penetration depth of shapes inside them.
double box_overlap(const OverlapBox& a, const OverlapBox& b) {
  const Vec3 along = glm::min(a.high, b.high) - glm::max(a.low, b.low);
  return std::min({along.x, along.y, along.z});
}

/// A convex shape in the common frame, represented by its support function.
class ConvexSolid {
 public:
  ConvexSolid(const PlacedShape& placed, const Pose& frame) : kind_(placed.shape.kind) {
    const Pose pose = frame * placed.origin;
    const ShapeModel& shape = placed.shape;
    center_ = pose.position;
    axis_ = pose.rotation * Vec3(0, 0, 1);
    radius_ = shape.radius;
    half_ = shape.height / 2;
    radii_ =
        glm::mat3_cast(pose.rotation) * Mat3(shape.size.x / 2, 0, 0, 0, shape.size.y / 2, 0, 0, 0, shape.size.z / 2);
    if (shape.surface != nullptr) kind_ = ShapeKind::compound;  // it has no inside
    if (kind_ == ShapeKind::box) {
      for (int i = 0; i < 8; ++i) {
        const Vec3 sign((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
        vertices_.push_back(pose * (sign * shape.size));
      }
    } else if (kind_ == ShapeKind::mesh && shape.mesh != nullptr && !shape.mesh->hull.empty()) {
      Vec3 sum(0);
      for (const Vec3& v : shape.mesh->hull) {
        vertices_.push_back(pose * v);
        sum += vertices_.back();
      }
      center_ = sum / static_cast<double>(vertices_.size());
    } else if (kind_ == ShapeKind::mesh || kind_ == ShapeKind::plane || kind_ == ShapeKind::compound) {
      has_volume_ = false;
      return;
    }
    for (int i = 0; i < 3; ++i) {
      Vec3 direction(0);
      direction[i] = 1;
      box_.high[i] = support(direction)[i];
      box_.low[i] = support(-direction)[i];
    }
  }

  bool has_volume() const { return has_volume_; }
  const OverlapBox& box() const { return box_; }
  const Vec3& center() const { return center_; }

  /// The point farthest along a unit direction.
  Vec3 support(const Vec3& direction) const {
    switch (kind_) {
      case ShapeKind::sphere:
        return center_ + radius_ * direction;
      case ShapeKind::capsule:
        return center_ + end_offset(direction) + radius_ * direction;
      case ShapeKind::cylinder:
        return center_ + end_offset(direction) + rim_offset(direction);
      case ShapeKind::ellipsoid:
        return center_ + radii_ * normalized(glm::transpose(radii_) * direction);
      case ShapeKind::cone: {
        const Vec3 apex = center_ + half_ * axis_;
        const Vec3 base = center_ - half_ * axis_ + rim_offset(direction);
        return glm::dot(apex, direction) > glm::dot(base, direction) ? apex : base;
      }
      default: {
        const Vec3* best = vertices_.data();
        double max_projection = glm::dot(*best, direction);
        for (const Vec3& v : vertices_) {
          const double along = glm::dot(v, direction);
          if (along <= max_projection) continue;
          max_projection = along;
          best = &v;
        }
        return *best;
      }
    }
  }

 private:
  Vec3 end_offset(const Vec3& direction) const {
    return glm::dot(axis_, direction) < 0 ? -half_ * axis_ : half_ * axis_;
  }
  Vec3 rim_offset(const Vec3& direction) const {
    const Vec3 across = direction - glm::dot(direction, axis_) * axis_;
    const double length = glm::length(across);
    // for a direction along the axis `across` is only rounding error: any point of the disk is equally far, use its
    // center
    return length > 1e-8 ? radius_ / length * across : Vec3(0);
  }

  ShapeKind kind_;
  bool has_volume_ = true;
  Vec3 center_, axis_;
  double radius_ = 0;
  double half_ = 0;
  Mat3 radii_{0};  // of an ellipsoid: its axes
  std::vector<Vec3> vertices_;
  OverlapBox box_;
};

/// EPA: a polytope inside the Minkowski difference of two solids is expanded where it is nearest to the origin. The
/// depth is the minimum support distance over all directions: each sampled direction gives an upper bound, the nearest
/// face a lower bound.
class PolytopeExpansion {
 public:
  PolytopeExpansion(const ConvexSolid& a, const ConvexSolid& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {}

  /// The penetration depth; 0 if it is at most the tolerance.
  double depth() {
    if (!build_tetrahedron()) return 0;
    for (int i = 0; i < kMaxExpansions; ++i) {
      const Face* const nearest = nearest_face();
      if (nearest == nullptr) break;
      const Vec3 normal = nearest->normal;
      const double lower = nearest->distance;
      const double precision = std::max(kDepthPrecision, kRelativeDepthPrecision * upper_bound_);
      if (lower > tolerance_ && (upper_bound_ - lower < precision || i > kMaxExpansions / 4)) break;
      const Vec3 point = sample(normal);
      if (separated()) return 0;
      if (glm::dot(point, normal) - lower < kDepthPrecision) break;
      if (!expand(point)) break;
    }
    return upper_bound_;
  }

 private:
  struct Face {
    std::array<int, 3> corner;
    Vec3 normal;
    double distance;  // of its plane from the origin, along the normal
    bool flat;        // zero area: never selected, never visible
  };

  bool separated() const { return upper_bound_ <= tolerance_; }

  Vec3 sample(const Vec3& direction) {
    const Vec3 point = a_.support(direction) - b_.support(-direction);
    upper_bound_ = std::min(upper_bound_, glm::dot(point, direction));
    return point;
  }

  // builds the first tetrahedron; false if a sampled direction separates the two, or the difference has no volume
  bool build_tetrahedron() {
    const Vec3 between = normalized(b_.center() - a_.center());
    if (glm::length(between) > 0) {
      sample(between);
      if (separated()) return false;
    }
    std::array<Vec3, 2> ends;
    double longest = -1;
    for (int i = 0; i < 3; ++i) {
      Vec3 direction(0);
      direction[i] = 1;
      const Vec3 high = sample(direction);
      const Vec3 low = sample(-direction);
      if (separated()) return false;
      const double extent = glm::length(high - low);
      if (extent <= longest) continue;
      longest = extent;
      ends = {low, high};
    }
    size_ = longest;
    const Vec3 u = normalized(ends[1] - ends[0]);
    const Vec3 v = normalized(glm::cross(u, std::abs(u.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 w = glm::cross(u, v);
    const Vec3 third = farthest({v, -v, w, -w}, [&](const Vec3& p) { return glm::length(glm::cross(u, p - ends[0])); });
    const Vec3 normal = normalized(glm::cross(u, third - ends[0]));
    const Vec3 fourth = farthest({normal, -normal, normal, -normal},
                                 [&](const Vec3& p) { return std::abs(glm::dot(normal, p - ends[0])); });
    if (separated()) return false;
    points_ = {ends[0], ends[1], third, fourth};
    if (std::abs(glm::dot(normal, fourth - ends[0])) <= 1e-12 * size_) return false;
    if (glm::dot(normal, fourth - ends[0]) > 0) std::swap(points_[1], points_[2]);
    add_face(0, 1, 2);
    add_face(0, 3, 1);
    add_face(1, 3, 2);
    add_face(2, 3, 0);
    return true;
  }

  template <class Measure>
  Vec3 farthest(const std::array<Vec3, 4>& directions, const Measure& measure) {
    Vec3 best(0);
    double max_measure = -1;
    for (const Vec3& direction : directions) {
      const Vec3 point = sample(direction);
      if (measure(point) <= max_measure) continue;
      max_measure = measure(point);
      best = point;
    }
    return best;
  }

  void add_face(int a, int b, int c) {
    const auto point = [&](int i) { return points_[static_cast<std::size_t>(i)]; };
    const Vec3 across = glm::cross(point(b) - point(a), point(c) - point(a));
    const bool flat = glm::length(across) <= 1e-18 * size_ * size_;
    const Vec3 normal = normalized(across);
    faces_.push_back({{a, b, c}, normal, glm::dot(normal, point(a)), flat});
  }

  const Face* nearest_face() const {
    const Face* nearest = nullptr;
    for (const Face& face : faces_) {
      if (!face.flat && (nearest == nullptr || face.distance < nearest->distance)) nearest = &face;
    }
    return nearest;
  }

  // replaces the faces visible from the point by faces that connect their outline with the point
  bool expand(const Vec3& point) {
    edges_.clear();
    std::erase_if(faces_, [&](const Face& face) {
      if (face.flat || glm::dot(face.normal, point) - face.distance <= 1e-11 * size_) return false;
      for (std::size_t i = 0; i < 3; ++i) add_edge(face.corner[i], face.corner[(i + 1) % 3]);
      return true;
    });
    if (edges_.empty()) return false;
    points_.push_back(point);
    const int apex = static_cast<int>(points_.size()) - 1;
    for (const auto& [from, to] : edges_) add_face(from, to, apex);
    return true;
  }

  // an edge shared by two removed faces (in opposite directions) is not part of the outline
  void add_edge(int from, int to) {
    const auto twin = std::find(edges_.begin(), edges_.end(), std::pair(to, from));
    if (twin == edges_.end()) {
      edges_.emplace_back(from, to);
    } else {
      edges_.erase(twin);
    }
  }

  const ConvexSolid& a_;
  const ConvexSolid& b_;
  double tolerance_;
  double size_ = 0;
  double upper_bound_ = std::numeric_limits<double>::infinity();
  std::vector<Vec3> points_;
  std::vector<Face> faces_;
  std::vector<std::pair<int, int>> edges_;
};

struct OverlapSolids {
  std::vector<ConvexSolid> solids;
  OverlapBox box;
};

OverlapSolids solids_of(const OverlapPart& part) {
  OverlapSolids out;
  for (const PlacedShape& placed : part.shapes) {
    for (const PlacedShape& convex : convex_shapes(placed)) {
      ConvexSolid solid(convex, part.pose);
      if (!solid.has_volume()) continue;
      out.box.add(solid.box());
      out.solids.push_back(std::move(solid));
    }
  }
  return out;
}

// returns the depth of the first overlapping pair of shapes; 0 if there is none
double first_overlap_depth(const OverlapSolids& a, const OverlapSolids& b, std::size_t& work) {
  for (const ConvexSolid& x : a.solids) {
    for (const ConvexSolid& y : b.solids) {
      ++work;
      if (box_overlap(x.box(), y.box()) <= kOverlapTolerance) continue;
      work += kShapePairWork;
      if (const double depth = PolytopeExpansion(x, y, kOverlapTolerance).depth(); depth > 0) return depth;
      if (work > kMaxOverlapWork) return 0;
    }
  }
  return 0;
}

}  // namespace

double overlap_depth(const PlacedShape& a, const PlacedShape& b, double tolerance) {
  const ConvexSolid x(a, Pose{});
  const ConvexSolid y(b, Pose{});
  if (!x.has_volume() || !y.has_volume() || box_overlap(x.box(), y.box()) <= tolerance) return 0;
  return PolytopeExpansion(x, y, tolerance).depth();
}

OverlapResult find_overlaps(std::span<const OverlapPart> parts,
                            const std::function<bool(std::size_t a, std::size_t b)>& filter) {
  OverlapResult out;
  std::vector<OverlapSolids> solids;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    solids.push_back(solids_of(parts[i]));
    if (!solids.back().solids.empty()) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const double x = solids[i].box.low.x;
    const double y = solids[j].box.low.x;
    return x < y || (x == y && i < j);
  });
  std::size_t work = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const auto [a, b] = std::minmax(order[i], order[j]);
      ++work;
      if (solids[order[j]].box.low.x >= solids[order[i]].box.high.x) break;
      if (box_overlap(solids[a].box, solids[b].box) <= kOverlapTolerance || !filter(a, b)) continue;
      if (work > kMaxOverlapWork) {
        ++out.unchecked;
        continue;
      }
      const double depth = first_overlap_depth(solids[a], solids[b], work);
      if (depth == 0 && work > kMaxOverlapWork) ++out.unchecked;
      if (depth > 0) out.found.push_back({static_cast<int>(a), static_cast<int>(b), depth});
    }
  }
  std::sort(out.found.begin(), out.found.end(),
            [](const Overlap& x, const Overlap& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  return out;
}

}  // namespace limber::model

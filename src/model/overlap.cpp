// Penetration depth by expanding a polytope inside the Minkowski difference (Gino van den Bergen's EPA), in double
// precision on the exact shapes; a sweep over bounding boxes finds the candidates.
#include "model/overlap.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace limber {

namespace {

constexpr int kMaxExpansions = 160;
constexpr double kDepthPrecision = 1e-7;  // m
constexpr double kRelativeDepthPrecision = 0.02;
// Work bound of find_overlaps(), in comparisons of boxes; a comparison of shapes costs about 200 of them.
constexpr std::size_t kMaxOverlapWork = 10'000'000;
constexpr std::size_t kNarrowWork = 200;

struct OverlapBox {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};

  void add(const OverlapBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
};

// The smallest overlap of two boxes along an axis: no shape inside penetrates deeper.
double box_overlap(const OverlapBox& a, const OverlapBox& b) {
  const Vec3 along = glm::min(a.high, b.high) - glm::max(a.low, b.low);
  return std::min({along.x, along.y, along.z});
}

/// A convex shape in the common frame, by its support function.
class ConvexSolid {
 public:
  ConvexSolid(const PlacedShape& placed, const Pose& frame) : kind_(placed.shape.kind) {
    const Pose pose = frame * placed.origin;
    const ShapeModel& shape = placed.shape;
    center_ = pose.position;
    axis_ = pose.rotation * Vec3(0, 0, 1);
    radius_ = shape.radius;
    half_ = shape.height / 2;
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
      solid_ = false;
      return;
    }
    for (int i = 0; i < 3; ++i) {
      Vec3 direction(0);
      direction[i] = 1;
      box_.high[i] = support(direction)[i];
      box_.low[i] = support(-direction)[i];
    }
  }

  bool solid() const { return solid_; }
  const OverlapBox& box() const { return box_; }
  const Vec3& center() const { return center_; }

  /// The point farthest along a unit direction.
  Vec3 support(const Vec3& direction) const {
    switch (kind_) {
      case ShapeKind::sphere:
        return center_ + radius_ * direction;
      case ShapeKind::capsule:
        return center_ + end(direction) + radius_ * direction;
      case ShapeKind::cylinder:
        return center_ + end(direction) + rim(direction);
      case ShapeKind::cone: {
        const Vec3 apex = center_ + half_ * axis_;
        const Vec3 base = center_ - half_ * axis_ + rim(direction);
        return glm::dot(apex, direction) > glm::dot(base, direction) ? apex : base;
      }
      default: {
        const Vec3* best = vertices_.data();
        double most = glm::dot(*best, direction);
        for (const Vec3& v : vertices_) {
          const double along = glm::dot(v, direction);
          if (along <= most) continue;
          most = along;
          best = &v;
        }
        return *best;
      }
    }
  }

 private:
  Vec3 end(const Vec3& direction) const { return glm::dot(axis_, direction) < 0 ? -half_ * axis_ : half_ * axis_; }
  Vec3 rim(const Vec3& direction) const {
    const Vec3 across = direction - glm::dot(direction, axis_) * axis_;
    const double length = glm::length(across);
    // along the axis only rounding is left across, in any direction: the middle of the rim is as far
    return length > 1e-8 ? radius_ / length * across : Vec3(0);
  }

  ShapeKind kind_;
  bool solid_ = true;
  Vec3 center_, axis_;
  double radius_ = 0;
  double half_ = 0;
  std::vector<Vec3> vertices_;
  OverlapBox box_;
};

/// A polytope inside the Minkowski difference of two solids, which grows where it is nearest to the origin. The depth
/// is the least support distance over all directions: each sampled direction bounds it from above, the nearest face
/// from below.
class PolytopeExpansion {
 public:
  PolytopeExpansion(const ConvexSolid& a, const ConvexSolid& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {}

  /// 0 where it is at most the tolerance.
  double depth() {
    if (!start()) return 0;
    for (int i = 0; i < kMaxExpansions; ++i) {
      const Face* const nearest = nearest_face();
      if (nearest == nullptr) break;
      const Vec3 normal = nearest->normal;
      const double lower = nearest->distance;
      const double precision = std::max(kDepthPrecision, kRelativeDepthPrecision * least_);
      if (lower > tolerance_ && (least_ - lower < precision || i > kMaxExpansions / 4)) break;
      const Vec3 point = sample(normal);
      if (separated()) return 0;
      if (glm::dot(point, normal) - lower < kDepthPrecision) break;
      if (!expand(point)) break;
    }
    return least_;
  }

 private:
  struct Face {
    std::array<int, 3> corner;
    Vec3 normal;
    double distance;  // of its plane from the origin, along the normal
    bool flat;        // without area: never chosen, never visible
  };

  bool separated() const { return least_ <= tolerance_; }

  Vec3 sample(const Vec3& direction) {
    const Vec3 point = a_.support(direction) - b_.support(-direction);
    least_ = std::min(least_, glm::dot(point, direction));
    return point;
  }

  // the first tetrahedron; false where a direction already separates the two, or the difference has no volume
  bool start() {
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
    double most = -1;
    for (const Vec3& direction : directions) {
      const Vec3 point = sample(direction);
      if (measure(point) <= most) continue;
      most = measure(point);
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

  // replaces the faces that see the point by those that connect their outline with it
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

  // an edge that two removed faces share, in opposite directions, is inside
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
  double least_ = std::numeric_limits<double>::infinity();
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
    ConvexSolid solid(placed, part.pose);
    if (!solid.solid()) continue;
    out.box.add(solid.box());
    out.solids.push_back(std::move(solid));
  }
  return out;
}

// the first pair of shapes that overlaps decides
double parts_overlap(const OverlapSolids& a, const OverlapSolids& b, std::size_t& work) {
  for (const ConvexSolid& x : a.solids) {
    for (const ConvexSolid& y : b.solids) {
      ++work;
      if (box_overlap(x.box(), y.box()) <= kOverlapTolerance) continue;
      work += kNarrowWork;
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
  if (!x.solid() || !y.solid() || box_overlap(x.box(), y.box()) <= tolerance) return 0;
  return PolytopeExpansion(x, y, tolerance).depth();
}

OverlapResult find_overlaps(std::span<const OverlapPart> parts,
                            const std::function<bool(std::size_t a, std::size_t b)>& wanted) {
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
      if (box_overlap(solids[a].box, solids[b].box) <= kOverlapTolerance || !wanted(a, b)) continue;
      if (work > kMaxOverlapWork) {
        ++out.unchecked;
        continue;
      }
      const double depth = parts_overlap(solids[a], solids[b], work);
      if (depth == 0 && work > kMaxOverlapWork) ++out.unchecked;
      if (depth > 0) out.found.push_back({static_cast<int>(a), static_cast<int>(b), depth});
    }
  }
  std::sort(out.found.begin(), out.found.end(),
            [](const Overlap& x, const Overlap& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  return out;
}

}  // namespace limber

// A polytope inside the difference A - B grows at its face nearest to the origin, until that lies on the surface.
#include "sim/collision/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace limber::sim::collision {
namespace {

constexpr int kMaxVertices = 96;
constexpr int kMaxFaces = 2 * kMaxVertices;
/// The surface is reached if a face would move by less than this share of the size of the difference. Support points
/// are of single precision.
constexpr double kEpaAccuracy = 1e-6;
/// A vector shorter than this share of the size is zero.
constexpr double kFlatShare = 1e-5;

class Polytope {
 public:
  explicit Polytope(const ShapeDifference& shapes) : shapes_(shapes) {}

  /// Starts with a tetrahedron; false if the difference is flat.
  bool begin();
  /// Grows until the nearest face lies on the surface. Returns it.
  int grow();
  Penetration result(int face) const;

 private:
  struct Face {
    std::array<int, 3> corners;
    Vec3 normal;      // outward
    double distance;  // of the plane from the origin, along the normal
    bool degenerate;  // without an area
  };
  struct Edge {
    int from;
    int to;
  };

  const Vec3& at(int vertex) const { return vertices_[static_cast<std::size_t>(vertex)].difference; }
  void add_vertex(const DifferencePoint& vertex) { vertices_[static_cast<std::size_t>(vertex_count_++)] = vertex; }
  void add_face(int a, int b, int c);
  bool insert(const DifferencePoint& vertex);
  bool add_line();
  bool add_triangle();
  int nearest_face() const;

  const ShapeDifference& shapes_;
  double size_ = 0;
  int vertex_count_ = 0;
  int face_count_ = 0;
  int edge_count_ = 0;
  std::array<DifferencePoint, kMaxVertices> vertices_;
  std::array<Face, kMaxFaces> faces_;
  std::array<Edge, 3 * kMaxFaces> horizon_;
};

// A direction perpendicular to another one.
Vec3 perpendicular(const Vec3& v) {
  const Vec3 a = glm::abs(v);
  const Vec3 axis = a.x <= a.y && a.x <= a.z ? Vec3(1, 0, 0) : (a.y <= a.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1));
  return glm::normalize(glm::cross(v, axis));
}

// The first edge: the longest extent along an axis.
bool Polytope::add_line() {
  DifferencePoint first;
  DifferencePoint second;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    const DifferencePoint low = shapes_.support(-axis);
    const DifferencePoint high = shapes_.support(axis);
    const double length = glm::length(high.difference - low.difference);
    if (length <= size_) continue;
    size_ = length;
    first = low;
    second = high;
  }
  add_vertex(first);
  add_vertex(second);
  return size_ > 0;
}

// The point farthest from the line.
bool Polytope::add_triangle() {
  const Vec3 line = (at(1) - at(0)) / glm::length(at(1) - at(0));
  const Vec3 across = perpendicular(line);
  double best = 0;
  DifferencePoint third;
  for (const Vec3& direction : {across, -across, glm::cross(line, across), -glm::cross(line, across)}) {
    const DifferencePoint candidate = shapes_.support(direction);
    const double distance = glm::length(glm::cross(line, candidate.difference - at(0)));
    if (distance <= best) continue;
    best = distance;
    third = candidate;
  }
  add_vertex(third);
  return best > kFlatShare * size_;
}

bool Polytope::begin() {
  if (!add_line() || !add_triangle()) return false;
  // the point farthest from the triangle
  const Vec3 normal = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
  const DifferencePoint above = shapes_.support(normal);
  const DifferencePoint below = shapes_.support(-normal);
  const double height = glm::dot(normal, above.difference - at(0));
  const double depth = glm::dot(normal, at(0) - below.difference);
  if (std::max(height, depth) <= kFlatShare * size_) return false;
  add_vertex(height >= depth ? above : below);
  // faces are counterclockwise as seen from outside
  const auto [second, third] = height >= depth ? std::pair(2, 1) : std::pair(1, 2);
  add_face(0, second, third);
  add_face(0, third, 3);
  add_face(third, second, 3);
  add_face(second, 0, 3);
  return true;
}

void Polytope::add_face(int a, int b, int c) {
  Face& face = faces_[static_cast<std::size_t>(face_count_++)];
  face.corners = {a, b, c};
  const Vec3 cross = glm::cross(at(b) - at(a), at(c) - at(a));
  const double area = glm::length(cross);
  face.degenerate = !(area > kEpaAccuracy * kEpaAccuracy * size_ * size_);
  face.normal = face.degenerate ? Vec3(0) : cross / area;
  face.distance = glm::dot(face.normal, at(a));
}

int Polytope::nearest_face() const {
  int nearest = -1;
  for (int i = 0; i < face_count_; ++i) {
    const Face& face = faces_[static_cast<std::size_t>(i)];
    if (face.degenerate) continue;
    if (nearest < 0 || face.distance < faces_[static_cast<std::size_t>(nearest)].distance) nearest = i;
  }
  return nearest;
}

// Replaces the faces that see the vertex by faces that connect it to their outline; false if there is no room.
bool Polytope::insert(const DifferencePoint& vertex) {
  edge_count_ = 0;
  const auto toggle = [&](int from, int to) {
    for (int i = 0; i < edge_count_; ++i) {
      Edge& edge = horizon_[static_cast<std::size_t>(i)];
      if (edge.from != to || edge.to != from) continue;
      edge = horizon_[static_cast<std::size_t>(--edge_count_)];
      return;
    }
    horizon_[static_cast<std::size_t>(edge_count_++)] = {from, to};
  };
  const double tolerance = 0.1 * kEpaAccuracy * size_;
  int kept = 0;
  for (int i = 0; i < face_count_; ++i) {
    const Face face = faces_[static_cast<std::size_t>(i)];
    if (!face.degenerate && glm::dot(face.normal, vertex.difference) - face.distance <= tolerance) {
      faces_[static_cast<std::size_t>(kept++)] = face;
      continue;
    }
    for (int k = 0; k < 3; ++k)
      toggle(face.corners[static_cast<std::size_t>(k)], face.corners[static_cast<std::size_t>((k + 1) % 3)]);
  }
  face_count_ = kept;
  if (face_count_ + edge_count_ > kMaxFaces) return false;
  const int index = vertex_count_;
  add_vertex(vertex);
  for (int i = 0; i < edge_count_; ++i)
    add_face(horizon_[static_cast<std::size_t>(i)].from, horizon_[static_cast<std::size_t>(i)].to, index);
  return true;
}

int Polytope::grow() {
  while (true) {
    const int nearest = nearest_face();
    if (nearest < 0) return -1;
    const Face face = faces_[static_cast<std::size_t>(nearest)];
    const DifferencePoint vertex = shapes_.support(face.normal);
    const double gain = glm::dot(face.normal, vertex.difference) - face.distance;
    if (gain <= kEpaAccuracy * size_ || vertex_count_ == kMaxVertices) return nearest;
    if (!insert(vertex)) return -1;
  }
}

Penetration Polytope::result(int index) const {
  const Face& face = faces_[static_cast<std::size_t>(index)];
  if (!(face.distance >= -kEpaAccuracy * size_)) return {};
  // barycentric coordinates of the point of the face nearest to the origin
  const Vec3 foot = face.normal * face.distance;
  std::array<double, 3> weights{};
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& p = at(face.corners[(k + 1) % 3]);
    const Vec3& q = at(face.corners[(k + 2) % 3]);
    weights[k] = std::max(glm::dot(face.normal, glm::cross(p - foot, q - foot)), 0.0);
    sum += weights[k];
  }
  Penetration result{true, std::max(face.distance, 0.0), -face.normal, Vec3(0)};
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = sum > 0 ? weights[k] / sum : 1.0 / 3;
    result.point_on_b += weight * vertices_[static_cast<std::size_t>(face.corners[k])].on_b;
  }
  return result;
}

}  // namespace

Penetration find_penetration(const ShapeDifference& shapes) {
  Polytope polytope(shapes);
  if (!polytope.begin()) return {};
  const int face = polytope.grow();
  return face < 0 ? Penetration{} : polytope.result(face);
}

}  // namespace limber::sim::collision

// Surface: neighbors from sorted edges; a tree that halves the triangles along the longest axis of their centers.
#include "model/mesh/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "model/mesh/hull.h"

namespace limber::model {

namespace {

constexpr unsigned kLeafSize = 4;

// The interval of a ray in a box begins here; infinity: it misses the box.
double enter(const Vec3& low, const Vec3& high, const Vec3& from, const Vec3& inverse, double max) {
  double begin = 0;
  double end = max;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - from[axis]) * inverse[axis];
    const double b = (high[axis] - from[axis]) * inverse[axis];
    // a NaN (0 times infinity) means that the ray runs within a side of the box
    if (std::min(a, b) > begin) begin = std::min(a, b);
    if (std::max(a, b) < end) end = std::max(a, b);
  }
  return begin <= end ? begin : std::numeric_limits<double>::infinity();
}

double box_distance(const Vec3& low, const Vec3& high, const Vec3& point) {
  return glm::length(glm::max(glm::max(low - point, point - high), Vec3(0)));
}

}  // namespace

Surface::Surface(std::shared_ptr<const MeshModel> mesh) : mesh_(std::move(mesh)) {
  const std::vector<unsigned>& corners = mesh_->triangles;
  triangles_.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const std::array<unsigned, 3> v{corners[i], corners[i + 1], corners[i + 2]};
    const Vec3 area = glm::cross(vertex(v[1]) - vertex(v[0]), vertex(v[2]) - vertex(v[0]));
    if (glm::length(area) > 1e-14) triangles_.push_back({v, {kNone, kNone, kNone}});
  }
  if (triangles_.empty()) return;
  find_neighbors();
  std::vector<Vec3> centers;
  centers.reserve(triangles_.size());
  for (const Indices& t : triangles_)
    centers.push_back(vertex(t.vertex[0]) + vertex(t.vertex[1]) + vertex(t.vertex[2]));
  std::vector<unsigned> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0U);
  build(0, static_cast<unsigned>(triangles_.size()), centers, order);
  std::vector<Indices> sorted;
  sorted.reserve(triangles_.size());
  for (const unsigned index : order) sorted.push_back(triangles_[index]);
  triangles_ = std::move(sorted);
  boxes_.reserve(triangles_.size());
  for (const Indices& t : triangles_) boxes_.push_back(box_of(t));
  low_ = Vec3(nodes_.front().box.low);
  high_ = Vec3(nodes_.front().box.high);
}

Surface::Triangle Surface::triangle(unsigned index) const {
  const Indices& t = triangles_[index];
  return {{vertex(t.vertex[0]), vertex(t.vertex[1]), vertex(t.vertex[2])}, t.beyond};
}

Surface::Box Surface::box_around(const Vec3& low, const Vec3& high) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{glm::vec3(low), glm::vec3(high)};
  for (int i = 0; i < 3; ++i) {
    if (static_cast<double>(box.low[i]) > low[i]) box.low[i] = std::nextafter(box.low[i], -kInfinity);
    if (static_cast<double>(box.high[i]) < high[i]) box.high[i] = std::nextafter(box.high[i], kInfinity);
  }
  return box;
}

Surface::Box Surface::box_of(const Indices& triangle) const {
  const Vec3 &a = vertex(triangle.vertex[0]), &b = vertex(triangle.vertex[1]), &c = vertex(triangle.vertex[2]);
  return box_around(glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c));
}

// An edge of more than two triangles has no neighbors: everything touches it as a border.
void Surface::find_neighbors() {
  struct Edge {
    std::uint64_t vertices;
    unsigned triangle;
    unsigned corner;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * triangles_.size());
  for (unsigned i = 0; i < triangles_.size(); ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      const auto [first, last] = std::minmax(triangles_[i].vertex[k], triangles_[i].vertex[(k + 1) % 3]);
      edges.push_back({std::uint64_t{first} << 32 | last, i, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.vertices, a.triangle) < std::pair(b.vertices, b.triangle);
  });
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].vertices == edges[i].vertices) ++end;
    if (end - i == 2) {
      Indices& a = triangles_[edges[i].triangle];
      Indices& b = triangles_[edges[i + 1].triangle];
      a.beyond[edges[i].corner] = b.vertex[(edges[i + 1].corner + 2) % 3];
      b.beyond[edges[i + 1].corner] = a.vertex[(edges[i].corner + 2) % 3];
    }
    i = end;
  }
}

void Surface::build(unsigned first, unsigned count, std::vector<Vec3>& centers, std::vector<unsigned>& order) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 box_low(kInfinity), box_high(-kInfinity), low(kInfinity), high(-kInfinity);
  for (unsigned i = first; i < first + count; ++i) {
    for (const unsigned v : triangles_[order[i]].vertex) {
      box_low = glm::min(box_low, vertex(v));
      box_high = glm::max(box_high, vertex(v));
    }
    low = glm::min(low, centers[order[i]]);
    high = glm::max(high, centers[order[i]]);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back({box_around(box_low, box_high), first, count <= kLeafSize ? count : 0, 0});
  if (count <= kLeafSize) return;
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const unsigned half = count / 2;
  const auto begin = order.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](unsigned a, unsigned b) {
    return std::pair(centers[a][axis], a) < std::pair(centers[b][axis], b);
  });
  build(first, half, centers, order);
  nodes_[index].second = static_cast<unsigned>(nodes_.size());
  build(first + half, count - half, centers, order);
}

// Moeller and Trumbore, Fast, Minimum Storage Ray-Triangle Intersection, 1997
std::optional<SurfaceHit> Surface::ray(const Vec3& from, const Vec3& direction, double max) const {
  const Vec3 inverse = 1.0 / direction;
  SurfaceHit nearest{max, Vec3(0)};
  bool found = false;
  const auto visit = [&](unsigned index) {
    const std::array<Vec3, 3> corner = triangle(index).corner;
    const Vec3 u = corner[1] - corner[0];
    const Vec3 v = corner[2] - corner[0];
    const Vec3 p = glm::cross(direction, v);
    const double determinant = glm::dot(u, p);
    if (determinant == 0) return;
    const Vec3 offset = from - corner[0];
    const double along_u = glm::dot(offset, p) / determinant;
    const Vec3 q = glm::cross(offset, u);
    const double along_v = glm::dot(direction, q) / determinant;
    const double distance = glm::dot(v, q) / determinant;
    // rays through an edge must not slip between its triangles
    constexpr double kSlack = 1e-12;
    if (along_u < -kSlack || along_v < -kSlack || along_u + along_v > 1 + kSlack) return;
    if (!(distance >= 0) || !(distance <= nearest.distance)) return;
    nearest = {distance, normalized(glm::cross(u, v)) * (determinant > 0 ? 1.0 : -1.0)};
    found = true;
  };
  walk(
      [&](const Box& box) {
        return enter(Vec3(box.low), Vec3(box.high), from, inverse, nearest.distance) <= nearest.distance;
      },
      visit);
  return found ? std::optional(nearest) : std::nullopt;
}

double Surface::distance(const Vec3& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  walk([&](const Box& box) { return box_distance(Vec3(box.low), Vec3(box.high), point) < nearest; },
       [&](unsigned index) {
         const std::array<Vec3, 3> corner = triangle(index).corner;
         nearest = std::min(nearest, triangle_distance(point, corner[0], corner[1], corner[2]));
       });
  return nearest;
}

ShapeModel surface_shape(std::shared_ptr<const MeshModel> mesh) {
  ShapeModel shape;
  shape.kind = ShapeKind::mesh;
  shape.mesh = std::move(mesh);
  shape.surface = std::make_shared<Surface>(shape.mesh);
  return shape;
}

}  // namespace limber::model

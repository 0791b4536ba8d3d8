// Surface: the triangles of a mesh as what others collide with, in a tree of bounding boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::model {

/// Where a ray meets a surface.
struct SurfaceHit {
  double distance = 0;  ///< Along the ray, m.
  Vec3 normal{0};       ///< Of the side that the ray comes from, unit length.
};

/// Immutable; the cost of a query follows the number of triangles near it. It has no inside: both sides are equal.
/// [any]
class Surface {
 public:
  static constexpr unsigned kNone = ~0U;
  struct Triangle {
    std::array<Vec3, 3> corner;  ///< Counter-clockwise about the normal.
    /// For each edge, from corner i to the next: the third vertex of the triangle that shares it. Index; kNone: none.
    std::array<unsigned, 3> beyond;
  };

  /// Leaves out triangles without an area.
  explicit Surface(std::shared_ptr<const MeshModel> mesh);

  std::size_t size() const { return triangles_.size(); }
  Triangle triangle(unsigned index) const;
  const Vec3& vertex(unsigned index) const { return mesh_->vertices[index]; }
  const Vec3& low() const { return low_; }
  const Vec3& high() const { return high_; }

  /// Calls visit(index) for each triangle whose bounding box overlaps the box, in an order that is always the same.
  template <class Visit>
  void for_each_near(const Vec3& low, const Vec3& high, Visit&& visit) const {
    const Box near = box_around(low, high);
    walk([&](const Box& box) { return overlap(box, near); },
         [&](unsigned index) {
           if (overlap(boxes_[index], near)) visit(index);
         });
  }
  /// The first point of a ray on the surface, at most `max` away. `direction` has unit length.
  std::optional<SurfaceHit> ray(const Vec3& from, const Vec3& direction, double max) const;
  /// Distance of a point from the surface.
  double distance(const Vec3& point) const;

 private:
  struct Box {  // of single precision, rounded outward: half the memory to read
    glm::vec3 low, high;
  };
  struct Node {  // in depth-first order: the first child follows its parent
    Box box;
    unsigned first = 0;   // of the triangles of a leaf
    unsigned count = 0;   // 0: not a leaf
    unsigned second = 0;  // the second child
  };
  struct Indices {
    std::array<unsigned, 3> vertex;
    std::array<unsigned, 3> beyond;
  };
  static constexpr std::size_t kMaxDepth = 64;

  static bool overlap(const Box& a, const Box& b) {
    return a.low.x <= b.high.x && a.high.x >= b.low.x && a.low.y <= b.high.y && a.high.y >= b.low.y &&
           a.low.z <= b.high.z && a.high.z >= b.low.z;
  }
  static Box box_around(const Vec3& low, const Vec3& high);
  Box box_of(const Indices& triangle) const;
  void find_neighbors();
  void build(unsigned first, unsigned count, std::vector<Vec3>& centers, std::vector<unsigned>& order);

  // visits the triangles of all leaves whose boxes, and those of their parents, are accepted
  template <class Accept, class Visit>
  void walk(Accept&& accept, Visit&& visit) const {
    std::array<unsigned, kMaxDepth> stack;
    std::size_t depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const unsigned index = stack[--depth];
      const Node& node = nodes_[index];
      if (!accept(node.box)) continue;
      for (unsigned i = 0; i < node.count; ++i) visit(node.first + i);
      if (node.count > 0) continue;
      stack[depth++] = node.second;
      stack[depth++] = index + 1;
    }
  }

  std::shared_ptr<const MeshModel> mesh_;
  std::vector<Indices> triangles_;  // in the order of the leaves
  std::vector<Box> boxes_;          // of the triangles
  std::vector<Node> nodes_;
  Vec3 low_{0};
  Vec3 high_{0};
};

/// The shape of a mesh that collides with its triangles. [any]
ShapeModel surface_shape(std::shared_ptr<const MeshModel> mesh);

}  // namespace limber::model

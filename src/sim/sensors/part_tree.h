// PartTree: a bounding volume hierarchy of all parts in their present poses, for rays and spheres. It is built when it
// is first used after a change. Results don't depend on how it was built. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/vec.h"
#include "sim/sensors/solid.h"

namespace limber::sim {

class Body;
class Part;
class World;
struct Geometry;

/// Parts that a query skips; null: none.
struct Ignored {
  const Body* body = nullptr;
  const Part* part = nullptr;
};

struct RayHit {
  const Part* part = nullptr;
  Vec3 position{0};
  Vec3 normal{0};       ///< Of the surface, world, unit length.
  double distance = 0;  ///< m
};

struct NearPart {
  const Part* part = nullptr;
  double distance = 0;  ///< Of its surface from the point, m; negative: the point is inside.
};

class PartTree {
 public:
  explicit PartTree(World& world) : world_(world) {}

  /// Call when poses have changed. Added and removed parts are noticed without it.
  void invalidate() { valid_ = false; }
  /// Call when a body was enabled or disabled.
  void invalidate_bodies() { valid_ = same_bodies_ = false; }

  /// Returns the nearest part that a ray enters at most `max` away. `direction` has unit length. A ray that starts in a
  /// part doesn't hit it.
  std::optional<RayHit> ray(const Vec3& from, const Vec3& direction, double max, const Ignored& ignored = {});
  /// Finds the parts that are at most `radius` away from a point, in stream order.
  void find_near(const Vec3& center, double radius, const Ignored& ignored, std::vector<NearPart>& found);

 private:
  /// A solid of a part.
  struct Item {
    const Part* part = nullptr;
    const Solid* solid = nullptr;
    Pose pose;  // of the solid, world
    Vec3 low{0}, high{0};
  };
  struct Node {
    Vec3 low{0}, high{0};
    std::uint32_t first = 0;  // of a leaf: in order_
    std::uint32_t count = 0;  // 0: inner node; its children are the next node and `right`
    std::uint32_t right = 0;
  };
  struct Nearest {
    double distance;
    std::uint32_t item;
    Vec3 normal;
  };
  struct Solids {
    std::shared_ptr<const Geometry> geometry;
    std::vector<Solid> list;
  };

  void update();
  void collect();
  void place(Item& item) const;
  void build();
  std::uint32_t build_node(std::uint32_t first, std::uint32_t count);
  void refit();
  const std::vector<Solid>& solids_of(const Part& part);
  void test(std::uint32_t item, const Vec3& from, const Vec3& direction, const Ignored& ignored,
            Nearest& nearest) const;
  static bool is_ignored(const Part& part, const Ignored& ignored);

  World& world_;
  bool valid_ = false;
  bool same_bodies_ = false;
  std::uint64_t structure_version_ = 0;
  int refits_ = 0;
  std::unordered_map<const Geometry*, Solids> solids_;
  std::vector<Item> items_;              // in stream order
  std::vector<std::uint32_t> infinite_;  // items without bounds
  std::vector<std::uint32_t> order_;     // the other items, by leaves
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> pending_;  // nodes to visit
  std::vector<std::uint32_t> near_items_;
};

}  // namespace limber::sim

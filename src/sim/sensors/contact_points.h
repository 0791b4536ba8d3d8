// ContactPoints: the contact points of parts that report contacts, with their impulses summed over the substeps of a
// tick. [sim]
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"

class btManifoldPoint;

namespace limber {
class Archive;
class Store;
}  // namespace limber

namespace limber::sim {

class Part;

/// A point at which two parts touched during the tick.
struct ContactPoint {
  NodeId a, b;               ///< The two parts; a < b.
  Vec3 position{0};          ///< World, as of its last substep.
  Vec3 normal{0};            ///< World, unit length, from b to a: the direction in which b pushes a.
  Vec3 friction{0};          ///< Friction impulse on a, N·s, sum over the tick.
  double impulse = 0;        ///< Normal impulse, N·s, sum over the tick.
  double distance = 0;       ///< m; negative: penetration.
  std::uint32_t order = 0;   ///< Order of collection in its substep.
  std::uint32_t in_use = 0;  ///< 1: the parts touched there in the last substep.
};

/// A contact point from the side of one of its parts.
struct PartContact {
  NodeId part;
  std::uint32_t point = 0;  ///< Index in ContactPoints::list().

  auto operator<=>(const PartContact&) const = default;
};

class ContactPoints {
 public:
  /// Forgets the points of the last tick.
  void begin_tick();
  /// Adds a point of the present substep, with the impulse on `a` that was solved for it.
  void add(const Part& a, const Part& b, const btManifoldPoint& point);
  /// Merges the points added in this substep into those of the tick: each continues the nearest point of its pair.
  void end_substep();
  /// Indexes the points by part. `seconds`: length of the tick.
  void end_tick(const Store& store, double seconds);

  /// Sorted by a, then b.
  std::span<const ContactPoint> list() const { return state_.points; }
  /// Points of a part that reports contacts.
  std::span<const PartContact> of(NodeId part) const;
  /// Points of all parts that stream their contacts.
  std::span<const PartContact> streamed() const { return state_.streamed; }
  /// Sum of the normal impulses between two parts, N·s.
  double impulse_between(NodeId a, NodeId b) const;
  /// Length of the last tick, s; impulses divided by it are mean forces.
  double seconds() const { return state_.seconds; }
  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  void merge(const ContactPoint& point, std::size_t first, std::size_t last);

  // what persists from tick to tick
  struct State {
    std::vector<ContactPoint> points;
    std::vector<PartContact> by_part;  // sorted
    std::vector<PartContact> streamed;
    double seconds = 1;
  } state_;
  std::vector<ContactPoint> added_;  // in this substep
  std::vector<ContactPoint> merged_;
};

}  // namespace limber::sim

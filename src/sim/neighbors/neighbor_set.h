// NeighborSet: a set of parts for neighbor queries. Positions are gathered once per tick, and queries with the same
// distance share a grid. Built-in group behaviors query means over neighbors; Lua queries the neighbors. [sim]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "sim/neighbors/motion_grids.h"
#include "sim/neighbors/neighbor_lists.h"
#include "sim/neighbors/neighbor_means.h"
#include "sim/neighbors/part_cloud.h"

namespace limber::sim {

/// Result of find_near(): a part near another.
struct Neighbor {
  std::uint32_t index = 0;  ///< index in the set's parts
  Vec3 offset{0};           ///< from center of mass to center of mass, m
  double distance = 0;
};

class NeighborSet {
 public:
  /// `parts`: in stream order (bodies in the order of World::bodies(), a body from root to tip), without duplicates.
  NeighborSet(World& world, std::vector<Part*> parts);
  NeighborSet(const NeighborSet&) = delete;
  NeighborSet& operator=(const NeighborSet&) = delete;

  std::span<Part* const> parts() const { return cloud_.parts(); }
  /// True if the set consists of exactly these parts, compared by id, since addresses may be reused.
  bool consists_of(std::span<Part* const> parts) const { return cloud_.consists_of(parts); }

  /// Returns the means for each of `parts` (not necessarily in the set) over neighbors with min_distance <= distance
  /// <= max_distance (m). Valid until the next call. Repeated queries in one tick are answered from a cache. If
  /// `max_distance` covers all parts, the cost is linear in their number.
  std::span<const NeighborMeans> means(std::span<Part* const> parts, double min_distance, double max_distance,
                                       unsigned want);
  /// Returns the means for one part. A `min_distance` below 0 counts as 0. If the part is in the set, the first query
  /// in a tick computes the means of all parts, as one array in the order of parts(), which is valid until the next
  /// tick or change of the set. For another part, the result is valid until the next call.
  const NeighborMeans& means_near(const Part& part, double min_distance, double max_distance, unsigned want);
  /// Index in parts() by the slot of a part, or -1. A result of means_near() for a part of the set is an element of
  /// an array of the results for all parts in this order, which is valid until the next tick or change of the set.
  std::span<const std::int32_t> index_of_slot() const { return cloud_.index_of_slot(); }
  /// Finds all parts within `radius` of a part, in the order of parts().
  void find_near(const Part& part, double radius, std::vector<Neighbor>& out);
  /// Removes the parts of a body; call before the body is destroyed.
  void remove_body(const Body& body) { cloud_.remove_body(body); }

 private:
  struct CachedMeans {
    double min_distance = 0, max_distance = 0;
    unsigned computed = 0;          // the means that were computed
    unsigned requested = 0;         // the means that were requested in this tick
    unsigned requested_before = 0;  // and in the previous tick
    bool used = false;              // in this tick
    std::uint64_t structure = 0;
    std::vector<Part*> parts;
    std::vector<PartData> part_data;
    std::vector<std::uint32_t> set_indices;  // see MeansCalculator::Query
    std::vector<NeighborMeans> means;
  };
  struct SetQuery {  // a query of all parts in this tick; its results don't move until the next tick
    double min_distance = 0, max_distance = 0;
    unsigned computed = 0;
    const NeighborMeans* means = nullptr;
  };

  void gather();
  CachedMeans& cache_for(std::span<Part* const> parts, double min_distance, double max_distance);
  void update_parts(CachedMeans& cache, std::span<Part* const> parts) const;

  World& world_;
  PartCloud cloud_;
  MotionGrids grids_{cloud_};
  MeansCalculator calculator_{cloud_, grids_};
  NeighborLists lists_;
  std::vector<CachedMeans> cached_means_;
  std::vector<SetQuery> set_queries_;  // of this tick
  NeighborMeans single_means_;         // result for a part that is not in the set
  std::vector<std::uint32_t> found_;   // scratch
};

}  // namespace limber::sim

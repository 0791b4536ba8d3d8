// NeighborSet: a set of parts for neighbor queries. Positions are gathered once per tick, and queries with the same
// distance share a grid. Built-in group behaviors query means over neighbors; Lua queries the neighbors. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/id.h"
#include "base/vec.h"
#include "sim/neighbors/neighbor_lists.h"
#include "sim/neighbors/neighbor_sums.h"
#include "sim/neighbors/point_grid.h"

namespace limber {

class Body;
class Part;
class World;

/// Result of find_near(): a part near another.
struct Neighbor {
  std::uint32_t index = 0;  ///< index in the set's parts
  Vec3 offset{0};           ///< from center of mass to center of mass, m
  double distance = 0;
};

/// Means over the neighbors of a part: parts of other bodies between two distances. All zero if there are none.
struct NeighborMeans {
  std::uint32_t count = 0;
  float offset[3] = {};    ///< mean offset, m
  float velocity[3] = {};  ///< mean velocity relative to the part, m/s
  float spin[3] = {};      ///< mean angular velocity relative to the part, rad/s
  float push[3] = {};      ///< mean of unit vectors to the neighbors times 1 − distance/max_distance
};

/// Bits for the means that are needed besides count and offset.
inline constexpr unsigned kWantVelocity = 1;
inline constexpr unsigned kWantPush = 2;

class NeighborSet {
 public:
  /// `parts`: in stream order, without duplicates.
  NeighborSet(World& world, std::vector<Part*> parts);
  NeighborSet(const NeighborSet&) = delete;
  NeighborSet& operator=(const NeighborSet&) = delete;

  std::span<Part* const> parts() const { return parts_; }
  /// True if the set consists of exactly these parts, compared by id, since addresses may be reused.
  bool consists_of(std::span<Part* const> parts) const;

  /// Returns the means for each of `parts` (not necessarily in the set) over neighbors with min_distance <= distance
  /// <= max_distance (m). Valid until the next call. Repeated queries in one tick are answered from a cache. If
  /// `max_distance` covers all parts, the cost is linear in their number.
  std::span<const NeighborMeans> means(std::span<Part* const> parts, double min_distance, double max_distance,
                                       unsigned want);
  /// Returns the means for one part. If it is in the set, the first query in a tick computes the means of all parts.
  /// A `min_distance` below 0 counts as 0. Valid until the next call.
  const NeighborMeans& means_near(const Part& part, double min_distance, double max_distance, unsigned want);
  /// Index in parts() by the slot of a part, or -1. A result of means_near() for a part of the set is an element of
  /// an array of the results for all parts in this order, which is valid until the next tick or change of the set.
  std::span<const std::int32_t> index_of_slot() const { return index_of_slot_; }
  /// Finds all parts within `radius` of a part, in the order of parts().
  void find_near(const Part& part, double radius, std::vector<Neighbor>& out);
  /// Removes the parts of a body; call before the body is destroyed.
  void remove_body(const Body& body);

 private:
  struct PartData {
    std::uint32_t transient_offset = 0;  // offset of the part's transient values
    std::uint32_t enabled_offset = 0;    // offset of its body's `enabled`
    std::int32_t body = 0;               // slot of its body
    bool centered = true;                // the center of mass is the link frame's origin
    Vec3 center{0};                      // else its position in the link frame
  };
  struct alignas(32) Velocities {  // with the layout of NeighborMotion
    float velocity[4], spin[4];
  };
  struct alignas(16) Push {
    float sum[4];
  };
  struct Grid {
    PointGrid grid;
    bool used = false;                    // in this tick
    unsigned filled = 0;                  // bit set; 1: positions, 2: velocities
    std::vector<NeighborMotion> motions;  // in the grid's order
  };
  struct CachedMeans {
    double min_distance = 0, max_distance = 0;
    unsigned computed = 0;          // the means that were computed
    unsigned requested = 0;         // the means that were requested in this tick
    unsigned requested_before = 0;  // and in the previous tick
    bool used = false;              // in this tick
    std::uint64_t structure = 0;
    std::vector<Part*> parts;
    std::vector<PartData> part_data;
    std::vector<std::uint32_t> set_indices;  // indices of `parts` in parts_, if `parts` has at least half of them in
                                             // ascending order; else empty
    std::vector<NeighborMeans> means;
  };
  struct SetQuery {  // a query of all parts in this tick; its results don't move until the next tick
    double min_distance = 0, max_distance = 0;
    unsigned computed = 0;
    const NeighborMeans* means = nullptr;
  };
  struct Totals {
    double count = 0;
    Vec3 position{0}, velocity{0}, spin{0};
  };

  void index_parts();
  std::uint32_t index_of(const Part& part) const;
  PartData data_of(const Part& part) const;
  Vec3 center_of(const PartData& data) const;
  void gather();
  void update_parts(CachedMeans& cache, std::span<Part* const> parts) const;
  bool covers_all(const CachedMeans& cache) const;
  Grid& grid_for(float search_radius);
  void gather_motions();
  void fill_motions(Grid& grid, unsigned want);
  void compute_by_totals(CachedMeans& cache);
  void compute_by_grid(CachedMeans& cache);
  template <unsigned Want>
  NeighborMeans sum_near(Grid& grid, const PartData& data, double min_distance, double max_distance);
  /// Sums each part's neighbors separately.
  template <unsigned Want>
  void sum_each(Grid& grid, CachedMeans& cache);
  /// Sums all parts' neighbors, visiting each pair once.
  template <unsigned Want>
  void sum_pairs(Grid& grid, CachedMeans& cache);
  void push_pairs(std::uint32_t index, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                  float inverse_max_distance);
  template <unsigned Want>
  void sum(Grid& grid, CachedMeans& cache);
  NeighborMeans relative_means(const NeighborSum& sum, const Push& push, unsigned want, const PartData& data) const;

  World& world_;
  std::vector<Part*> parts_;
  std::vector<NodeId> ids_;
  std::vector<PartData> part_data_;
  std::vector<std::int32_t> index_of_slot_;  // index in parts_ by slot; -1: not in the set
  std::vector<Vec3> centers_;                // centers of mass of the parts with enabled bodies
  NeighborLists lists_;
  std::vector<std::int32_t> body_ordinals_;  // of bodies by slot; -1: has no part in the set
  std::int32_t body_count_ = 0;
  std::uint64_t gathered_step_ = 0;           // BehaviorList::step_count() at the last gather()
  PointCloud cloud_;                          // parts with enabled bodies
  std::vector<std::uint32_t> cloud_indices_;  // indices of the cloud's points in parts_
  std::vector<std::unique_ptr<Grid>> grids_;
  std::vector<CachedMeans> cached_means_;
  std::vector<SetQuery> set_queries_;      // of this tick
  NeighborMeans single_means_;             // result for a part that is not in the set
  std::vector<std::uint32_t> found_;       // scratch
  std::vector<std::uint32_t> grid_index_;  // scratch: index in the grid by index in parts_
  std::vector<NeighborSum> sums_;          // scratch, by index in the grid
  std::vector<Push> pushes_;
  std::vector<Velocities> motions_;  // scratch, of the cloud's points, in their order
  bool motions_gathered_ = false;
  std::vector<Totals> body_totals_;  // scratch, by ordinal
};

}  // namespace limber

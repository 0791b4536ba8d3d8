// MeansCalculator: means over the neighbors of parts: by totals, by pairs, or part by part.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/neighbors/motion_grids.h"
#include "sim/neighbors/neighbor_sums.h"
#include "sim/neighbors/part_cloud.h"

namespace limber::sim {

/// Means over the neighbors of a part: parts of other bodies between two distances. All zero if there are none.
struct NeighborMeans {
  std::uint32_t count = 0;
  float offset[3] = {};            ///< mean offset, m
  float velocity[3] = {};          ///< mean velocity relative to the part, m/s
  float angular_velocity[3] = {};  ///< mean angular velocity relative to the part, rad/s
  float separation[3] = {};        ///< mean of unit vectors to the neighbors times 1 − distance/max_distance
};

/// Bits for the means that are needed besides count and offset.
inline constexpr unsigned kWantVelocity = 1;
inline constexpr unsigned kWantSeparation = 2;

/// Keeps its scratch memory from query to query. [sim]
class MeansCalculator {
 public:
  struct Query {
    double min_distance;  ///< m; neighbors have min_distance <= distance <= max_distance
    double max_distance;
    unsigned want;
    std::span<const PartData> parts;
    /// Indices of the parts in the cloud's, if they have at least half of them in ascending order; else empty.
    std::span<const std::uint32_t> set_indices;
  };

  MeansCalculator(const PartCloud& cloud, MotionGrids& grids) : cloud_(cloud), grids_(grids) {}

  /// Computes the means of each part of the query. If `max_distance` covers all parts, the cost is linear in their
  /// number. `means`: zero for each part.
  void compute(const Query& query, std::span<NeighborMeans> means);
  /// Returns all means of one part.
  NeighborMeans compute(const PartData& part, double min_distance, double max_distance);

 private:
  struct alignas(16) Separation {
    float sum[4];
  };
  struct Totals {
    double count = 0;
    Vec3 position{0}, velocity{0}, angular_velocity{0};
  };

  bool covers_all(const Query& query) const;
  void compute_by_totals(const Query& query, std::span<NeighborMeans> means);
  template <unsigned Want>
  void compute_by_grid(const Query& query, MotionGrids::Grid& grid, std::span<NeighborMeans> means);
  template <unsigned Want>
  NeighborMeans sum_near(MotionGrids::Grid& grid, const PartData& part, double min_distance, double max_distance);
  /// Sums the neighbors of all points, visiting each pair once.
  template <unsigned Want>
  void sum_pairs(const Query& query, MotionGrids::Grid& grid);
  void sum_pair_separations(std::uint32_t index, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                            float inverse_max_distance);
  static NeighborMeans means_from_sums(const NeighborSum& sum, const Separation& separation, unsigned want,
                                       const NeighborMotion& own);

  const PartCloud& cloud_;
  MotionGrids& grids_;
  // scratch
  std::vector<std::uint32_t> found_;
  std::vector<std::uint32_t> grid_index_;  // index in the grid by index of the part
  std::vector<NeighborSum> sums_;          // by index in the grid
  std::vector<Separation> separations_;
  std::vector<Totals> body_totals_;  // by ordinal
};

}  // namespace limber::sim

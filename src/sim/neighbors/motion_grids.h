// MotionGrids: grids of the points of a PartCloud for searches of different radii, with the points' motions. Searches
// of similar radii share a grid.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/neighbors/neighbor_sums.h"
#include "sim/neighbors/part_cloud.h"
#include "sim/neighbors/point_grid.h"

namespace limber::sim {

class MotionGrids {
 public:
  struct Grid {
    PointGrid grid;
    std::vector<NeighborMotion> motions;  ///< In the grid's order; see fill_motions().
    bool used = false;                    ///< In this tick.
    unsigned filled = 0;                  ///< Bit set; 1: positions, 2: velocities.
  };

  explicit MotionGrids(const PartCloud& cloud) : cloud_(cloud) {}

  /// Call when the cloud has gathered new points.
  void begin_tick();
  /// Returns a grid for searches up to this radius, m. It doesn't move until the set is destroyed.
  Grid& find(float search_radius);
  /// Fills the grid's motions: positions, and velocities if wanted.
  void fill_motions(Grid& grid, bool velocities);

 private:
  struct alignas(32) Velocities {  // with the layout of NeighborMotion
    float velocity[4], angular_velocity[4];
  };
  void gather_velocities();

  const PartCloud& cloud_;
  std::vector<std::unique_ptr<Grid>> grids_;
  std::vector<Velocities> velocities_;  // of the cloud's points, in their order
  bool velocities_gathered_ = false;
};

}  // namespace limber::sim

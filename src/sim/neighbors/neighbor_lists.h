// NeighborLists: neighbor lists of the parts of a set, for queries part by part. If most parts are queried at every
// tick (a Lua group behavior), all lists are built at once, in the grid's order, at a fraction of the cost. [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/neighbors/point_grid.h"

namespace limber::sim {

class NeighborLists {
 public:
  /// Input for the lists: points, their grid, and the part of each point.
  struct Source {
    const PointCloud& cloud;
    PointGrid& grid;
    std::span<const std::uint32_t> parts;  ///< Indices of the parts of the cloud's points.
    std::size_t part_count;
  };

  /// Invalidates all lists, because of a new tick or other points.
  void invalidate();
  /// Returns the parts within `radius` (m) of a part in ascending order, or nothing if the caller should query the grid
  /// itself. The result is the same either way; only the cost differs.
  std::optional<std::span<const std::uint32_t>> find(std::uint32_t part, float radius, const Source& source);

 private:
  struct Lists {
    float radius = 0;
    std::size_t queries = 0;           // number of queries in this tick
    std::size_t previous_queries = 0;  // and in the previous tick
    bool built = false;
    std::vector<std::uint32_t> first, count;  // by part
    std::vector<std::uint32_t> all;
  };
  Lists& lists_for(float radius);
  void build(Lists& lists, const Source& source);

  std::vector<Lists> lists_;
  std::vector<std::uint32_t> found_, part_at_;  // scratch
};

}  // namespace limber::sim

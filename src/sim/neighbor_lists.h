// NeighborLists: which parts of a set are near which, for those who ask one by one. Where most of them ask in every
// tick (a group of behaviours in Lua), all lists are made at once, in the grid's order, at a fraction of the cost.
// [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/point_grid.h"

namespace limber {

class NeighborLists {
 public:
  /// What the lists are made of: points, their grid, and of which part each point is.
  struct Source {
    const PointCloud& cloud;
    PointGrid& grid;
    std::span<const std::uint32_t> parts;  ///< Of the cloud's points.
    std::size_t part_count;
  };

  /// Another tick, or other points: nothing is known any more.
  void begin();
  /// The parts within `reach` of a part, ascending; nothing when it is to be looked for alone. Which of both, makes no
  /// difference but in time.
  std::optional<std::span<const std::uint32_t>> of(std::uint32_t part, float reach, const Source& source);

 private:
  struct Lists {
    float reach = 0;
    std::size_t asked = 0;         // in this tick
    std::size_t asked_before = 0;  // and in the one before
    bool made = false;
    std::vector<std::uint32_t> first, count;  // by part
    std::vector<std::uint32_t> all;
  };
  Lists& lists_for(float reach);
  void make(Lists& lists, const Source& source);

  std::vector<Lists> lists_;
  std::vector<std::uint32_t> found_, part_at_;  // scratch
};

}  // namespace limber

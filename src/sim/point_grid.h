// PointGrid: many points sorted into cells, so that those near a place are found without looking at all. Distances are
// compared as floats, in a fixed order: the same on every processor. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/point_finder.h"

namespace limber {

/// Points as arrays, each with the number of the body that it belongs to.
struct PointCloud {
  std::vector<float> x, y, z;  ///< m, finite.
  std::vector<std::int32_t> body;
  std::array<float, 3> low{}, high{};  ///< The box around them.
  bool one_each = true;                ///< No two points are of one body: the adder says so.

  std::size_t size() const { return x.size(); }
  void clear();
  void add(float px, float py, float pz, std::int32_t of_body);
};

class PointGrid {
 public:
  /// `lanes`: it finds the same whatever they are.
  explicit PointGrid(PointLanes lanes = PointFinder::widest()) : finder_(lanes) {}

  /// Sorts a cloud for distances up to `reach` (>= 0); costs a few nanoseconds a point.
  void build(const PointCloud& cloud, float reach);
  float reach() const { return reach_; }
  std::size_t size() const { return order_.size(); }

  /// Places, in the grid's order, of all points with least <= distance <= most (<= reach), written to `out`, which has
  /// room for size() + kPointRoom; how many. Queries that follow each other within a cell cost least.
  std::uint32_t near(const PointQuery& query, float least, float most, std::uint32_t* out);
  /// The same around the point at a place, but of each pair of points only one finds the other: for sums over all
  /// pairs, at half the cost. Call it for every place, in order.
  std::uint32_t near_once(std::uint32_t place, float least, float most, std::uint32_t* out);
  /// The cloud's index of the point at each place. Points of one cell stand together.
  std::span<const std::uint32_t> order() const { return order_; }

 private:
  /// Wraps around: cells that lie a whole grid apart share a place.
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Axis {
    float low = 0;  // where cell 0 begins
    std::uint32_t mask = 0;
  };
  /// Arrays that are read and written in whole lanes.
  struct Lanes {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> body;
    void resize(std::size_t points);
  };

  void lay_out(const PointCloud& cloud, float reach);
  std::uint32_t cell_at(float x, float y, float z) const;
  void collect(std::uint32_t cell, bool ahead);
  void collect_row(std::uint32_t cell, int from, int to, int dy, int dz);
  void collect_run(std::uint32_t begin, std::uint32_t end);
  PointArrays candidates_from(std::size_t from) const;

  PointFinder finder_;
  float reach_ = 0;
  bool one_each_ = false;
  float inverse_ = 1;  // cells a metre; a cell is a little wider than the reach
  Axis axis_[3];
  std::uint32_t bits_x_ = 0, bits_y_ = 0;
  std::vector<std::uint32_t> first_;  // of each cell, and one behind the last
  std::vector<std::uint32_t> cell_;   // of each of the cloud's points
  Lanes points_;                      // in the grid's order
  std::vector<std::uint32_t> order_;

  // what may be near the cell that was asked for last: the points of it and its 26 neighbours; or of it and the 13
  // that lie ahead
  std::uint32_t collected_ = kNone;
  bool ahead_ = false;
  std::size_t count_ = 0;
  Lanes candidates_;
  std::vector<std::uint32_t> places_;
};

}  // namespace limber

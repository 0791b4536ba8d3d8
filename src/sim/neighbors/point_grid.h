// PointGrid: a uniform grid of points for fast neighbor queries. Distances are compared as floats in a fixed order,
// so that results are the same on every processor. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/neighbors/point_finder.h"

namespace limber::sim {

/// Points in structure-of-arrays layout, each with the index of its body.
struct PointCloud {
  std::vector<float> x, y, z;  ///< m, finite
  std::vector<std::int32_t> body;
  std::array<float, 3> low{}, high{};  ///< bounding box
  bool one_per_body = true;            ///< no two points are of the same body; set by the caller

  std::size_t size() const { return x.size(); }
  void clear();
  void add(float px, float py, float pz, std::int32_t of_body);
};

class PointGrid {
 public:
  /// `width` has no influence on the result.
  explicit PointGrid(VectorWidth width = PointFinder::widest()) : finder_(width) {}

  /// Sorts a cloud into cells for searches up to a radius (m, >= 0); takes a few nanoseconds per point.
  void build(const PointCloud& cloud, float search_radius);
  float search_radius() const { return search_radius_; }
  std::size_t size() const { return order_.size(); }

  /// Writes the grid indices (indices into order()) of all points with min_distance <= distance <= max_distance (<=
  /// search_radius()) to `out`, which must have size() + kPointPadding elements; returns their number. Consecutive
  /// queries in the same cell are fastest.
  std::uint32_t find_near(const PointQuery& query, float min_distance, float max_distance, std::uint32_t* out);
  /// The same around the point with grid index `index`, but each pair of points is found only once: for sums over all
  /// pairs, at half the cost. Call it for every index, in order.
  std::uint32_t find_pairs(std::uint32_t index, float min_distance, float max_distance, std::uint32_t* out);
  /// For each grid index, the index of the point in the cloud. Points of the same cell are adjacent.
  std::span<const std::uint32_t> order() const { return order_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  // Cell indices wrap around: cells that are a multiple of the grid's size apart share an element.
  struct Axis {
    float low = 0;  // lower bound of cell 0
    std::uint32_t mask = 0;
  };
  /// Arrays that are read and written in whole vectors.
  struct PaddedArrays {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> body;
    void resize(std::size_t points);
  };

  void set_up_cells(const PointCloud& cloud, float search_radius);
  std::uint32_t cell_at(float x, float y, float z) const;
  void collect(std::uint32_t cell, bool ahead);
  void collect_row(std::uint32_t cell, int from, int to, int dy, int dz);
  void collect_run(std::uint32_t begin, std::uint32_t end);
  PointArrays candidates_from(std::size_t from) const;

  PointFinder finder_;
  float search_radius_ = 0;
  bool one_per_body_ = false;
  float inverse_ = 1;  // cells per meter; a cell is slightly larger than the radius
  Axis axis_[3];
  std::uint32_t bits_x_ = 0, bits_y_ = 0;
  std::vector<std::uint32_t> first_;  // grid index of each cell's first point; last: number of points
  std::vector<std::uint32_t> cell_;   // cell of each of the cloud's points
  PaddedArrays points_;               // in the grid's order
  std::vector<std::uint32_t> order_;

  // Candidates for the cell of the last query: the points of the cell and its 26 neighbors, or of the cell and the 13
  // neighbors ahead of it.
  std::uint32_t collected_ = kNone;  // the cell that candidates_ were collected for
  bool ahead_ = false;
  std::size_t candidate_count_ = 0;
  PaddedArrays candidates_;
  std::vector<std::uint32_t> candidate_indices_;
};

}  // namespace limber::sim

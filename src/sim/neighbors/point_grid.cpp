// PointGrid: the grid wraps around on every axis, so that distant points need no extra cells. Points that share a cell
// only for this reason are rejected by their distance.
#include "sim/neighbors/point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace limber::sim {

namespace {

constexpr std::size_t kVectorSize = 4;  // points that are copied together
constexpr std::uint32_t kMinCells = 4;  // per axis: then a cell and its two neighbors are distinct
constexpr float kMaxCell = 1e9f;        // no point is that far away

using FourIndices [[gnu::vector_size(16)]] = std::uint32_t;

}  // namespace

void PointCloud::clear() {
  x.clear();
  y.clear();
  z.clear();
  body.clear();
  low.fill(kPaddingCoordinate);
  high.fill(-kPaddingCoordinate);
}

void PointCloud::add(float px, float py, float pz, std::int32_t of_body) {
  const float point[] = {px, py, pz};
  for (std::size_t a = 0; a < 3; a++) {
    low[a] = std::min(low[a], point[a]);
    high[a] = std::max(high[a], point[a]);
  }
  x.push_back(px);
  y.push_back(py);
  z.push_back(pz);
  body.push_back(of_body);
}

// Adds padding for reads past the end and for copies in whole vectors.
void PointGrid::PaddedArrays::resize(std::size_t points) {
  const std::size_t padded = points + kVectorSize + kPointPadding;
  for (std::vector<float>* v : {&x, &y, &z}) v->resize(padded);
  body.resize(padded);
}

std::uint32_t PointGrid::cell_at(float x, float y, float z) const {
  const auto cell = [&](const Axis& axis, float v) {
    const float at = std::clamp((v - axis.low) * inverse_, -kMaxCell, kMaxCell);
    const auto whole = static_cast<std::int32_t>(at);
    return static_cast<std::uint32_t>(whole - (at < static_cast<float>(whole) ? 1 : 0)) & axis.mask;
  };
  return (cell(axis_[2], z) << bits_y_ | cell(axis_[1], y)) << bits_x_ | cell(axis_[0], x);
}

void PointGrid::set_up_cells(const PointCloud& cloud, float search_radius) {
  float largest = 0;
  std::array<float, 3> extents{};
  for (std::size_t a = 0; a < 3 && cloud.size() > 0; a++) {
    axis_[a].low = cloud.low[a];
    extents[a] = cloud.high[a] - cloud.low[a];
    largest = std::max({largest, extents[a], std::abs(cloud.low[a]), std::abs(cloud.high[a])});
  }
  // cells are enlarged by the possible rounding error: a superfluous candidate costs little
  search_radius_ = search_radius;
  one_per_body_ = cloud.one_per_body;
  inverse_ = 1 / std::max(search_radius * 1.001f + 2e-6f * largest, 1e-9f);
  std::array<std::uint32_t, 3> cells{};
  for (std::size_t a = 0; a < 3; a++) {
    const float count = std::min(extents[a] * inverse_ + 1, 65536.0f);
    cells[a] = std::max(std::bit_ceil(static_cast<std::uint32_t>(count)), kMinCells);
  }
  // limit the number of cells, since clearing them would dominate the cost
  const auto max_cells = std::max<std::uint64_t>(4 * cloud.size(), kMinCells * kMinCells * kMinCells);
  while (std::uint64_t{cells[0]} * cells[1] * cells[2] > max_cells) *std::max_element(cells.begin(), cells.end()) /= 2;
  for (std::size_t a = 0; a < 3; a++) axis_[a].mask = cells[a] - 1;
  bits_x_ = static_cast<std::uint32_t>(std::countr_zero(cells[0]));
  bits_y_ = static_cast<std::uint32_t>(std::countr_zero(cells[1]));
  first_.assign(std::size_t{cells[0]} * cells[1] * cells[2] + 1, 0);
}

void PointGrid::build(const PointCloud& cloud, float search_radius) {
  set_up_cells(cloud, search_radius);
  const std::size_t n = cloud.size();
  cell_.resize(n);
  for (std::size_t i = 0; i < n; i++) {
    cell_[i] = cell_at(cloud.x[i], cloud.y[i], cloud.z[i]);
    first_[cell_[i] + 1]++;
  }
  for (std::size_t c = 1; c < first_.size(); c++) first_[c] += first_[c - 1];
  points_.resize(n);
  candidates_.resize(n);
  candidate_indices_.resize(candidates_.x.size());
  order_.resize(n);
  // first_ of each cell moves to the cell's end and is shifted back afterwards
  for (std::size_t i = 0; i < n; i++) {
    const std::uint32_t index = first_[cell_[i]]++;
    points_.x[index] = cloud.x[i];
    points_.y[index] = cloud.y[i];
    points_.z[index] = cloud.z[i];
    points_.body[index] = cloud.body[i];
    order_[index] = static_cast<std::uint32_t>(i);
  }
  std::copy_backward(first_.begin(), first_.end() - 1, first_.end());
  first_[0] = 0;
  collected_ = kNone;
}

void PointGrid::collect_run(std::uint32_t begin, std::uint32_t end) {
  // Copies whole vectors; the next copy overwrites the surplus. Local pointers tell the compiler that the writes
  // don't change the vectors' pointers.
  const auto copy_four = [](auto* to, const auto* from, std::size_t i) {
    std::memcpy(to + i, from + i, 4 * sizeof *to);
  };
  float* const x = candidates_.x.data() + candidate_count_;
  float* const y = candidates_.y.data() + candidate_count_;
  float* const z = candidates_.z.data() + candidate_count_;
  std::int32_t* const body = candidates_.body.data() + candidate_count_;
  std::uint32_t* const indices = candidate_indices_.data() + candidate_count_;
  const float* const from_x = points_.x.data() + begin;
  const float* const from_y = points_.y.data() + begin;
  const float* const from_z = points_.z.data() + begin;
  const std::int32_t* const from_body = points_.body.data() + begin;
  const std::size_t count = end - begin;
  FourIndices four = FourIndices{0, 1, 2, 3} + begin;
  for (std::size_t i = 0; i < count; i += 4) {
    copy_four(x, from_x, i);
    copy_four(y, from_y, i);
    copy_four(z, from_z, i);
    copy_four(body, from_body, i);
    std::memcpy(indices + i, &four, sizeof four);
    four += 4;
  }
  candidate_count_ += count;
}

// Collects the cells `from`..`to` along x, relative to a cell, in the row at dy, dz.
void PointGrid::collect_row(std::uint32_t cell, int from, int to, int dy, int dz) {
  const std::uint32_t x = cell & axis_[0].mask;
  const std::uint32_t y = ((cell >> bits_x_) + static_cast<std::uint32_t>(dy)) & axis_[1].mask;
  const std::uint32_t z = ((cell >> bits_x_ >> bits_y_) + static_cast<std::uint32_t>(dz)) & axis_[2].mask;
  const std::uint32_t row = (z << bits_y_ | y) << bits_x_;
  const std::uint32_t first = (x + static_cast<std::uint32_t>(from)) & axis_[0].mask;
  const std::uint32_t last = (x + static_cast<std::uint32_t>(to)) & axis_[0].mask;
  if (first <= last) return collect_run(first_[row + first], first_[row + last + 1]);
  collect_run(first_[row + first], first_[row + axis_[0].mask + 1]);  // wraps around the edge
  collect_run(first_[row], first_[row + last + 1]);
}

void PointGrid::collect(std::uint32_t cell, bool ahead) {
  if (collected_ == cell && ahead_ == ahead) return;
  collected_ = cell;
  ahead_ = ahead;
  candidate_count_ = 0;
  // its own row first: with `ahead`, the points of the cell itself must be the first candidates
  if (ahead) {
    collect_row(cell, 0, 1, 0, 0);
  } else {
    collect_row(cell, -1, 1, 0, 0);
    collect_row(cell, -1, 1, -1, 0);
    for (int dy = -1; dy <= 1; dy++) collect_row(cell, -1, 1, dy, -1);
  }
  collect_row(cell, -1, 1, 1, 0);
  for (int dy = -1; dy <= 1; dy++) collect_row(cell, -1, 1, dy, 1);
  std::fill_n(candidates_.x.begin() + static_cast<std::ptrdiff_t>(candidate_count_), kPointPadding, kPaddingCoordinate);
}

PointArrays PointGrid::candidates_from(std::size_t from) const {
  return {&candidates_.x[from],    &candidates_.y[from],      &candidates_.z[from],
          &candidates_.body[from], &candidate_indices_[from], candidate_count_ - from};
}

std::uint32_t PointGrid::find_near(const PointQuery& query, float min_distance, float max_distance,
                                   std::uint32_t* out) {
  collect(cell_at(query.x, query.y, query.z), false);
  return finder_.find(candidates_from(0), query, min_distance, max_distance, true, out);
}

std::uint32_t PointGrid::find_pairs(std::uint32_t index, float min_distance, float max_distance, std::uint32_t* out) {
  const std::uint32_t cell = cell_[order_[index]];
  collect(cell, true);
  const std::size_t from = index - first_[cell] + 1;
  const PointQuery query{points_.x[index], points_.y[index], points_.z[index], points_.body[index]};
  // for the usual flock of one part per body, the check of bodies is unnecessary: a point isn't its own candidate
  return finder_.find(candidates_from(from), query, min_distance, max_distance, !one_per_body_, out);
}

}  // namespace limber::sim

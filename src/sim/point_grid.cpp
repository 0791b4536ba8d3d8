// A grid that wraps around on every axis, so that a point far out costs nothing: what shares a cell with others from
// elsewhere is told apart by its distance.
#include "sim/point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace limber {

namespace {

constexpr std::size_t kLanes = 4;          // points that are copied together
constexpr std::uint32_t kFewestCells = 4;  // on an axis: a cell and its two neighbours do not meet themselves
constexpr float kFurthestCell = 1e9f;      // no point is that far

using FourPlaces [[gnu::vector_size(16)]] = std::uint32_t;

}  // namespace

void PointCloud::clear() {
  x.clear();
  y.clear();
  z.clear();
  body.clear();
  low.fill(kNowhere);
  high.fill(-kNowhere);
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

// and what is read behind the last, and written by a copy in lanes
void PointGrid::Lanes::resize(std::size_t points) {
  const std::size_t room = points + kLanes + kPointRoom;
  for (std::vector<float>* v : {&x, &y, &z}) v->resize(room);
  body.resize(room);
}

std::uint32_t PointGrid::cell_at(float x, float y, float z) const {
  const auto cell = [&](const Axis& axis, float v) {
    const float at = std::clamp((v - axis.low) * inverse_, -kFurthestCell, kFurthestCell);
    const auto whole = static_cast<std::int32_t>(at);
    return static_cast<std::uint32_t>(whole - (at < static_cast<float>(whole) ? 1 : 0)) & axis.mask;
  };
  return (cell(axis_[2], z) << bits_y_ | cell(axis_[1], y)) << bits_x_ | cell(axis_[0], x);
}

void PointGrid::lay_out(const PointCloud& cloud, float reach) {
  float largest = 0;
  std::array<float, 3> extents{};
  for (std::size_t a = 0; a < 3 && cloud.size() > 0; a++) {
    axis_[a].low = cloud.low[a];
    extents[a] = cloud.high[a] - cloud.low[a];
    largest = std::max({largest, extents[a], std::abs(cloud.low[a]), std::abs(cloud.high[a])});
  }
  // what rounding may hide is added: a candidate too many costs little
  reach_ = reach;
  one_each_ = cloud.one_each;
  inverse_ = 1 / std::max(reach * 1.001f + 2e-6f * largest, 1e-9f);
  std::array<std::uint32_t, 3> cells{};
  for (std::size_t a = 0; a < 3; a++) {
    const float wanted = std::min(extents[a] * inverse_ + 1, 65536.0f);
    cells[a] = std::max(std::bit_ceil(static_cast<std::uint32_t>(wanted)), kFewestCells);
  }
  // not many more cells than points, else clearing them would be the most of it
  const auto most = std::max<std::uint64_t>(4 * cloud.size(), kFewestCells * kFewestCells * kFewestCells);
  while (std::uint64_t{cells[0]} * cells[1] * cells[2] > most) *std::max_element(cells.begin(), cells.end()) /= 2;
  for (std::size_t a = 0; a < 3; a++) axis_[a].mask = cells[a] - 1;
  bits_x_ = static_cast<std::uint32_t>(std::countr_zero(cells[0]));
  bits_y_ = static_cast<std::uint32_t>(std::countr_zero(cells[1]));
  first_.assign(std::size_t{cells[0]} * cells[1] * cells[2] + 1, 0);
}

void PointGrid::build(const PointCloud& cloud, float reach) {
  lay_out(cloud, reach);
  const std::size_t n = cloud.size();
  cell_.resize(n);
  for (std::size_t i = 0; i < n; i++) {
    cell_[i] = cell_at(cloud.x[i], cloud.y[i], cloud.z[i]);
    first_[cell_[i] + 1]++;
  }
  for (std::size_t c = 1; c < first_.size(); c++) first_[c] += first_[c - 1];
  points_.resize(n);
  candidates_.resize(n);
  places_.resize(candidates_.x.size());
  order_.resize(n);
  // each cell's first moves to its end meanwhile, and back
  for (std::size_t i = 0; i < n; i++) {
    const std::uint32_t at = first_[cell_[i]]++;
    points_.x[at] = cloud.x[i];
    points_.y[at] = cloud.y[i];
    points_.z[at] = cloud.z[i];
    points_.body[at] = cloud.body[i];
    order_[at] = static_cast<std::uint32_t>(i);
  }
  std::copy_backward(first_.begin(), first_.end() - 1, first_.end());
  first_[0] = 0;
  collected_ = kNone;
}

void PointGrid::collect_run(std::uint32_t begin, std::uint32_t end) {
  // whole lanes; what spills over is written again by what comes next. Pointers of its own: what is written could
  // change the vectors, for all that the compiler knows
  const auto lane = [](auto* to, const auto* from, std::size_t i) { std::memcpy(to + i, from + i, 4 * sizeof *to); };
  float* const x = candidates_.x.data() + count_;
  float* const y = candidates_.y.data() + count_;
  float* const z = candidates_.z.data() + count_;
  std::int32_t* const body = candidates_.body.data() + count_;
  std::uint32_t* const places = places_.data() + count_;
  const float* const from_x = points_.x.data() + begin;
  const float* const from_y = points_.y.data() + begin;
  const float* const from_z = points_.z.data() + begin;
  const std::int32_t* const from_body = points_.body.data() + begin;
  const std::size_t count = end - begin;
  FourPlaces four = FourPlaces{0, 1, 2, 3} + begin;
  for (std::size_t i = 0; i < count; i += 4) {
    lane(x, from_x, i);
    lane(y, from_y, i);
    lane(z, from_z, i);
    lane(body, from_body, i);
    std::memcpy(places + i, &four, sizeof four);
    four += 4;
  }
  count_ += count;
}

// the cells from .. to along x of a row beside a cell's
void PointGrid::collect_row(std::uint32_t cell, int from, int to, int dy, int dz) {
  const std::uint32_t x = cell & axis_[0].mask;
  const std::uint32_t y = ((cell >> bits_x_) + static_cast<std::uint32_t>(dy)) & axis_[1].mask;
  const std::uint32_t z = ((cell >> bits_x_ >> bits_y_) + static_cast<std::uint32_t>(dz)) & axis_[2].mask;
  const std::uint32_t row = (z << bits_y_ | y) << bits_x_;
  const std::uint32_t first = (x + static_cast<std::uint32_t>(from)) & axis_[0].mask;
  const std::uint32_t last = (x + static_cast<std::uint32_t>(to)) & axis_[0].mask;
  if (first <= last) return collect_run(first_[row + first], first_[row + last + 1]);
  collect_run(first_[row + first], first_[row + axis_[0].mask + 1]);  // around the edge
  collect_run(first_[row], first_[row + last + 1]);
}

void PointGrid::collect(std::uint32_t cell, bool ahead) {
  if (collected_ == cell && ahead_ == ahead) return;
  collected_ = cell;
  ahead_ = ahead;
  count_ = 0;
  // its own row first: where only what lies ahead is wanted, the cell's own points come first
  if (ahead) {
    collect_row(cell, 0, 1, 0, 0);
  } else {
    collect_row(cell, -1, 1, 0, 0);
    collect_row(cell, -1, 1, -1, 0);
    for (int dy = -1; dy <= 1; dy++) collect_row(cell, -1, 1, dy, -1);
  }
  collect_row(cell, -1, 1, 1, 0);
  for (int dy = -1; dy <= 1; dy++) collect_row(cell, -1, 1, dy, 1);
  std::fill_n(candidates_.x.begin() + static_cast<std::ptrdiff_t>(count_), kPointRoom, kNowhere);
}

PointArrays PointGrid::candidates_from(std::size_t from) const {
  return {&candidates_.x[from],    &candidates_.y[from], &candidates_.z[from],
          &candidates_.body[from], &places_[from],       count_ - from};
}

std::uint32_t PointGrid::near(const PointQuery& query, float least, float most, std::uint32_t* out) {
  collect(cell_at(query.x, query.y, query.z), false);
  return finder_.find(candidates_from(0), query, least, most, true, out);
}

std::uint32_t PointGrid::near_once(std::uint32_t place, float least, float most, std::uint32_t* out) {
  const std::uint32_t cell = cell_[order_[place]];
  collect(cell, true);
  const std::size_t from = place - first_[cell] + 1;
  const PointQuery query{points_.x[place], points_.y[place], points_.z[place], points_.body[place]};
  // what most flocks are: one part a body, which does not find itself
  return finder_.find(candidates_from(from), query, least, most, !one_each_, out);
}

}  // namespace limber

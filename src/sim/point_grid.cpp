// A grid that wraps around on every axis, so that a point far out costs nothing: what shares a cell with others from
// elsewhere is told apart by its distance.
#include "sim/point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace limber {

namespace {

constexpr std::size_t kBlock = 64;         // points whose hits fit a word
constexpr std::uint32_t kFewestCells = 4;  // on an axis: a cell and its two neighbours do not meet themselves
constexpr float kFurthestCell = 1e9f;      // no point is that far
constexpr float kNowhere = std::numeric_limits<float>::max();

using Word = std::uint64_t;
using FourPlaces [[gnu::vector_size(16)]] = std::uint32_t;

#if defined(__SSE2__)

// which of 16 points lie within, a bit each; arrays of whole lanes
template <bool Least, bool Bodies>
class Tester {
 public:
  Tester(const PointQuery& q, float least, float most)
      : x_(_mm_set1_ps(q.x)),
        y_(_mm_set1_ps(q.y)),
        z_(_mm_set1_ps(q.z)),
        low_(_mm_set1_ps(least * least)),
        high_(_mm_set1_ps(most * most)),
        body_(_mm_set1_epi32(q.body)) {}

  Word sixteen(const float* x, const float* y, const float* z, const std::int32_t* body) const {
    const __m128i a = _mm_packs_epi32(four(x, y, z, body), four(x + 4, y + 4, z + 4, body + 4));
    const __m128i b = _mm_packs_epi32(four(x + 8, y + 8, z + 8, body + 8), four(x + 12, y + 12, z + 12, body + 12));
    return static_cast<Word>(static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(a, b))));
  }

 private:
  __m128i four(const float* x, const float* y, const float* z, const std::int32_t* body) const {
    const __m128 dx = _mm_sub_ps(x_, _mm_load_ps(x));
    const __m128 dy = _mm_sub_ps(y_, _mm_load_ps(y));
    const __m128 dz = _mm_sub_ps(z_, _mm_load_ps(z));
    const __m128 d = _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
    __m128 within = _mm_cmple_ps(d, high_);
    if constexpr (Least) within = _mm_and_ps(within, _mm_cmpge_ps(d, low_));
    if constexpr (!Bodies) return _mm_castps_si128(within);
    const __m128i same = _mm_cmpeq_epi32(body_, _mm_load_si128(reinterpret_cast<const __m128i*>(body)));
    return _mm_andnot_si128(same, _mm_castps_si128(within));
  }

  __m128 x_, y_, z_, low_, high_;
  __m128i body_;
};

#else

template <bool Least, bool Bodies>
class Tester {
 public:
  Tester(const PointQuery& q, float least, float most) : q_(q), low_(least * least), high_(most * most) {}

  Word sixteen(const float* x, const float* y, const float* z, const std::int32_t* body) const {
    Word hits = 0;
    for (int i = 0; i < 16; i++) {
      const float dx = q_.x - x[i], dy = q_.y - y[i], dz = q_.z - z[i];
      const float d = (dx * dx + dy * dy) + dz * dz;
      if ((!Least || d >= low_) && d <= high_ && (!Bodies || body[i] != q_.body)) hits |= Word{1} << i;
    }
    return hits;
  }

 private:
  PointQuery q_;
  float low_, high_;
};

#endif

// bits of what lies within, of a block that ends at `count` at the latest
template <class Test>
Word hits_of_block(const Test& tester, const float* x, const float* y, const float* z, const std::int32_t* body,
                   std::size_t count) {
  Word hits = 0;
  for (std::size_t k = 0; k < kBlock && k < count; k += 16) hits |= tester.sixteen(x + k, y + k, z + k, body + k) << k;
  return hits;
}

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

// whole blocks, and one more that what begins within a block and a copy in lanes may reach into
void PointGrid::Lanes::resize(std::size_t points) {
  const std::size_t room = (points / kBlock + 2) * kBlock;
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
  std::fill_n(candidates_.x.begin() + static_cast<std::ptrdiff_t>(count_), 16, kNowhere);
}

template <class Tester>
std::uint32_t PointGrid::test(const Tester& tester, std::size_t from, std::uint32_t* out) const {
  std::uint32_t found = 0;
  // whole lanes: what comes before `from` is masked away
  const std::size_t start = from & ~std::size_t{3};
  Word wanted = ~Word{0} << (from - start);
  for (std::size_t i = start; i < count_; i += kBlock) {
    Word hits = wanted & hits_of_block(tester, &candidates_.x[i], &candidates_.y[i], &candidates_.z[i],
                                       &candidates_.body[i], count_ - i);
    for (; hits != 0; hits &= hits - 1) out[found++] = places_[i + static_cast<std::size_t>(std::countr_zero(hits))];
    wanted = ~Word{0};
  }
  return found;
}

std::uint32_t PointGrid::near(const PointQuery& query, float least, float most, std::uint32_t* out) {
  collect(cell_at(query.x, query.y, query.z), false);
  return test(Tester<true, true>(query, least, most), 0, out);
}

std::uint32_t PointGrid::near_once(std::uint32_t place, float least, float most, std::uint32_t* out) {
  const std::uint32_t cell = cell_[order_[place]];
  collect(cell, true);
  const std::size_t from = place - first_[cell] + 1;
  const PointQuery query{points_.x[place], points_.y[place], points_.z[place], points_.body[place]};
  if (least > 0) return test(Tester<true, true>(query, least, most), from, out);
  // what most flocks are: one part a body, which does not find itself
  return one_each_ ? test(Tester<false, false>(query, least, most), from, out)
                   : test(Tester<false, true>(query, least, most), from, out);
}

}  // namespace limber

// Grid, random points, Latin hypercube and Sobol sequence.
#include "experiments/design.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/random.h"

namespace limber::experiments {

namespace {

/// Degree and inner coefficients of a primitive polynomial, and the first odd direction integers (Joe, Kuo 2008:
/// new-joe-kuo-6, dimensions 2 to 21).
struct SobolRow {
  unsigned degree;
  unsigned coefficients;
  std::array<std::uint32_t, 7> start;
};
constexpr std::array<SobolRow, Design::kMaxSobolAxes - 1> kSobolRows{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};
constexpr unsigned kBits = 32;
using Directions = std::array<std::uint32_t, kBits>;

Directions sobol_directions(std::size_t axis) {
  Directions v{};
  if (axis == 0) {  // the van der Corput sequence
    for (unsigned i = 0; i < kBits; i++) v[i] = std::uint32_t{1} << (kBits - 1 - i);
    return v;
  }
  const SobolRow& row = kSobolRows[axis - 1];
  const unsigned s = row.degree;
  for (unsigned i = 0; i < s; i++) v[i] = row.start[i] << (kBits - 1 - i);
  for (unsigned i = s; i < kBits; i++) {
    v[i] = v[i - s] ^ (v[i - s] >> s);
    for (unsigned k = 1; k < s; k++) {
      if ((row.coefficients >> (s - 1 - k) & 1u) != 0) v[i] ^= v[i - k];
    }
  }
  return v;
}

}  // namespace

double sobol_coordinate(std::size_t axis, std::uint64_t n) {
  static const auto all = [] {
    std::array<Directions, Design::kMaxSobolAxes> directions{};
    for (std::size_t i = 0; i < directions.size(); i++) directions[i] = sobol_directions(i);
    return directions;
  }();
  const std::uint64_t gray = n ^ (n >> 1);  // the order of Antonov and Saleev (1979)
  std::uint32_t x = 0;
  for (unsigned i = 0; i < kBits; i++) {
    if ((gray >> i & 1u) != 0) x ^= all[axis][i];
  }
  return static_cast<double>(x) * 0x1.0p-32;
}

Design::Design(DesignKind kind, std::vector<Axis> axes, std::uint64_t size, std::uint64_t seed)
    : kind_(kind), axes_(std::move(axes)), size_(size), seed_(seed) {
  if (kind != DesignKind::latin) return;
  for (const Axis& axis : axes_) {
    std::vector<std::uint32_t>& intervals = intervals_.emplace_back(size);
    std::iota(intervals.begin(), intervals.end(), 0u);
    Random random(seed, axis.name);
    for (std::size_t i = intervals.size(); i > 1; i--)  // Fisher and Yates
      std::swap(intervals[i - 1],
                intervals[std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(i)), i - 1)]);
  }
}

Result<Design> Design::create(DesignKind kind, std::vector<Axis> axes, std::uint64_t samples, std::uint64_t seed) {
  const auto too_many = [] {
    return Error{fmt::format("more than {} points; use fewer values or samples", kMaxPoints)};
  };
  std::uint64_t size = samples;
  if (kind == DesignKind::grid) {
    size = 1;
    for (const Axis& axis : axes) {
      if (axis.values.empty())
        return Error{
            fmt::format("a grid needs the values of '{}': --param {}={}:{}/5, or another design: --design sobol "
                        "--samples 100",
                        axis.name, axis.name, axis.text(axis.min), axis.text(axis.max))};
      if (size > kMaxPoints / axis.values.size()) return too_many();
      size *= axis.values.size();
    }
  }
  if (size > kMaxPoints) return too_many();
  if (size == 0) return Error{"--samples must be at least 1"};
  if (kind == DesignKind::sobol && axes.size() > kMaxSobolAxes)
    return Error{
        fmt::format("the Sobol sequence has {} axes at most, not {}; use --design latin", kMaxSobolAxes, axes.size())};
  return Design(kind, std::move(axes), size, seed);
}

std::vector<double> Design::positions(std::uint64_t n) const {
  std::vector<double> positions;
  std::uint64_t state = seed_ + n;
  Random random(splitmix64(state), "design");
  for (std::size_t i = 0; i < axes_.size(); i++) {
    const double uniform = random.uniform();
    positions.push_back(kind_ == DesignKind::sobol   ? sobol_coordinate(i, n)
                        : kind_ == DesignKind::latin ? (intervals_[i][n] + uniform) / static_cast<double>(size_)
                                                     : uniform);
  }
  return positions;
}

std::vector<double> Design::point(std::uint64_t n) const {
  std::vector<double> values(axes_.size());
  if (kind_ == DesignKind::grid) {
    for (std::size_t i = axes_.size(); i-- > 0; n /= axes_[i].values.size())
      values[i] = axes_[i].values[n % axes_[i].values.size()];
    return values;
  }
  const std::vector<double> at = positions(n);
  for (std::size_t i = 0; i < axes_.size(); i++) values[i] = axes_[i].at(at[i]);
  return values;
}

}  // namespace limber::experiments

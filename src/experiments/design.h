// Design: the points of a sweep. Point number n depends on the design alone, never on the order of evaluation. [any]
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "experiments/axis.h"

namespace limber::experiments {

enum class DesignKind : std::uint8_t {
  grid,    ///< All combinations of the values; the last axis changes fastest.
  random,  ///< Independent uniform points.
  latin,   ///< Latin hypercube: along each axis, every one of N equal intervals has exactly one point.
  sobol,   ///< The Sobol sequence with the direction numbers of Joe and Kuo (2008).
};

class Design {
 public:
  /// Number of points of a design, at most.
  static constexpr std::uint64_t kMaxPoints = 10'000'000;
  /// Number of axes of the Sobol sequence, at most.
  static constexpr std::size_t kMaxSobolAxes = 21;

  /// `samples`: number of points, except of a grid. `seed`: for random and latin. Errors: too many points, an axis of a
  /// grid without values, too many axes for the Sobol sequence.
  static Result<Design> create(DesignKind kind, std::vector<Axis> axes, std::uint64_t samples, std::uint64_t seed);

  std::uint64_t size() const { return size_; }
  const std::vector<Axis>& axes() const { return axes_; }
  /// Returns one value per axis. Requires n < size().
  std::vector<double> point(std::uint64_t n) const;

 private:
  Design(DesignKind kind, std::vector<Axis> axes, std::uint64_t size, std::uint64_t seed);
  std::vector<double> positions(std::uint64_t n) const;

  DesignKind kind_;
  std::vector<Axis> axes_;
  std::uint64_t size_;
  std::uint64_t seed_;
  std::vector<std::vector<std::uint32_t>> intervals_;  // latin: for each axis, the interval of each point
};

/// Returns the coordinate of point n of the Sobol sequence along an axis (0 .. kMaxSobolAxes - 1), in [0, 1).
double sobol_coordinate(std::size_t axis, std::uint64_t n);

}  // namespace limber::experiments

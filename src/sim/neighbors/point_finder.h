// PointFinder: finds the points of an array that are between two distances from a position. Single precision; all
// operations are rounded individually and in a fixed order, so that the result doesn't depend on the vector width of
// the processor. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace limber::sim {

/// Position and body to find neighbors for.
struct PointQuery {
  float x, y, z;
  std::int32_t body;  ///< points of this body are skipped
};

/// Candidate points. The arrays must have kPointPadding elements more than `count`, with kNowhere in x.
struct PointArrays {
  const float* x;
  const float* y;
  const float* z;
  const std::int32_t* body;
  const std::uint32_t* values;  ///< values to output for the points found
  std::size_t count;
};

/// Number of elements that may be read past the end of the input, and written past the results.
inline constexpr std::size_t kPointPadding = 64;
/// Coordinate of padding points: their distance from any position exceeds all search distances.
inline constexpr float kPaddingCoordinate = std::numeric_limits<float>::max();

/// Number of points per vector operation.
enum class VectorWidth : std::uint8_t { four, eight, sixteen };

class PointFinder {
 public:
  /// The widest that this processor supports.
  static VectorWidth widest();
  /// Uses at most `width`.
  explicit PointFinder(VectorWidth width = widest());

  /// Writes the `values` of all points with min_distance <= distance <= max_distance to `out`, in order; returns their
  /// number. `out` must have kPointPadding elements more than that. `skip_body`: skips points of the query's body.
  std::uint32_t find(const PointArrays& points, const PointQuery& query, float min_distance, float max_distance,
                     bool skip_body, std::uint32_t* out) const {
    return (skip_body          ? min_distance > 0 ? min_and_skip_body_ : skip_body_
            : min_distance > 0 ? min_
                               : all_)(points, query, min_distance, max_distance, out);
  }

 private:
  using Find = std::uint32_t (*)(const PointArrays& points, const PointQuery& query, float min_distance,
                                 float max_distance, std::uint32_t* out);
  Find all_, min_, skip_body_, min_and_skip_body_;
};

}  // namespace limber::sim

// PointFinder: which of many points in arrays lie within two distances of a place. Single precision, each operation
// rounded by itself and in a fixed order: the widest vectors of a processor find what the narrowest do. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace limber {

/// What is looked for around a place.
struct PointQuery {
  float x, y, z;
  std::int32_t body;  ///< Points of this body are passed over.
};

/// Points that may lie near. The arrays reach kPointRoom further than `count`; what stands there must lie nowhere
/// (kNowhere in x).
struct PointArrays {
  const float* x;
  const float* y;
  const float* z;
  const std::int32_t* body;
  const std::uint32_t* places;  ///< What is told of a point that is found.
  std::size_t count;
};

/// Numbers behind the last that may be read, and behind what was found that may be written.
inline constexpr std::size_t kPointRoom = 64;
/// No point is that far: its distance from any other is beyond all that is looked for.
inline constexpr float kNowhere = std::numeric_limits<float>::max();

/// How many points are looked at together.
enum class PointLanes : std::uint8_t { four, eight, sixteen };

class PointFinder {
 public:
  /// The most that this processor can.
  static PointLanes widest();
  /// `lanes` at most.
  explicit PointFinder(PointLanes lanes = widest());

  /// Places of all points with least <= distance <= most, in their order; how many. `passes_over`: those of the query's
  /// body are left out.
  std::uint32_t find(const PointArrays& points, const PointQuery& query, float least, float most, bool passes_over,
                     std::uint32_t* out) const {
    return (passes_over ? least > 0 ? least_and_bodies_ : bodies_
            : least > 0 ? least_
                        : all_)(points, query, least, most, out);
  }

 private:
  using Find = std::uint32_t (*)(const PointArrays& points, const PointQuery& query, float least, float most,
                                 std::uint32_t* out);
  Find all_, least_, bodies_, least_and_bodies_;
};

}  // namespace limber

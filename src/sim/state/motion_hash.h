// MotionHash: a hash of the motion of all bodies for comparing two runs, fast enough to be computed at every tick.
// [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "properties/store.h"

namespace limber::sim {

class World;

class MotionHash {
 public:
  explicit MotionHash(const World& world) : world_(world) {}
  /// Returns a hash of the tick, of which bodies are enabled, and of all poses and velocities, bit for bit. It covers
  /// only these properties, so new properties don't change it. Allocates only after the structure has changed.
  std::uint64_t compute();
  /// Hashes of the single bodies at the last call of compute(), in their order.
  std::span<const std::uint64_t> body_hashes() const { return body_hashes_; }

 private:
  // Indices into the store's transient values, which are contiguous, unlike the parts.
  struct BodyIndices {
    std::uint32_t body_index = 0;
    std::uint32_t parts_end = 0;  // end of its range in parts_
  };
  void update_indices(const Store& store);

  const World& world_;
  std::optional<std::uint64_t> structure_version_;  // version of the store's structure that the indices are valid for
  std::vector<BodyIndices> body_indices_;
  std::vector<std::uint32_t> part_indices_;
  std::vector<std::uint64_t> body_hashes_;
};

}  // namespace limber::sim

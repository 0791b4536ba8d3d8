// MotionHash: whether two runs move alike, quick enough for every tick. [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "params/store.h"

namespace limber {

class World;

class MotionHash {
 public:
  explicit MotionHash(const World& world) : world_(world) {}
  /// Over the tick, which bodies are enabled, and the bits of all poses and velocities as they are read: of these rows
  /// alone, so that new ones leave it as it is. Allocates nothing while nothing comes or goes.
  std::uint64_t now();
  /// Of each body by itself at that moment, in their order.
  std::span<const std::uint64_t> bodies() const { return bodies_; }

 private:
  // Where things lie in the store's live numbers: parts are far apart in memory, and these are not.
  struct Place {
    std::uint32_t body = 0;
    std::uint32_t parts_end = 0;  // in parts_
  };
  void find(const Store& store);

  const World& world_;
  std::optional<std::uint64_t> structure_;  // of the store when places were found
  std::vector<Place> places_;
  std::vector<std::uint32_t> parts_;
  std::vector<std::uint64_t> bodies_;
};

}  // namespace limber

// Ids at borders: a slot and a generation. A stale id is an answer, not a crash.
#pragma once

#include <compare>
#include <cstdint>

namespace limber {

/// Names one node of the store. Slots are used again, generations never within a run.
struct NodeId {
  std::uint32_t slot = 0xffffffffu;
  std::uint32_t generation = 0;

  bool null() const { return slot == 0xffffffffu; }
  // NOLINTNEXTLINE(modernize-use-nullptr): seen in the comparison that the compiler writes
  auto operator<=>(const NodeId&) const = default;
};

}  // namespace limber

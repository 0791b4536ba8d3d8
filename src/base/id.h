// NodeId: a generational index. A stale id is detected instead of referring to another node.
#pragma once

#include <compare>
#include <cstdint>

namespace limber {

/// Identifies a node of the store. Slots are reused; a slot's generation never repeats within a run.
struct NodeId {
  std::uint32_t slot = 0xffffffffu;
  std::uint32_t generation = 0;

  bool null() const { return slot == 0xffffffffu; }
  // NOLINTNEXTLINE(modernize-use-nullptr): false positive in the generated comparison
  auto operator<=>(const NodeId&) const = default;
};

}  // namespace limber

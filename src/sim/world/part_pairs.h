// PartPairs: pairs of parts of one body that are excluded from collision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limber {

class Archive;

/// Setting of a pair by a script.
enum class PairEdit : std::uint16_t { none, excluded, included };

/// Two parts, by their indices among the body's parts, a < b.
struct PartPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint16_t overlaps = 0;  ///< 1: they overlapped at the home pose, or at the first tick.
  PairEdit edit = PairEdit::none;

  bool excluded() const { return edit == PairEdit::none ? overlaps != 0 : edit == PairEdit::excluded; }
};

/// Pairs of a body that differ from the default (included). Joints, groups, masks and `self_collision` act
/// independently.
struct PartPairs {
  std::vector<PartPair> list;     ///< Sorted by a, then b; contains only pairs that overlap or were edited.
  std::size_t checked_count = 0;  ///< Number of leading parts that were checked for overlaps.

  /// Returns null if the pair is not in the list.
  const PartPair* find(std::size_t a, std::size_t b) const;
  /// Returns true if the pair's exclusion changed.
  bool set_edit(std::size_t a, std::size_t b, PairEdit edit);
  bool set_overlaps(std::size_t a, std::size_t b);
  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  PartPair& entry(std::size_t a, std::size_t b);
};

}  // namespace limber

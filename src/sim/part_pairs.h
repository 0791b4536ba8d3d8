// PartPairs: which pairs of parts of one body are excluded from collision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limber {

/// What a script decided for a pair.
enum class PairEdit : std::uint16_t { none, excluded, included };

/// Two parts, by their places among the body's parts, a < b.
struct PartPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint16_t overlaps = 0;  ///< 1: they overlapped at the home pose, or at the first tick.
  PairEdit edit = PairEdit::none;

  bool excluded() const { return edit == PairEdit::none ? overlaps != 0 : edit == PairEdit::excluded; }
};

/// The pairs of a body that are not simply included. Joints, groups, masks and `self_collision` act independently.
struct PartPairs {
  std::vector<PartPair> list;  ///< Sorted by a, then b; no pair that overlaps not and was not edited.
  std::size_t checked = 0;     ///< The first so many parts were checked for overlaps.

  /// Null where the pair is not in the list.
  const PartPair* find(std::size_t a, std::size_t b) const;
  /// Whether that changed whether the pair is excluded.
  bool set_edit(std::size_t a, std::size_t b, PairEdit edit);
  bool set_overlaps(std::size_t a, std::size_t b);

 private:
  PartPair& entry(std::size_t a, std::size_t b);
};

}  // namespace limber

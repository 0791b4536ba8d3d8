// PartPairs: the pairs of parts of one body that are excluded from collision. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::model {
struct BodyModel;
}  // namespace limber::model

namespace limber::sim {

class Body;
class Part;

/// Setting of a pair by a script.
enum class PairEdit : std::uint16_t { none, excluded, included };

/// Two parts, by their indices among the body's parts, a < b.
struct PartPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint16_t overlaps = 0;  ///< 1: overlapping at the home pose or first tick, or excluded by the file.
  PairEdit edit = PairEdit::none;

  bool excluded() const { return edit == PairEdit::none ? overlaps != 0 : edit == PairEdit::excluded; }
};

/// A message about the parts of all bodies that overlap in their first tick.
class OverlapReport {
 public:
  void add(const Body& body, const Part& a, const Part& b, double depth);
  /// Logs the first overlap that was added since the last call, and the number of others.
  void log();

 private:
  std::size_t count_ = 0;
  std::string first_;
};

/// Pairs of a body that differ from the default (included). Two parts don't collide by default if they overlap with all
/// joints at 0 (bodies from models), or in the first tick (other parts). Joints, groups, masks and `self_collision` act
/// independently.
class PartPairs {
 public:
  explicit PartPairs(Body& body) : body_(body) {}

  /// The pairs that overlap or were edited, sorted by a, then b.
  std::span<const PartPair> list() const { return state_.list; }
  bool excludes(const Part& a, const Part& b) const;
  /// Excludes a pair from collision, includes it, or restores its default, from the next step on. Errors: a part of
  /// another body, the same part twice.
  Result<void> edit(const Part& a, const Part& b, PairEdit edit);
  /// Excludes new parts that overlap.
  void find_new_overlaps(OverlapReport& report);

  // While the body is built, after its parts were added.
  /// Sets the pairs to those that overlap in the model.
  void build(const model::BodyModel& model);
  void build_copy(const PartPairs& source);

  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  const PartPair* find(std::size_t a, std::size_t b) const;
  PartPair& entry(std::size_t a, std::size_t b);
  bool set_overlaps(std::size_t a, std::size_t b);
  void set_edit(std::size_t a, std::size_t b, PairEdit edit);
  void apply(std::size_t a, std::size_t b);
  void apply_all();

  Body& body_;
  // what persists from tick to tick
  struct State {
    std::vector<PartPair> list;
    std::size_t checked_count = 0;  // number of leading parts that were checked for overlaps
  } state_;
};

}  // namespace limber::sim

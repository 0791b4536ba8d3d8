// ForceQueue: forces and torques applied to parts by a guarded call. Compiled Lua writes them into this buffer without
// a function call; they reach the parts when the call succeeds and are discarded when it fails. [sim]
#pragma once

#include <vector>

#include "script/api/c_api.h"

namespace limber::sim {
class ForceAccumulators;
class World;
}  // namespace limber::sim

namespace limber::script {

class ForceQueue {
 public:
  ForceQueue();
  /// The buffer as the prelude sees it: entries, count, capacity.
  LimberForces* view() { return &view_; }
  /// Doubles the capacity. Returns false at the maximum; apply() frees entries then.
  bool grow();
  /// Marks all entries as coming from successful calls. They are applied later, together with others, to save time.
  void commit(sim::ForceAccumulators& loads);
  /// Applies the committed entries in order. Skips parts that have been removed.
  void apply_committed(sim::ForceAccumulators& loads);
  /// Applies all entries.
  void apply(sim::ForceAccumulators& loads);
  /// Applies all entries in the middle of a call, recording the parts for a rollback if the call fails.
  void apply_with_rollback(sim::World& world);
  /// Discards the entries since commit().
  void discard_uncommitted() { view_.count = committed_; }

 private:
  void apply_range(std::int32_t from, std::int32_t to, sim::ForceAccumulators& loads) const;

  std::vector<LimberForce> entries_;
  std::int32_t committed_ = 0;  // number of entries that are committed
  LimberForces view_{};
};

}  // namespace limber::script

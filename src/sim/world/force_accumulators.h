// ForceAccumulators: pending forces and impulses of all parts, applied in the next step. They are stored contiguously,
// so that a tick that pushes thousands of parts accesses memory in order. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Part;

class ForceAccumulators {
 public:
  /// Force and torque at the center of mass that act during the whole next tick.
  struct alignas(64) Wrench {
    Vec3 force{0};   ///< N
    Vec3 torque{0};  ///< N·m
    Part* part = nullptr;
    bool pending = false;
  };
  /// Impulses that act at once.
  struct Impulse {
    Vec3 linear{0};   ///< N·s
    Vec3 angular{0};  ///< N·m·s
  };

  /// Allocates an accumulator for a part, reusing released ones; returns its index.
  std::uint32_t add(Part& part);
  void remove(std::uint32_t index);

  /// The accumulator at `index`, to add a force or torque to; it is applied in the next step.
  Wrench& wrench(std::uint32_t index) {
    Wrench& wrench = wrenches_[index];
    if (!wrench.pending) mark_pending(index);
    return wrench;
  }
  Impulse& impulse(std::uint32_t index) {
    if (!wrenches_[index].pending) mark_pending(index);
    return impulses_[index];
  }
  /// The same by the slot of the part's node; null if no part has this slot.
  Wrench* wrench_of_slot(std::uint32_t slot) {
    const std::uint32_t index = slot < index_of_slot_.size() ? index_of_slot_[slot] : kNone;
    return index == kNone ? nullptr : &wrench(index);
  }
  /// Prefetches an accumulator.
  [[gnu::always_inline]] void prefetch_wrench(std::uint32_t index) const { __builtin_prefetch(&wrenches_[index], 1); }
  void clear(std::uint32_t index);
  /// Discards all pending forces and impulses.
  void discard();
  /// Calls f(wrench, impulse) for each part with a pending force or impulse.
  template <class F>
  void for_each_pending(F&& f) const {
    for (const std::uint32_t index : pending_) {
      if (wrenches_[index].part != nullptr) f(wrenches_[index], impulses_[index]);
    }
  }
  /// Before Bullet's step: applies and clears all pending forces and impulses.
  void apply();
  /// For checkpoints: the pending forces and impulses.
  void serialize(Archive& archive);

 private:
  void prefetch_ahead(std::size_t index) const;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  void mark_pending(std::uint32_t index) {
    wrenches_[index].pending = true;
    pending_.push_back(index);
  }

  std::vector<Wrench> wrenches_;
  std::vector<Impulse> impulses_;
  std::vector<std::uint32_t> pending_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> index_of_slot_;  // accumulator by the slot of the part's node; kNone: no part
};

}  // namespace limber::sim

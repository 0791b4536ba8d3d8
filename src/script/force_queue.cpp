// From the queue to the parts.
#include "script/force_queue.h"

#include <utility>

#include "params/store.h"
#include "sim/part.h"

namespace limber {

namespace {
constexpr std::size_t kFirst = 1024;
constexpr std::size_t kMost = std::size_t{1} << 20u;
}  // namespace

ForceQueue::ForceQueue() : entries_(kFirst) { view_ = {entries_.data(), 0, static_cast<std::int32_t>(kFirst)}; }

bool ForceQueue::grow() {
  if (entries_.size() >= kMost) return false;
  entries_.resize(2 * entries_.size());
  view_.list = entries_.data();
  view_.room = static_cast<std::int32_t>(entries_.size());
  return true;
}

void ForceQueue::apply(const Store& store) {
  const auto count = static_cast<std::size_t>(std::exchange(view_.count, 0));
  const NodeSlot* const slots = store.view()->slots;
  for (std::size_t i = 0; i < count; i++) {
    const LimberForce& f = entries_[i];
    const auto slot = static_cast<std::uint32_t>(f.slot);
    Part* const part = static_cast<Part*>(store.thing({slot, slots[slot].generation}));
    if (part == nullptr) continue;
    if (f.turns == 0) {
      part->apply_force({f.x, f.y, f.z});
    } else {
      part->apply_torque({f.x, f.y, f.z});
    }
  }
}

}  // namespace limber

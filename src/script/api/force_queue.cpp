// Applying the queued forces to parts.
#include "script/api/force_queue.h"

#include <algorithm>
#include <span>
#include <utility>

#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::script {

namespace {
constexpr std::size_t kInitialSize = 1024;
constexpr std::size_t kMaxSize = std::size_t{1} << 20u;
constexpr std::int32_t kFlushCount = 256;  // entries to apply at once, while they are still in the L1 cache
}  // namespace

ForceQueue::ForceQueue() : entries_(kInitialSize) {
  view_ = {entries_.data(), 0, static_cast<std::int32_t>(kInitialSize)};
}

bool ForceQueue::grow() {
  if (entries_.size() >= kMaxSize) return false;
  entries_.resize(2 * entries_.size());
  view_.list = entries_.data();
  view_.capacity = static_cast<std::int32_t>(entries_.size());
  return true;
}

void ForceQueue::apply_range(std::int32_t from, std::int32_t to, sim::ForceAccumulators& loads) const {
  for (std::int32_t i = from; i < to; i++) {
    const LimberForce& f = entries_[static_cast<std::size_t>(i)];
    sim::ForceAccumulators::Wrench* const load = loads.wrench_of_slot(static_cast<std::uint32_t>(f.slot));
    if (load != nullptr) (f.is_torque == 0 ? load->force : load->torque) += Vec3(f.x, f.y, f.z);
  }
}

void ForceQueue::commit(sim::ForceAccumulators& loads) {
  committed_ = view_.count;
  if (committed_ >= kFlushCount) apply(loads);
}

void ForceQueue::apply_committed(sim::ForceAccumulators& loads) {
  if (committed_ == 0) return;
  apply_range(0, committed_, loads);
  std::copy(entries_.begin() + committed_, entries_.begin() + view_.count, entries_.begin());
  view_.count -= std::exchange(committed_, 0);
}

void ForceQueue::apply(sim::ForceAccumulators& loads) {
  apply_range(0, view_.count, loads);
  view_.count = committed_ = 0;
}

void ForceQueue::apply_with_rollback(sim::World& world) {
  apply_committed(world.force_accumulators());
  for (const LimberForce& f : std::span(entries_).first(static_cast<std::size_t>(view_.count))) {
    const std::uint32_t slot = static_cast<std::uint32_t>(f.slot);
    sim::ForceAccumulators::Wrench* const load = world.force_accumulators().wrench_of_slot(slot);
    if (load != nullptr) load->part->save_for_rollback();
  }
  apply(world.force_accumulators());
}

}  // namespace limber::script

// From the queue to the parts.
#include "script/force_queue.h"

#include <algorithm>
#include <span>
#include <utility>

#include "sim/world.h"

namespace limber {

namespace {
constexpr std::size_t kFirst = 1024;
constexpr std::size_t kMost = std::size_t{1} << 20u;
constexpr std::int32_t kEnough = 256;  // of one go: they are in the nearest cache still
}  // namespace

ForceQueue::ForceQueue() : entries_(kFirst) { view_ = {entries_.data(), 0, static_cast<std::int32_t>(kFirst)}; }

bool ForceQueue::grow() {
  if (entries_.size() >= kMost) return false;
  entries_.resize(2 * entries_.size());
  view_.list = entries_.data();
  view_.room = static_cast<std::int32_t>(entries_.size());
  return true;
}

void ForceQueue::give(std::int32_t from, std::int32_t to, PartLoads& loads) const {
  for (std::int32_t i = from; i < to; i++) {
    const LimberForce& f = entries_[static_cast<std::size_t>(i)];
    PartLoads::Load* const load = loads.load_of_slot(static_cast<std::uint32_t>(f.slot));
    if (load != nullptr) (f.turns == 0 ? load->force : load->torque) += Vec3(f.x, f.y, f.z);
  }
}

void ForceQueue::commit(PartLoads& loads) {
  committed_ = view_.count;
  if (committed_ >= kEnough) apply(loads);
}

void ForceQueue::apply_committed(PartLoads& loads) {
  if (committed_ == 0) return;
  give(0, committed_, loads);
  std::copy(entries_.begin() + committed_, entries_.begin() + view_.count, entries_.begin());
  view_.count -= std::exchange(committed_, 0);
}

void ForceQueue::apply(PartLoads& loads) {
  give(0, view_.count, loads);
  view_.count = committed_ = 0;
}

void ForceQueue::apply_kept(World& world) {
  apply_committed(world.loads());
  for (const LimberForce& f : std::span(entries_).first(static_cast<std::size_t>(view_.count))) {
    const std::uint32_t slot = static_cast<std::uint32_t>(f.slot);
    PartLoads::Load* const load = world.loads().load_of_slot(slot);
    if (load != nullptr) load->part->keep();
  }
  apply(world.loads());
}

}  // namespace limber

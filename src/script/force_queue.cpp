// From the queue to the parts.
#include "script/force_queue.h"

#include <span>
#include <utility>

#include "sim/world.h"

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

void ForceQueue::apply(PartLoads& loads) {
  const auto count = static_cast<std::size_t>(std::exchange(view_.count, 0));
  for (std::size_t i = 0; i < count; i++) {
    const LimberForce& f = entries_[i];
    PartLoads::Load* const load = loads.load_of_slot(static_cast<std::uint32_t>(f.slot));
    if (load != nullptr) (f.turns == 0 ? load->force : load->torque) += Vec3(f.x, f.y, f.z);
  }
}

void ForceQueue::apply_kept(World& world) {
  for (const LimberForce& f : std::span(entries_).first(static_cast<std::size_t>(view_.count))) {
    const std::uint32_t slot = static_cast<std::uint32_t>(f.slot);
    PartLoads::Load* const load = world.loads().load_of_slot(slot);
    if (load != nullptr) load->part->keep();
  }
  apply(world.loads());
}

}  // namespace limber

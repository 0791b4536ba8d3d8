// NeighborBehavior: queries the neighbors of all members with the same distances together.
#include "sim/behavior/neighbor_behavior.h"

#include <algorithm>
#include <utility>

#include "sim/behavior/behavior_group.h"
#include "sim/world/world.h"

namespace limber::sim {

void NeighborBehavior::step(double dt) {
  const auto members = group()->members();
  const auto found = std::find_if(members.begin(), members.end(), [&](const auto& m) { return m.get() == this; });
  const auto index = static_cast<std::uint32_t>(found - members.begin());
  step_members({&index, 1}, dt);
}

void NeighborBehavior::step_group(std::span<Behavior* const>, double dt) {
  step_members(group()->running_indices(), dt);
}

void NeighborBehavior::step_members(std::span<const std::uint32_t> indices, double dt) {
  const std::vector<std::uint32_t>& values = group()->layout().values;
  const double* const persistent = world().store().persistent_values().data();
  const auto range = [&](std::uint32_t number) {
    return std::pair(persistent[values[number] + min_dist], persistent[values[number] + max_dist]);
  };
  const auto first = range(indices.front());
  if (std::all_of(indices.begin(), indices.end(), [&](std::uint32_t number) { return range(number) == first; })) {
    return step_same_range(indices, dt);
  }
  sorted_.assign(indices.begin(), indices.end());
  std::sort(sorted_.begin(), sorted_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(range(a), a) < std::pair(range(b), b); });
  for (std::size_t i = 0; i < sorted_.size();) {
    std::size_t end = i + 1;
    while (end < sorted_.size() && range(sorted_[end]) == range(sorted_[i])) end++;
    step_same_range(std::span(sorted_).subspan(i, end - i), dt);
    i = end;
  }
}

void NeighborBehavior::step_same_range(std::span<const std::uint32_t> indices, double dt) {
  const BehaviorGroup::Layout& layout = group()->layout();
  const auto parts_of = [&](std::uint32_t number) {
    return std::span(layout.parts)
        .subspan(layout.first_part[number], layout.first_part[number + 1] - layout.first_part[number]);
  };
  std::span<Part* const> queried = layout.parts;
  if (indices.size() < layout.values.size()) {
    queried_.clear();
    for (const std::uint32_t index : indices) {
      queried_.insert(queried_.end(), parts_of(index).begin(), parts_of(index).end());
    }
    queried = queried_;
  }
  const double* const persistent = world().store().persistent_values().data();
  const double* const values = persistent + layout.values[indices.front()];
  const std::span<const NeighborMeans> means =
      group()->neighbors().means(queried, values[min_dist], values[max_dist], needed_means());
  std::size_t offset = 0;
  constexpr std::size_t kAhead = 12;
  for (std::size_t i = 0; i < indices.size(); i++) {
    const std::uint32_t index = indices[i];
    if (i + kAhead < indices.size())
      world().force_accumulators().prefetch_wrench(layout.accumulator[layout.first_part[indices[i + kAhead]]]);
    const std::span<Part* const> parts = parts_of(index);
    const std::uint32_t first = layout.first_part[index];
    apply({persistent + layout.values[index], parts, &means[offset], dt, world().force_accumulators(),
           &layout.accumulator[first], persistent, &layout.mass[first], &layout.min_inertia[first]});
    offset += parts.size();
  }
}

}  // namespace limber::sim

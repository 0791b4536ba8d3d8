// NeighborBehavior: members that look equally far ask together.
#include "sim/neighbor_behavior.h"

#include <algorithm>
#include <utility>

#include "sim/behavior_group.h"
#include "sim/world.h"

namespace limber {

void NeighborBehavior::step(double dt) {
  const auto members = group()->members();
  const auto at = std::find_if(members.begin(), members.end(), [&](const auto& m) { return m.get() == this; });
  const auto number = static_cast<std::uint32_t>(at - members.begin());
  step_members({&number, 1}, dt);
}

void NeighborBehavior::step_group(std::span<Behavior* const>, double dt) { step_members(group()->running(), dt); }

void NeighborBehavior::step_members(std::span<const std::uint32_t> numbers, double dt) {
  const std::vector<std::uint32_t>& values = group()->layout().values;
  const double* const kept = world().store().kept().data();
  const auto range = [&](std::uint32_t number) {
    return std::pair(kept[values[number] + min_dist], kept[values[number] + max_dist]);
  };
  const auto first = range(numbers.front());
  if (std::all_of(numbers.begin(), numbers.end(), [&](std::uint32_t number) { return range(number) == first; })) {
    return step_alike(numbers, dt);
  }
  sorted_.assign(numbers.begin(), numbers.end());
  std::sort(sorted_.begin(), sorted_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(range(a), a) < std::pair(range(b), b); });
  for (std::size_t i = 0; i < sorted_.size();) {
    std::size_t end = i + 1;
    while (end < sorted_.size() && range(sorted_[end]) == range(sorted_[i])) end++;
    step_alike(std::span(sorted_).subspan(i, end - i), dt);
    i = end;
  }
}

void NeighborBehavior::step_alike(std::span<const std::uint32_t> numbers, double dt) {
  const BehaviorGroup::Layout& all = group()->layout();
  const auto parts_of = [&](std::uint32_t number) {
    return std::span(all.parts).subspan(all.first_part[number], all.first_part[number + 1] - all.first_part[number]);
  };
  std::span<Part* const> asking = all.parts;
  if (numbers.size() < all.values.size()) {
    asking_.clear();
    for (const std::uint32_t number : numbers) {
      asking_.insert(asking_.end(), parts_of(number).begin(), parts_of(number).end());
    }
    asking = asking_;
  }
  const double* const kept = world().store().kept().data();
  const double* const values = kept + all.values[numbers.front()];
  const std::span<const NeighborMeans> means =
      group()->neighbors().means(asking, values[min_dist], values[max_dist], wants());
  std::size_t at = 0;
  constexpr std::size_t kAhead = 12;
  for (std::size_t i = 0; i < numbers.size(); i++) {
    const std::uint32_t number = numbers[i];
    if (i + kAhead < numbers.size()) world().loads().fetch(all.load[all.first_part[numbers[i + kAhead]]]);
    const std::span<Part* const> parts = parts_of(number);
    const std::uint32_t first = all.first_part[number];
    act({kept + all.values[number], parts, &means[at], dt, world().loads(), &all.load[first], kept, &all.mass[first],
         &all.least_inertia[first]});
    at += parts.size();
  }
}

}  // namespace limber

// Lists of neighbours, all at once.
#include "sim/neighbor_lists.h"

#include <utility>

namespace limber {

void NeighborLists::begin() {
  for (Lists& lists : lists_) {
    lists.asked_before = std::exchange(lists.asked, 0);
    lists.made = false;
  }
}

// one that nobody asks for any more is used again
NeighborLists::Lists& NeighborLists::lists_for(float reach) {
  Lists* free = nullptr;
  for (Lists& lists : lists_) {
    if (lists.reach == reach) return lists;
    if (lists.asked == 0 && lists.asked_before == 0) free = &lists;
  }
  if (free == nullptr) free = &lists_.emplace_back();
  free->reach = reach;
  return *free;
}

std::optional<std::span<const std::uint32_t>> NeighborLists::of(std::uint32_t part, float reach, const Source& source) {
  Lists& lists = lists_for(reach);
  lists.asked++;
  if (!lists.made) {
    if (2 * lists.asked_before < source.part_count) return std::nullopt;
    make(lists, source);
  }
  return std::span<const std::uint32_t>(lists.all).subspan(lists.first[part], lists.count[part]);
}

// Whoever is near is so both ways: taking the parts in order and writing each into the lists of those near it makes
// every list ascend, without a sort.
void NeighborLists::make(Lists& lists, const Source& source) {
  const std::span<const std::uint32_t> order = source.grid.order();
  part_at_.resize(order.size());
  for (std::size_t place = 0; place < order.size(); place++) part_at_[place] = source.parts[order[place]];
  lists.first.assign(source.part_count, 0);
  lists.count.assign(source.part_count, 0);
  // first as the grid finds them, behind how many they are; points of one cell ask one after the other: what may be
  // near them is gathered once
  const PointCloud& cloud = source.cloud;
  std::size_t at = 1;  // 0: of parts that are not in the cloud
  for (std::size_t place = 0; place < order.size(); place++) {
    const std::size_t point = order[place];
    const PointQuery query{cloud.x[point], cloud.y[point], cloud.z[point], cloud.body[point]};
    const std::size_t room = at + 1 + order.size() + kPointRoom;
    if (found_.size() < room) found_.resize(2 * room);
    const std::uint32_t count = source.grid.near(query, 0, lists.reach, &found_[at + 1]);
    found_[at] = count;
    lists.first[part_at_[place]] = static_cast<std::uint32_t>(at + 1);
    at += 1 + count;
  }
  lists.all.resize(at);
  for (std::uint32_t part = 0; part < source.part_count; part++) {
    if (lists.first[part] == 0) continue;
    const std::uint32_t* const near = &found_[lists.first[part]];
    for (std::uint32_t j = 0; j < near[-1]; j++) {
      const std::uint32_t other = part_at_[near[j]];
      lists.all[lists.first[other] + lists.count[other]++] = part;
    }
  }
  lists.made = true;
}

}  // namespace limber

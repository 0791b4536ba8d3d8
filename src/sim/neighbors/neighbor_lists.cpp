// NeighborLists: builds all lists in one pass.
#include "sim/neighbors/neighbor_lists.h"

#include <utility>

namespace limber::sim {

void NeighborLists::invalidate() {
  for (Lists& lists : lists_) {
    lists.previous_queries = std::exchange(lists.queries, 0);
    lists.built = false;
  }
}

// Returns the lists for a radius; reuses lists with a radius that is no longer queried.
NeighborLists::Lists& NeighborLists::lists_for(float radius) {
  Lists* unused = nullptr;
  for (Lists& lists : lists_) {
    if (lists.radius == radius) return lists;
    if (lists.queries == 0 && lists.previous_queries == 0) unused = &lists;
  }
  if (unused == nullptr) unused = &lists_.emplace_back();
  unused->radius = radius;
  return *unused;
}

std::optional<std::span<const std::uint32_t>> NeighborLists::find(std::uint32_t part, float radius,
                                                                  const Source& source) {
  Lists& lists = lists_for(radius);
  lists.queries++;
  if (!lists.built) {
    if (2 * lists.previous_queries < source.part_count) return std::nullopt;
    build(lists, source);
  }
  return std::span<const std::uint32_t>(lists.all).subspan(lists.first[part], lists.count[part]);
}

// The relation is symmetric: iterating over the parts in ascending order and appending each to the lists of its
// neighbors sorts every list without a sort.
void NeighborLists::build(Lists& lists, const Source& source) {
  const std::span<const std::uint32_t> order = source.grid.order();
  part_at_.resize(order.size());
  for (std::size_t grid_index = 0; grid_index < order.size(); grid_index++)
    part_at_[grid_index] = source.parts[order[grid_index]];
  lists.first.assign(source.part_count, 0);
  lists.count.assign(source.part_count, 0);
  // First pass: results in the grid's order, each preceded by its count. Points of the same cell are adjacent, so
  // their candidates are collected only once.
  const PointCloud& cloud = source.cloud;
  std::size_t offset = 1;  // 0 marks parts that are not in the cloud
  for (std::size_t grid_index = 0; grid_index < order.size(); grid_index++) {
    const std::size_t point = order[grid_index];
    const PointQuery query{cloud.x[point], cloud.y[point], cloud.z[point], cloud.body[point]};
    const std::size_t needed = offset + 1 + order.size() + kPointPadding;
    if (found_.size() < needed) found_.resize(2 * needed);
    const std::uint32_t count = source.grid.find_near(query, 0, lists.radius, &found_[offset + 1]);
    found_[offset] = count;
    lists.first[part_at_[grid_index]] = static_cast<std::uint32_t>(offset + 1);
    offset += 1 + count;
  }
  lists.all.resize(offset);
  for (std::uint32_t part = 0; part < source.part_count; part++) {
    if (lists.first[part] == 0) continue;
    const std::uint32_t* const neighbors = &found_[lists.first[part]];
    for (std::uint32_t j = 0; j < neighbors[-1]; j++) {
      const std::uint32_t other = part_at_[neighbors[j]];
      lists.all[lists.first[other] + lists.count[other]++] = part;
    }
  }
  lists.built = true;
}

}  // namespace limber::sim

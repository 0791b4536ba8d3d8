// NeighborSet: caches the results of queries.
#include "sim/neighbors/neighbor_set.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {
namespace {

constexpr double kMaxRadius = 1e7;  // m: farther than any two parts are apart, but its square is a finite float

}  // namespace

NeighborSet::NeighborSet(World& world, std::vector<Part*> parts) : world_(world), cloud_(world, std::move(parts)) {}

void NeighborSet::gather() {
  if (!cloud_.gather()) return;
  grids_.begin_tick();
  lists_.invalidate();
  set_queries_.clear();
  for (CachedMeans& cached : cached_means_) {
    cached.used = false;
    cached.requested_before = std::exchange(cached.requested, 0);
  }
}

std::span<const NeighborMeans> NeighborSet::means(std::span<Part* const> parts, double min_distance,
                                                  double max_distance, unsigned want) {
  gather();
  CachedMeans& cache = cache_for(parts, min_distance, max_distance);
  const bool computed = cache.used && (want & ~cache.computed) == 0;
  cache.requested |= want;
  if (computed) return cache.means;
  // compute also the means that were requested in the previous tick, since they will probably be requested again
  cache.computed = cache.requested | cache.requested_before;
  cache.used = true;
  cache.means.assign(parts.size(), NeighborMeans{});
  calculator_.compute({min_distance, max_distance, cache.computed, cache.part_data, cache.set_indices}, cache.means);
  return cache.means;
}

// Returns the cache of this query, or one that is unused in this tick, preferably of the same distances.
NeighborSet::CachedMeans& NeighborSet::cache_for(std::span<Part* const> parts, double min_distance,
                                                 double max_distance) {
  CachedMeans* unused = nullptr;
  for (CachedMeans& cache : cached_means_) {
    const bool same_range = cache.min_distance == min_distance && cache.max_distance == max_distance;
    if (cache.used && same_range && std::equal(parts.begin(), parts.end(), cache.parts.begin(), cache.parts.end()))
      return cache;
    if (!cache.used && (unused == nullptr || same_range)) unused = &cache;
  }
  if (unused == nullptr) unused = &cached_means_.emplace_back();
  if (unused->min_distance != min_distance || unused->max_distance != max_distance) unused->requested_before = 0;
  unused->min_distance = min_distance;
  unused->max_distance = max_distance;
  update_parts(*unused, parts);
  return *unused;
}

const NeighborMeans& NeighborSet::means_near(const Part& part, double min_distance, double max_distance,
                                             unsigned want) {
  gather();
  min_distance = std::max(min_distance, 0.0);
  max_distance = std::min(max_distance, kMaxRadius);
  const std::uint32_t index = cloud_.index_of(part);
  if (index == PartCloud::kNoIndex)
    return single_means_ = calculator_.compute(cloud_.data_of(part), min_distance, max_distance);
  SetQuery* query = nullptr;
  for (SetQuery& known : set_queries_) {
    if (known.min_distance == min_distance && known.max_distance == max_distance) query = &known;
  }
  if (query == nullptr) query = &set_queries_.emplace_back(SetQuery{min_distance, max_distance});
  if (query->means == nullptr || (want & ~query->computed) != 0) {
    query->computed |= want;
    query->means = means(parts(), min_distance, max_distance, want).data();
  }
  return query->means[index];
}

void NeighborSet::update_parts(CachedMeans& cache, std::span<Part* const> parts) const {
  const std::uint64_t structure = world_.store().structure_version();
  const bool unchanged =
      cache.structure == structure && std::equal(parts.begin(), parts.end(), cache.parts.begin(), cache.parts.end());
  if (unchanged) return;
  cache.structure = structure;
  cache.parts.assign(parts.begin(), parts.end());
  cache.part_data.clear();
  for (const Part* part : parts) cache.part_data.push_back(cloud_.data_of(*part));
  cache.set_indices.clear();
  const std::span<Part* const> all = cloud_.parts();
  if (2 * parts.size() < all.size()) return;
  std::uint32_t index = 0;
  for (const Part* part : parts) {
    while (index < all.size() && all[index] != part) index++;
    if (index == all.size()) return cache.set_indices.clear();
    cache.set_indices.push_back(index++);
  }
}

void NeighborSet::find_near(const Part& part, double radius, std::vector<Neighbor>& out) {
  gather();
  if (cloud_.size() == 0 || !(radius >= 0)) return out.clear();
  const auto search_radius = static_cast<float>(std::min(radius, kMaxRadius));
  MotionGrids::Grid& grid = grids_.find(search_radius);
  const std::uint32_t index = cloud_.index_of(part);
  std::optional<std::span<const std::uint32_t>> neighbors;
  const bool in_set = index != PartCloud::kNoIndex && cloud_.enabled(cloud_.data(index));
  if (in_set)
    neighbors = lists_.find(index, search_radius, {cloud_.points(), grid.grid, cloud_.point_parts(), parts().size()});
  const PartData data = in_set ? cloud_.data(index) : cloud_.data_of(part);
  const Vec3 center = in_set ? cloud_.center(index) : cloud_.center_of(data);
  if (!neighbors) {
    const PointQuery query{static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                           data.body};
    found_.resize(cloud_.size() + kPointPadding);
    const std::uint32_t count = grid.grid.find_near(query, 0, search_radius, found_.data());
    for (std::uint32_t j = 0; j < count; j++) found_[j] = cloud_.point_parts()[grid.grid.order()[found_[j]]];
    std::sort(found_.begin(), found_.begin() + count);
    neighbors = std::span<const std::uint32_t>(found_.data(), count);
  }
  out.resize(neighbors->size());
  for (std::size_t j = 0; j < neighbors->size(); j++) {
    const std::uint32_t i = (*neighbors)[j];
    const Vec3 offset = cloud_.center(i) - center;
    out[j] = {i, offset, glm::length(offset)};
  }
}

}  // namespace limber::sim

// MeansCalculator: chooses the cheapest way. Sums of floats are in a fixed order, whose results don't depend on the
// vector width of the processor.
#include "sim/neighbors/neighbor_means.h"

#include <cmath>

#include "sim/bullet/simd.h"

namespace limber::sim {
namespace {

// Returns the unit vector times 1 − distance/max_distance, or zero if the points coincide.
bullet::Float4 separation_vector(const bullet::Float4& r, float inverse_max_distance) {
  const float distance = std::sqrt((r[0] * r[0] + r[1] * r[1]) + r[2] * r[2]);
  return distance > 0 ? r * (1 / distance - inverse_max_distance) : bullet::Float4{};
}

}  // namespace

void MeansCalculator::compute(const Query& query, std::span<NeighborMeans> means) {
  if (!(query.max_distance > query.min_distance) || cloud_.size() == 0) return;
  if (query.min_distance <= 0 && (query.want & kWantSeparation) == 0 && covers_all(query))
    return compute_by_totals(query, means);
  MotionGrids::Grid& grid = grids_.find(static_cast<float>(query.max_distance));
  grids_.fill_motions(grid, (query.want & kWantVelocity) != 0);
  switch (query.want) {
    case 0:
      return compute_by_grid<0>(query, grid, means);
    case kWantVelocity:
      return compute_by_grid<kWantVelocity>(query, grid, means);
    case kWantSeparation:
      return compute_by_grid<kWantSeparation>(query, grid, means);
    default:
      return compute_by_grid<kWantVelocity | kWantSeparation>(query, grid, means);
  }
}

NeighborMeans MeansCalculator::compute(const PartData& part, double min_distance, double max_distance) {
  if (!(max_distance > min_distance) || cloud_.size() == 0) return {};
  MotionGrids::Grid& grid = grids_.find(static_cast<float>(max_distance));
  grids_.fill_motions(grid, true);
  return sum_near<kWantVelocity | kWantSeparation>(grid, part, min_distance, max_distance);
}

// True if no two parts, of the cloud and of the query, are farther apart than `max_distance`.
bool MeansCalculator::covers_all(const Query& query) const {
  const PointCloud& points = cloud_.points();
  Vec3 low(points.low[0], points.low[1], points.low[2]);
  Vec3 high(points.high[0], points.high[1], points.high[2]);
  if (glm::length(high - low) > query.max_distance) return false;
  for (const PartData& part : query.parts) {
    const Vec3 center = cloud_.center_of(part);
    low = glm::min(low, center);
    high = glm::max(high, center);
  }
  return glm::length(high - low) <= query.max_distance;
}

void MeansCalculator::compute_by_totals(const Query& query, std::span<NeighborMeans> means) {
  const PointCloud& points = cloud_.points();
  Totals all;
  body_totals_.assign(static_cast<std::size_t>(cloud_.body_count()), Totals{});
  for (std::size_t k = 0; k < points.size(); k++) {
    const PartData& part = cloud_.data(cloud_.point_parts()[k]);
    const Totals summand{1, Vec3(points.x[k], points.y[k], points.z[k]), cloud_.velocity_of(part),
                         cloud_.angular_velocity_of(part)};
    const std::int32_t ordinal = cloud_.body_ordinal(static_cast<std::size_t>(part.body));
    for (Totals* sum : {&all, &body_totals_[static_cast<std::size_t>(ordinal)]}) {
      sum->count += summand.count;
      sum->position += summand.position;
      sum->velocity += summand.velocity;
      sum->angular_velocity += summand.angular_velocity;
    }
  }
  for (std::size_t i = 0; i < query.parts.size(); i++) {
    const PartData& part = query.parts[i];
    const std::int32_t ordinal = cloud_.body_ordinal(static_cast<std::size_t>(part.body));
    const Totals own = ordinal < 0 ? Totals{} : body_totals_[static_cast<std::size_t>(ordinal)];
    const double count = all.count - own.count;
    if (count == 0) continue;
    means[i].count = static_cast<std::uint32_t>(count);
    put(means[i].offset, (all.position - own.position) / count - cloud_.center_of(part));
    put(means[i].velocity, (all.velocity - own.velocity) / count - cloud_.velocity_of(part));
    put(means[i].angular_velocity,
        (all.angular_velocity - own.angular_velocity) / count - cloud_.angular_velocity_of(part));
  }
}

template <unsigned Want>
void MeansCalculator::compute_by_grid(const Query& query, MotionGrids::Grid& grid, std::span<NeighborMeans> means) {
  if (query.set_indices.empty()) {
    for (std::size_t i = 0; i < query.parts.size(); i++) {
      means[i] = sum_near<Want>(grid, query.parts[i], query.min_distance, query.max_distance);
    }
    return;
  }
  sum_pairs<Want>(query, grid);
  const Separation none{};
  grid_index_.assign(cloud_.parts().size(), PartCloud::kNoIndex);
  const std::span<const std::uint32_t> order = grid.grid.order();
  for (std::uint32_t index = 0; index < order.size(); index++) {
    grid_index_[cloud_.point_parts()[order[index]]] = index;
  }
  for (std::size_t i = 0; i < query.parts.size(); i++) {
    const std::uint32_t index = grid_index_[query.set_indices[i]];
    if (index == PartCloud::kNoIndex) continue;  // its body is disabled
    const Separation& separation = (Want & kWantSeparation) != 0 ? separations_[index] : none;
    means[i] = means_from_sums(sums_[index], separation, Want, grid.motions[index]);
  }
}

template <unsigned Want>
NeighborMeans MeansCalculator::sum_near(MotionGrids::Grid& grid, const PartData& part, double min_distance,
                                        double max_distance) {
  const Vec3 center = cloud_.center_of(part);
  const PointQuery query{static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                         part.body};
  const auto max_radius = static_cast<float>(max_distance);
  const float inverse_max_distance = 1 / max_radius;
  found_.resize(cloud_.size() + kPointPadding);
  const std::uint32_t count = grid.grid.find_near(query, static_cast<float>(min_distance), max_radius, found_.data());
  const bullet::Float4 center_point{query.x, query.y, query.z, 0};
  bullet::Float4 offset{}, velocity{}, angular_velocity{}, separation{};
  for (std::uint32_t j = 0; j < count; j++) {
    const NeighborMotion& neighbor = grid.motions[found_[j]];
    const bullet::Float4 r = bullet::load(neighbor.position) - center_point;
    offset += r;
    if constexpr ((Want & kWantVelocity) != 0) {
      velocity += bullet::load(neighbor.velocity);
      angular_velocity += bullet::load(neighbor.angular_velocity);
    }
    if constexpr ((Want & kWantSeparation) != 0) separation += separation_vector(r, inverse_max_distance);
  }
  NeighborSum sum{};
  Separation separations;
  bullet::store(sum.offset, offset);
  bullet::store(sum.velocity, velocity);
  bullet::store(sum.angular_velocity, angular_velocity);
  bullet::store(separations.sum, separation);
  NeighborMotion own{};
  if constexpr ((Want & kWantVelocity) != 0) {
    put(own.velocity, cloud_.velocity_of(part));
    put(own.angular_velocity, cloud_.angular_velocity_of(part));
  }
  return means_from_sums(sum, separations, Want, own);
}

template <unsigned Want>
void MeansCalculator::sum_pairs(const Query& query, MotionGrids::Grid& grid) {
  const auto min_distance = static_cast<float>(query.min_distance);
  const auto max_distance = static_cast<float>(query.max_distance);
  const auto n = static_cast<std::uint32_t>(cloud_.size());
  found_.resize(n + kPointPadding);
  sums_.assign(n, NeighborSum{});
  if constexpr ((Want & kWantSeparation) != 0) separations_.assign(n, Separation{});
  const AddPairs add = select_add_pairs(PointFinder::widest(), (Want & kWantVelocity) != 0);
  const NeighborMotion* const motions = grid.motions.data();
  for (std::uint32_t index = 0; index < n; index++) {
    const std::uint32_t count = grid.grid.find_pairs(index, min_distance, max_distance, found_.data());
    const std::span<const std::uint32_t> found(found_.data(), count);
    if (count == 0) continue;
    add(index, found, motions, sums_.data());
    if constexpr ((Want & kWantSeparation) != 0) sum_pair_separations(index, found, motions, 1 / max_distance);
  }
}

void MeansCalculator::sum_pair_separations(std::uint32_t index, std::span<const std::uint32_t> found,
                                           const NeighborMotion* motions, float inverse_max_distance) {
  const bullet::Float4 own_position = bullet::load(motions[index].position) - bullet::Float4{0, 0, 0, 1};
  bullet::Float4 separation = bullet::load(separations_[index].sum);
  for (const std::uint32_t other : found) {
    const bullet::Float4 vector =
        separation_vector(bullet::load(motions[other].position) - own_position, inverse_max_distance);
    separation += vector;
    float* const other_sum = separations_[other].sum;
    bullet::store(other_sum, bullet::load(other_sum) - vector);
  }
  bullet::store(separations_[index].sum, separation);
}

// Converts sums over neighbors to means; motions relative to the part's own.
NeighborMeans MeansCalculator::means_from_sums(const NeighborSum& sum, const Separation& separation, unsigned want,
                                               const NeighborMotion& own) {
  NeighborMeans means;
  const float count = sum.offset[3];
  if (count == 0) return means;
  means.count = static_cast<std::uint32_t>(count);
  const float inverse_count = 1 / count;
  for (std::size_t a = 0; a < 3; a++) means.offset[a] = sum.offset[a] * inverse_count;
  if ((want & kWantVelocity) != 0) {
    for (std::size_t a = 0; a < 3; a++) means.velocity[a] = sum.velocity[a] * inverse_count - own.velocity[a];
    for (std::size_t a = 0; a < 3; a++)
      means.angular_velocity[a] = sum.angular_velocity[a] * inverse_count - own.angular_velocity[a];
  }
  if ((want & kWantSeparation) != 0) {
    for (std::size_t a = 0; a < 3; a++) means.separation[a] = separation.sum[a] * inverse_count;
  }
  return means;
}

}  // namespace limber::sim

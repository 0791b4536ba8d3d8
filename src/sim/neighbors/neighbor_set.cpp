// NeighborSet: gathers positions, builds grids and computes means.
#include "sim/neighbors/neighbor_set.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/behavior/behavior_list.h"
#include "sim/bullet/simd.h"
#include "sim/world/world.h"

namespace limber {

namespace {

// Returns the unit vector times 1 − distance/max_distance, or zero if the points coincide.
Float4 push_vector(const Float4& r, float inverse_max_distance) {
  const float distance = std::sqrt((r[0] * r[0] + r[1] * r[1]) + r[2] * r[2]);
  return distance > 0 ? r * (1 / distance - inverse_max_distance) : Float4{};
}

void put(const Vec3& v, float* out) {
  for (int i = 0; i < 3; i++) out[i] = static_cast<float>(v[i]);
}

// Converts sums over neighbors to means; motions relative to the part's own.
template <class Push>
NeighborMeans means_from_sums(const NeighborSum& sum, const Push& push, unsigned want, const NeighborMotion& own) {
  NeighborMeans means;
  const float count = sum.offset[3];
  if (count == 0) return means;
  means.count = static_cast<std::uint32_t>(count);
  const float inverse_count = 1 / count;
  for (std::size_t a = 0; a < 3; a++) means.offset[a] = sum.offset[a] * inverse_count;
  if ((want & kWantVelocity) != 0) {
    for (std::size_t a = 0; a < 3; a++) means.velocity[a] = sum.velocity[a] * inverse_count - own.velocity[a];
    for (std::size_t a = 0; a < 3; a++) means.spin[a] = sum.spin[a] * inverse_count - own.spin[a];
  }
  if ((want & kWantPush) != 0) {
    for (std::size_t a = 0; a < 3; a++) means.push[a] = push.sum[a] * inverse_count;
  }
  return means;
}

constexpr std::uint32_t kNoIndex = 0xffffffffu;
constexpr double kMaxRadius = 1e7;  // m: farther than any two parts are apart, but its square is a finite float

// Offsets of a part's motion in its transient values.
struct PartOffsets {
  std::uint32_t position = Part::table().at("position").offset;
  std::uint32_t rotation = Part::table().at("rotation").offset;
  std::uint32_t velocity = Part::table().at("linear_velocity").offset;
  std::uint32_t spin = Part::table().at("angular_velocity").offset;
};
const PartOffsets& part_offsets() {
  static const PartOffsets found;
  return found;
}

}  // namespace

NeighborSet::NeighborSet(World& world, std::vector<Part*> parts) : world_(world), parts_(std::move(parts)) {
  part_data_.reserve(parts_.size());
  for (const Part* part : parts_) {
    ids_.push_back(part->id());
    part_data_.push_back(data_of(*part));
    const auto slot = static_cast<std::size_t>(part_data_.back().body);
    if (slot >= body_ordinals_.size()) body_ordinals_.resize(slot + 1, -1);
    if (body_ordinals_[slot] < 0) body_ordinals_[slot] = body_count_++;
  }
  index_parts();
}

void NeighborSet::index_parts() {
  centers_.resize(parts_.size());
  std::fill(index_of_slot_.begin(), index_of_slot_.end(), -1);
  for (std::size_t i = 0; i < ids_.size(); i++) {
    const auto slot = static_cast<std::size_t>(ids_[i].slot);
    if (slot >= index_of_slot_.size()) index_of_slot_.resize(slot + 1, -1);
    index_of_slot_[slot] = static_cast<std::int32_t>(i);
  }
}

std::uint32_t NeighborSet::index_of(const Part& part) const {
  const std::uint32_t slot = part.id().slot;
  return slot < index_of_slot_.size() ? static_cast<std::uint32_t>(index_of_slot_[slot]) : kNoIndex;
}

bool NeighborSet::consists_of(std::span<Part* const> parts) const {
  return std::equal(parts.begin(), parts.end(), ids_.begin(), ids_.end(),
                    [](const Part* part, NodeId id) { return part->id() == id; });
}

NeighborSet::PartData NeighborSet::data_of(const Part& part) const {
  static const std::uint32_t enabled = Body::table().at("enabled").offset;
  const NodeSlot* const slots = world_.store().view()->slots;
  const std::uint32_t body = part.body().id().slot;
  const Vec3 center = part.geometry()->frame.position;
  return {slots[part.id().slot].transient, slots[body].transient + enabled, static_cast<std::int32_t>(body),
          center == Vec3(0), center};
}

Vec3 NeighborSet::center_of(const PartData& data) const {
  const double* const transient = world_.store().transient_values().data() + data.transient_offset;
  const Vec3 origin = vec3_at(transient + part_offsets().position);
  if (data.centered) return origin;
  const double* const q = transient + part_offsets().rotation;
  return origin + quat_xyzw(q[0], q[1], q[2], q[3]) * data.center;
}

void NeighborSet::gather() {
  if (const std::uint64_t step = world_.behaviors().step_count(); std::exchange(gathered_step_, step) == step) return;
  const double* const transient = world_.store().transient_values().data();
  cloud_.clear();
  cloud_indices_.clear();
  constexpr std::size_t kAhead = 12;  // prefetch: these are no longer in the cache after a tick of physics
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (i + kAhead < parts_.size()) {
      __builtin_prefetch(transient + part_data_[i + kAhead].enabled_offset);
      __builtin_prefetch(transient + part_data_[i + kAhead].transient_offset);
      __builtin_prefetch(transient + part_data_[i + kAhead].transient_offset + part_offsets().spin + 2);
    }
    if (transient[part_data_[i].enabled_offset] == 0) continue;
    const Vec3 center = center_of(part_data_[i]);
    centers_[i] = center;
    cloud_.add(static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
               part_data_[i].body);
    cloud_indices_.push_back(static_cast<std::uint32_t>(i));
  }
  cloud_.one_per_body = static_cast<std::size_t>(body_count_) == parts_.size();
  motions_gathered_ = false;
  lists_.invalidate();
  set_queries_.clear();
  found_.resize(cloud_.size() + kPointPadding);
  for (const auto& grid : grids_) grid->used = false;
  for (CachedMeans& cached : cached_means_) {
    cached.used = false;
    cached.requested_before = std::exchange(cached.requested, 0);
  }
}

void NeighborSet::remove_body(const Body& body) {
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (&parts_[i]->body() == &body) continue;
    parts_[remaining] = parts_[i];
    ids_[remaining] = ids_[i];
    part_data_[remaining++] = part_data_[i];
  }
  parts_.resize(remaining);
  ids_.resize(remaining);
  part_data_.resize(remaining);
  index_parts();
  gathered_step_ = 0;
}

NeighborSet::Grid& NeighborSet::grid_for(float search_radius) {
  Grid* unused = nullptr;
  for (const auto& grid : grids_) {
    const float grid_radius = grid->grid.search_radius();
    if (grid->used && grid_radius >= search_radius && (grid_radius == search_radius || grid_radius < 2 * search_radius))
      return *grid;
    if (!grid->used && (unused == nullptr || grid_radius == search_radius)) unused = grid.get();
  }
  if (unused == nullptr) {
    grids_.push_back(std::make_unique<Grid>());
    unused = grids_.back().get();
  }
  unused->grid.build(cloud_, search_radius);
  unused->used = true;
  unused->filled = 0;
  return *unused;
}

void NeighborSet::gather_motions() {
  if (std::exchange(motions_gathered_, true)) return;
  const double* const transient = world_.store().transient_values().data();
  motions_.resize(cloud_.size());
  for (std::size_t i = 0; i < motions_.size(); i++) {
    const double* const own = transient + part_data_[cloud_indices_[i]].transient_offset;
    put(vec3_at(own + part_offsets().velocity), motions_[i].velocity);
    put(vec3_at(own + part_offsets().spin), motions_[i].spin);
  }
}

// Fills the grid's motions: positions, and velocities if wanted.
void NeighborSet::fill_motions(Grid& grid, unsigned want) {
  const unsigned fill = 1u | (want & kWantVelocity) << 1;
  if ((grid.filled & fill) == fill) return;
  grid.filled = fill;
  if ((want & kWantVelocity) != 0) gather_motions();
  const std::span<const std::uint32_t> order = grid.grid.order();
  grid.motions.resize(order.size());
  for (std::size_t k = 0; k < order.size(); k++) {
    NeighborMotion& motion = grid.motions[k];
    const std::uint32_t i = order[k];
    if ((want & kWantVelocity) != 0) {
      store(motion.velocity, load(motions_[i].velocity));
      store(motion.spin, load(motions_[i].spin));
    }
    motion.position[0] = cloud_.x[i];
    motion.position[1] = cloud_.y[i];
    motion.position[2] = cloud_.z[i];
    motion.position[3] = 1;
  }
}

// True if no two parts, of the set and of the query, are farther apart than `max_distance`.
bool NeighborSet::covers_all(const CachedMeans& cache) const {
  Vec3 low(cloud_.low[0], cloud_.low[1], cloud_.low[2]);
  Vec3 high(cloud_.high[0], cloud_.high[1], cloud_.high[2]);
  if (glm::length(high - low) > cache.max_distance) return false;
  for (const PartData& data : cache.part_data) {
    const Vec3 center = center_of(data);
    low = glm::min(low, center);
    high = glm::max(high, center);
  }
  return glm::length(high - low) <= cache.max_distance;
}

std::span<const NeighborMeans> NeighborSet::means(std::span<Part* const> parts, double min_distance,
                                                  double max_distance, unsigned want) {
  gather();
  CachedMeans* cache = nullptr;
  CachedMeans* unused = nullptr;
  for (CachedMeans& candidate : cached_means_) {
    const bool same_range = candidate.min_distance == min_distance && candidate.max_distance == max_distance;
    if (candidate.used && same_range &&
        std::equal(parts.begin(), parts.end(), candidate.parts.begin(), candidate.parts.end()))
      cache = &candidate;
    if (!candidate.used && (unused == nullptr || same_range)) unused = &candidate;
  }
  if (cache != nullptr && (want & ~cache->computed) == 0) {
    cache->requested |= want;
    return cache->means;
  }
  if (cache == nullptr) {
    if (unused == nullptr) unused = &cached_means_.emplace_back();
    cache = unused;
    if (cache->min_distance != min_distance || cache->max_distance != max_distance) cache->requested_before = 0;
    update_parts(*cache, parts);
  }
  cache->min_distance = min_distance;
  cache->max_distance = max_distance;
  cache->requested |= want;
  // compute also the means that were requested in the previous tick, since they will probably be requested again
  cache->computed = cache->requested | cache->requested_before;
  cache->used = true;
  cache->means.assign(parts.size(), NeighborMeans{});
  if (!(max_distance > min_distance) || cloud_.size() == 0) return cache->means;
  if (min_distance <= 0 && (cache->computed & kWantPush) == 0 && covers_all(*cache)) {
    compute_by_totals(*cache);
  } else {
    compute_by_grid(*cache);
  }
  return cache->means;
}

const NeighborMeans& NeighborSet::means_near(const Part& part, double min_distance, double max_distance,
                                             unsigned want) {
  gather();
  min_distance = std::max(min_distance, 0.0);
  max_distance = std::min(max_distance, kMaxRadius);
  const std::uint32_t index = index_of(part);
  if (index == kNoIndex) {
    single_means_ = {};
    if (!(max_distance > min_distance) || cloud_.size() == 0) return single_means_;
    Grid& grid = grid_for(static_cast<float>(max_distance));
    fill_motions(grid, kWantVelocity);
    return single_means_ = sum_near<kWantVelocity | kWantPush>(grid, data_of(part), min_distance, max_distance);
  }
  SetQuery* query = nullptr;
  for (SetQuery& known : set_queries_) {
    if (known.min_distance == min_distance && known.max_distance == max_distance) query = &known;
  }
  if (query == nullptr) query = &set_queries_.emplace_back(SetQuery{min_distance, max_distance});
  if (query->means == nullptr || (want & ~query->computed) != 0) {
    query->computed |= want;
    query->means = means(parts_, min_distance, max_distance, want).data();
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
  for (const Part* part : parts) cache.part_data.push_back(data_of(*part));
  cache.set_indices.clear();
  if (2 * parts.size() < parts_.size()) return;
  std::uint32_t index = 0;
  for (const Part* part : parts) {
    while (index < parts_.size() && parts_[index] != part) index++;
    if (index == parts_.size()) return cache.set_indices.clear();
    cache.set_indices.push_back(index++);
  }
}

void NeighborSet::compute_by_totals(CachedMeans& cache) {
  const double* const transient = world_.store().transient_values().data();
  Totals all;
  body_totals_.assign(static_cast<std::size_t>(body_count_), Totals{});
  for (std::size_t k = 0; k < cloud_.size(); k++) {
    const PartData& data = part_data_[cloud_indices_[k]];
    Totals summand{1, Vec3(cloud_.x[k], cloud_.y[k], cloud_.z[k]),
                   vec3_at(transient + data.transient_offset + part_offsets().velocity),
                   vec3_at(transient + data.transient_offset + part_offsets().spin)};
    Totals& body = body_totals_[static_cast<std::size_t>(body_ordinals_[static_cast<std::size_t>(data.body)])];
    for (Totals* sum : {&all, &body}) {
      sum->count += summand.count;
      sum->position += summand.position;
      sum->velocity += summand.velocity;
      sum->spin += summand.spin;
    }
  }
  for (std::size_t i = 0; i < cache.parts.size(); i++) {
    const PartData& data = cache.part_data[i];
    const auto slot = static_cast<std::size_t>(data.body);
    Totals own;
    if (slot < body_ordinals_.size() && body_ordinals_[slot] >= 0)
      own = body_totals_[static_cast<std::size_t>(body_ordinals_[slot])];
    const double count = all.count - own.count;
    if (count == 0) continue;
    NeighborMeans& means = cache.means[i];
    means.count = static_cast<std::uint32_t>(count);
    put((all.position - own.position) / count - center_of(data), means.offset);
    put((all.velocity - own.velocity) / count - vec3_at(transient + data.transient_offset + part_offsets().velocity),
        means.velocity);
    put((all.spin - own.spin) / count - vec3_at(transient + data.transient_offset + part_offsets().spin), means.spin);
  }
}

void NeighborSet::compute_by_grid(CachedMeans& cache) {
  Grid& grid = grid_for(static_cast<float>(cache.max_distance));
  fill_motions(grid, cache.computed);
  switch (cache.computed) {
    case 0:
      return sum<0>(grid, cache);
    case kWantVelocity:
      return sum<kWantVelocity>(grid, cache);
    case kWantPush:
      return sum<kWantPush>(grid, cache);
    default:
      return sum<kWantVelocity | kWantPush>(grid, cache);
  }
}

template <unsigned Want>
void NeighborSet::sum(Grid& grid, CachedMeans& cache) {
  return cache.set_indices.empty() ? sum_each<Want>(grid, cache) : sum_pairs<Want>(grid, cache);
}

template <unsigned Want>
NeighborMeans NeighborSet::sum_near(Grid& grid, const PartData& data, double min_distance, double max_distance) {
  const Vec3 center = center_of(data);
  const PointQuery query{static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                         data.body};
  const auto max_radius = static_cast<float>(max_distance);
  const float inverse_max_distance = 1 / max_radius;
  const std::uint32_t count = grid.grid.find_near(query, static_cast<float>(min_distance), max_radius, found_.data());
  const Float4 center_point{query.x, query.y, query.z, 0};
  Float4 offset{}, velocity{}, spin{}, push{};
  for (std::uint32_t j = 0; j < count; j++) {
    const NeighborMotion& neighbor = grid.motions[found_[j]];
    const Float4 r = load(neighbor.position) - center_point;
    offset += r;
    if constexpr ((Want & kWantVelocity) != 0) {
      velocity += load(neighbor.velocity);
      spin += load(neighbor.spin);
    }
    if constexpr ((Want & kWantPush) != 0) push += push_vector(r, inverse_max_distance);
  }
  NeighborSum sum{};
  Push pushes;
  store(sum.offset, offset);
  store(sum.velocity, velocity);
  store(sum.spin, spin);
  store(pushes.sum, push);
  return relative_means(sum, pushes, Want, data);
}

template <unsigned Want>
void NeighborSet::sum_each(Grid& grid, CachedMeans& cache) {
  for (std::size_t i = 0; i < cache.parts.size(); i++) {
    cache.means[i] = sum_near<Want>(grid, cache.part_data[i], cache.min_distance, cache.max_distance);
  }
}

void NeighborSet::push_pairs(std::uint32_t index, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                             float inverse_max_distance) {
  const Float4 own_position = load(motions[index].position) - Float4{0, 0, 0, 1};
  Float4 push = load(pushes_[index].sum);
  for (const std::uint32_t other : found) {
    const Float4 vector = push_vector(load(motions[other].position) - own_position, inverse_max_distance);
    push += vector;
    float* const other_sum = pushes_[other].sum;
    store(other_sum, load(other_sum) - vector);
  }
  store(pushes_[index].sum, push);
}

template <unsigned Want>
void NeighborSet::sum_pairs(Grid& grid, CachedMeans& cache) {
  const auto min_distance = static_cast<float>(cache.min_distance);
  const auto max_distance = static_cast<float>(cache.max_distance);
  const auto n = static_cast<std::uint32_t>(cloud_.size());
  sums_.assign(n, NeighborSum{});
  if constexpr ((Want & kWantPush) != 0) pushes_.assign(n, Push{});
  const AddPairs add = select_add_pairs(PointFinder::widest(), (Want & kWantVelocity) != 0);
  const NeighborMotion* const motions = grid.motions.data();
  for (std::uint32_t index = 0; index < n; index++) {
    const std::uint32_t count = grid.grid.find_pairs(index, min_distance, max_distance, found_.data());
    const std::span<const std::uint32_t> found(found_.data(), count);
    if (count == 0) continue;
    add(index, found, motions, sums_.data());
    if constexpr ((Want & kWantPush) != 0) push_pairs(index, found, motions, 1 / max_distance);
  }
  const Push none{};
  grid_index_.assign(parts_.size(), kNoIndex);
  const std::span<const std::uint32_t> order = grid.grid.order();
  for (std::uint32_t index = 0; index < n; index++) grid_index_[cloud_indices_[order[index]]] = index;
  for (std::size_t i = 0; i < cache.parts.size(); i++) {
    const std::uint32_t index = grid_index_[cache.set_indices[i]];
    if (index == kNoIndex) continue;  // its body is disabled
    const Push& push = (Want & kWantPush) != 0 ? pushes_[index] : none;
    cache.means[i] = means_from_sums(sums_[index], push, Want, motions[index]);
  }
}

NeighborMeans NeighborSet::relative_means(const NeighborSum& sum, const Push& push, unsigned want,
                                          const PartData& data) const {
  const double* const own = world_.store().transient_values().data() + data.transient_offset;
  NeighborMotion motion{};
  if ((want & kWantVelocity) != 0) {
    put(vec3_at(own + part_offsets().velocity), motion.velocity);
    put(vec3_at(own + part_offsets().spin), motion.spin);
  }
  return means_from_sums(sum, push, want, motion);
}

void NeighborSet::find_near(const Part& part, double radius, std::vector<Neighbor>& out) {
  gather();
  if (cloud_.size() == 0 || !(radius >= 0)) return out.clear();
  const auto search_radius = static_cast<float>(std::min(radius, kMaxRadius));
  Grid& grid = grid_for(search_radius);
  const std::uint32_t index = index_of(part);
  std::optional<std::span<const std::uint32_t>> neighbors;
  const bool in_set = index != kNoIndex && world_.store().transient_values()[part_data_[index].enabled_offset] != 0;
  if (in_set) neighbors = lists_.find(index, search_radius, {cloud_, grid.grid, cloud_indices_, parts_.size()});
  const PartData data = in_set ? part_data_[index] : data_of(part);
  const Vec3 center = in_set ? centers_[index] : center_of(data);
  if (!neighbors) {
    const PointQuery query{static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                           data.body};
    const std::uint32_t count = grid.grid.find_near(query, 0, search_radius, found_.data());
    for (std::uint32_t j = 0; j < count; j++) found_[j] = cloud_indices_[grid.grid.order()[found_[j]]];
    std::sort(found_.begin(), found_.begin() + count);
    neighbors = std::span<const std::uint32_t>(found_.data(), count);
  }
  out.resize(neighbors->size());
  for (std::size_t j = 0; j < neighbors->size(); j++) {
    const std::uint32_t i = (*neighbors)[j];
    const Vec3 offset = centers_[i] - center;
    out[j] = {i, offset, glm::length(offset)};
  }
}

}  // namespace limber

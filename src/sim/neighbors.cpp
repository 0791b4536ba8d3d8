// NeighborSet: gathering, grids, means.
#include "sim/neighbors.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/behavior_list.h"
#include "sim/lanes.h"
#include "sim/world.h"

namespace limber {

namespace {

// the unit vector times 1 − distance/most; zero where there is no direction
Lanes pushed(const Lanes& r, float inverse_most) {
  const float distance = std::sqrt((r[0] * r[0] + r[1] * r[1]) + r[2] * r[2]);
  return distance > 0 ? r * (1 / distance - inverse_most) : Lanes{};
}

void put(const Vec3& v, float* out) {
  for (int i = 0; i < 3; i++) out[i] = static_cast<float>(v[i]);
}

// a sum over neighbours as a mean, of motions beside the own one
template <class Push>
NeighborMeans mean_of(const NeighborSum& sum, const Push& push, unsigned want, const NeighborMotion& own) {
  NeighborMeans means;
  const float count = sum.offset[3];
  if (count == 0) return means;
  means.count = static_cast<std::uint32_t>(count);
  const float part = 1 / count;
  for (std::size_t a = 0; a < 3; a++) means.offset[a] = sum.offset[a] * part;
  if ((want & kWantVelocity) != 0) {
    for (std::size_t a = 0; a < 3; a++) means.velocity[a] = sum.velocity[a] * part - own.velocity[a];
    for (std::size_t a = 0; a < 3; a++) means.spin[a] = sum.spin[a] * part - own.spin[a];
  }
  if ((want & kWantPush) != 0) {
    for (std::size_t a = 0; a < 3; a++) means.push[a] = push.sum[a] * part;
  }
  return means;
}

constexpr std::uint32_t kNoPlace = 0xffffffffu;
constexpr double kFarthest = 1e7;  // m: further than any two parts are from each other, yet its square is a float

// where a part's numbers lie in its live block
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
  spots_.reserve(parts_.size());
  for (const Part* part : parts_) {
    ids_.push_back(part->id());
    spots_.push_back(spot_of(*part));
    const auto slot = static_cast<std::size_t>(spots_.back().body);
    if (slot >= ordinals_.size()) ordinals_.resize(slot + 1, -1);
    if (ordinals_[slot] < 0) ordinals_[slot] = bodies_++;
  }
  number_parts();
}

void NeighborSet::number_parts() {
  centers_.resize(parts_.size());
  std::fill(numbers_.begin(), numbers_.end(), -1);
  for (std::size_t i = 0; i < ids_.size(); i++) {
    const auto slot = static_cast<std::size_t>(ids_[i].slot);
    if (slot >= numbers_.size()) numbers_.resize(slot + 1, -1);
    numbers_[slot] = static_cast<std::int32_t>(i);
  }
}

std::uint32_t NeighborSet::number_of(const Part& part) const {
  const std::uint32_t slot = part.id().slot;
  return slot < numbers_.size() ? static_cast<std::uint32_t>(numbers_[slot]) : kNoPlace;
}

bool NeighborSet::holds(std::span<Part* const> parts) const {
  return std::equal(parts.begin(), parts.end(), ids_.begin(), ids_.end(),
                    [](const Part* part, NodeId id) { return part->id() == id; });
}

NeighborSet::Spot NeighborSet::spot_of(const Part& part) const {
  static const std::uint32_t enabled = Body::table().at("enabled").offset;
  const NodeSlot* const slots = world_.store().view()->slots;
  const std::uint32_t body = part.body().id().slot;
  const Vec3 center = part.geometry()->frame.position;
  return {slots[part.id().slot].live, slots[body].live + enabled, static_cast<std::int32_t>(body), center == Vec3(0),
          center};
}

Vec3 NeighborSet::center_of(const Spot& spot) const {
  const double* const live = world_.store().live().data() + spot.live;
  const Vec3 origin = vec3_at(live + part_offsets().position);
  if (spot.centered) return origin;
  const double* const q = live + part_offsets().rotation;
  return origin + quat_xyzw(q[0], q[1], q[2], q[3]) * spot.center;
}

void NeighborSet::gather() {
  if (const std::uint64_t turn = world_.behaviors().turn(); std::exchange(turn_, turn) == turn) return;
  const double* const live = world_.store().live().data();
  cloud_.clear();
  indices_.clear();
  constexpr std::size_t kAhead = 12;  // after a tick of physics these are far off: asked for in time
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (i + kAhead < parts_.size()) {
      __builtin_prefetch(live + spots_[i + kAhead].enabled);
      __builtin_prefetch(live + spots_[i + kAhead].live);
      __builtin_prefetch(live + spots_[i + kAhead].live + part_offsets().spin + 2);
    }
    if (live[spots_[i].enabled] == 0) continue;
    const Vec3 at = center_of(spots_[i]);
    centers_[i] = at;
    cloud_.add(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z), spots_[i].body);
    indices_.push_back(static_cast<std::uint32_t>(i));
  }
  cloud_.one_each = static_cast<std::size_t>(bodies_) == parts_.size();
  motions_gathered_ = false;
  lists_.begin();
  wholes_.clear();
  found_.resize(cloud_.size() + kPointRoom);
  for (const auto& grid : grids_) grid->used = false;
  for (Answer& answer : answers_) {
    answer.used = false;
    answer.asked_before = std::exchange(answer.asked, 0);
  }
}

void NeighborSet::forget(const Body& body) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < parts_.size(); i++) {
    if (&parts_[i]->body() == &body) continue;
    parts_[kept] = parts_[i];
    ids_[kept] = ids_[i];
    spots_[kept++] = spots_[i];
  }
  parts_.resize(kept);
  ids_.resize(kept);
  spots_.resize(kept);
  number_parts();
  turn_ = 0;
}

NeighborSet::Grid& NeighborSet::grid_for(float reach) {
  Grid* free = nullptr;
  for (const auto& grid : grids_) {
    const float has = grid->grid.reach();
    if (grid->used && has >= reach && (has == reach || has < 2 * reach)) return *grid;
    if (!grid->used && (free == nullptr || has == reach)) free = grid.get();
  }
  if (free == nullptr) {
    grids_.push_back(std::make_unique<Grid>());
    free = grids_.back().get();
  }
  free->grid.build(cloud_, reach);
  free->used = true;
  free->filled = 0;
  return *free;
}

void NeighborSet::gather_motions() {
  if (std::exchange(motions_gathered_, true)) return;
  const double* const live = world_.store().live().data();
  motions_.resize(cloud_.size());
  for (std::size_t i = 0; i < motions_.size(); i++) {
    const double* const own = live + spots_[indices_[i]].live;
    put(vec3_at(own + part_offsets().velocity), motions_[i].velocity);
    put(vec3_at(own + part_offsets().spin), motions_[i].spin);
  }
}

// positions always, velocities where they are wanted
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

// whether no part, of the set or of those that ask, is further than `most` from another
bool NeighborSet::covers_all(const Answer& answer) const {
  Vec3 low(cloud_.low[0], cloud_.low[1], cloud_.low[2]);
  Vec3 high(cloud_.high[0], cloud_.high[1], cloud_.high[2]);
  if (glm::length(high - low) > answer.most) return false;
  for (const Spot& spot : answer.spots) {
    const Vec3 at = center_of(spot);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  return glm::length(high - low) <= answer.most;
}

std::span<const NeighborMeans> NeighborSet::means(std::span<Part* const> of, double least, double most, unsigned want) {
  gather();
  Answer* answer = nullptr;
  Answer* spare = nullptr;
  for (Answer& known : answers_) {
    const bool same_range = known.least == least && known.most == most;
    if (known.used && same_range && std::equal(of.begin(), of.end(), known.of.begin(), known.of.end())) answer = &known;
    if (!known.used && (spare == nullptr || same_range)) spare = &known;
  }
  if (answer != nullptr && (want & ~answer->want) == 0) {
    answer->asked |= want;
    return answer->means;
  }
  if (answer == nullptr) {
    if (spare == nullptr) spare = &answers_.emplace_back();
    answer = spare;
    if (answer->least != least || answer->most != most) answer->asked_before = 0;
    take_question(*answer, of);
  }
  answer->least = least;
  answer->most = most;
  answer->asked |= want;
  // what was asked for in the tick before is asked for again, most likely: one pass for all
  answer->want = answer->asked | answer->asked_before;
  answer->used = true;
  answer->means.assign(of.size(), NeighborMeans{});
  if (!(most > least) || cloud_.size() == 0) return answer->means;
  if (least <= 0 && (answer->want & kWantPush) == 0 && covers_all(*answer)) {
    answer_by_totals(*answer);
  } else {
    answer_by_grid(*answer);
  }
  return answer->means;
}

const NeighborMeans& NeighborSet::means_near(const Part& of, double least, double most, unsigned want) {
  gather();
  least = std::max(least, 0.0);
  most = std::min(most, kFarthest);
  const std::uint32_t own = number_of(of);
  if (own == kNoPlace) {
    alone_ = {};
    if (!(most > least) || cloud_.size() == 0) return alone_;
    Grid& grid = grid_for(static_cast<float>(most));
    fill_motions(grid, kWantVelocity);
    return alone_ = sum_near<kWantVelocity | kWantPush>(grid, spot_of(of), least, most);
  }
  Whole* whole = nullptr;
  for (Whole& known : wholes_) {
    if (known.least == least && known.most == most) whole = &known;
  }
  if (whole == nullptr) whole = &wholes_.emplace_back(Whole{least, most});
  if (whole->means == nullptr || (want & ~whole->want) != 0) {
    whole->want |= want;
    whole->means = means(parts_, least, most, want).data();
  }
  return whole->means[own];
}

void NeighborSet::take_question(Answer& answer, std::span<Part* const> of) const {
  const std::uint64_t structure = world_.store().structure_version();
  const bool known =
      answer.structure == structure && std::equal(of.begin(), of.end(), answer.of.begin(), answer.of.end());
  if (known) return;
  answer.structure = structure;
  answer.of.assign(of.begin(), of.end());
  answer.spots.clear();
  for (const Part* part : of) answer.spots.push_back(spot_of(*part));
  answer.at.clear();
  if (2 * of.size() < parts_.size()) return;
  std::uint32_t at = 0;
  for (const Part* part : of) {
    while (at < parts_.size() && parts_[at] != part) at++;
    if (at == parts_.size()) return answer.at.clear();
    answer.at.push_back(at++);
  }
}

void NeighborSet::answer_by_totals(Answer& answer) {
  const double* const live = world_.store().live().data();
  Totals all;
  of_body_.assign(static_cast<std::size_t>(bodies_), Totals{});
  for (std::size_t k = 0; k < cloud_.size(); k++) {
    const Spot& spot = spots_[indices_[k]];
    Totals one{1, Vec3(cloud_.x[k], cloud_.y[k], cloud_.z[k]), vec3_at(live + spot.live + part_offsets().velocity),
               vec3_at(live + spot.live + part_offsets().spin)};
    Totals& body = of_body_[static_cast<std::size_t>(ordinals_[static_cast<std::size_t>(spot.body)])];
    for (Totals* sum : {&all, &body}) {
      sum->count += one.count;
      sum->position += one.position;
      sum->velocity += one.velocity;
      sum->spin += one.spin;
    }
  }
  for (std::size_t i = 0; i < answer.of.size(); i++) {
    const Spot& spot = answer.spots[i];
    const auto slot = static_cast<std::size_t>(spot.body);
    Totals own;
    if (slot < ordinals_.size() && ordinals_[slot] >= 0) own = of_body_[static_cast<std::size_t>(ordinals_[slot])];
    const double count = all.count - own.count;
    if (count == 0) continue;
    NeighborMeans& means = answer.means[i];
    means.count = static_cast<std::uint32_t>(count);
    put((all.position - own.position) / count - center_of(spot), means.offset);
    put((all.velocity - own.velocity) / count - vec3_at(live + spot.live + part_offsets().velocity), means.velocity);
    put((all.spin - own.spin) / count - vec3_at(live + spot.live + part_offsets().spin), means.spin);
  }
}

void NeighborSet::answer_by_grid(Answer& answer) {
  Grid& grid = grid_for(static_cast<float>(answer.most));
  fill_motions(grid, answer.want);
  switch (answer.want) {
    case 0:
      return sum<0>(grid, answer);
    case kWantVelocity:
      return sum<kWantVelocity>(grid, answer);
    case kWantPush:
      return sum<kWantPush>(grid, answer);
    default:
      return sum<kWantVelocity | kWantPush>(grid, answer);
  }
}

template <unsigned Want>
void NeighborSet::sum(Grid& grid, Answer& answer) {
  return answer.at.empty() ? sum_each<Want>(grid, answer) : sum_pairs<Want>(grid, answer);
}

template <unsigned Want>
NeighborMeans NeighborSet::sum_near(Grid& grid, const Spot& spot, double least, double most) {
  const Vec3 center = center_of(spot);
  const PointQuery query{static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                         spot.body};
  const auto farthest = static_cast<float>(most);
  const float inverse_most = 1 / farthest;
  const std::uint32_t count = grid.grid.near(query, static_cast<float>(least), farthest, found_.data());
  const Lanes at{query.x, query.y, query.z, 0};
  Lanes offset{}, velocity{}, spin{}, push{};
  for (std::uint32_t j = 0; j < count; j++) {
    const NeighborMotion& near = grid.motions[found_[j]];
    const Lanes r = load(near.position) - at;
    offset += r;
    if constexpr ((Want & kWantVelocity) != 0) {
      velocity += load(near.velocity);
      spin += load(near.spin);
    }
    if constexpr ((Want & kWantPush) != 0) push += pushed(r, inverse_most);
  }
  NeighborSum sum{};
  Push pushes;
  store(sum.offset, offset);
  store(sum.velocity, velocity);
  store(sum.spin, spin);
  store(pushes.sum, push);
  return means_of(sum, pushes, Want, spot);
}

template <unsigned Want>
void NeighborSet::sum_each(Grid& grid, Answer& answer) {
  for (std::size_t i = 0; i < answer.of.size(); i++) {
    answer.means[i] = sum_near<Want>(grid, answer.spots[i], answer.least, answer.most);
  }
}

void NeighborSet::push_pairs(std::uint32_t place, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                             float inverse_most) {
  const Lanes at = load(motions[place].position) - Lanes{0, 0, 0, 1};
  Lanes push = load(pushes_[place].sum);
  for (const std::uint32_t other : found) {
    const Lanes away = pushed(load(motions[other].position) - at, inverse_most);
    push += away;
    float* const its = pushes_[other].sum;
    store(its, load(its) - away);
  }
  store(pushes_[place].sum, push);
}

template <unsigned Want>
void NeighborSet::sum_pairs(Grid& grid, Answer& answer) {
  const auto least = static_cast<float>(answer.least);
  const auto most = static_cast<float>(answer.most);
  const auto n = static_cast<std::uint32_t>(cloud_.size());
  sums_.assign(n, NeighborSum{});
  if constexpr ((Want & kWantPush) != 0) pushes_.assign(n, Push{});
  const AddPairs add = add_pairs_by(PointFinder::widest(), (Want & kWantVelocity) != 0);
  const NeighborMotion* const motions = grid.motions.data();
  for (std::uint32_t place = 0; place < n; place++) {
    const std::uint32_t count = grid.grid.near_once(place, least, most, found_.data());
    const std::span<const std::uint32_t> found(found_.data(), count);
    if (count == 0) continue;
    add(place, found, motions, sums_.data());
    if constexpr ((Want & kWantPush) != 0) push_pairs(place, found, motions, 1 / most);
  }
  const Push none{};
  place_.assign(parts_.size(), kNoPlace);
  const std::span<const std::uint32_t> order = grid.grid.order();
  for (std::uint32_t place = 0; place < n; place++) place_[indices_[order[place]]] = place;
  for (std::size_t i = 0; i < answer.of.size(); i++) {
    const std::uint32_t place = place_[answer.at[i]];
    if (place == kNoPlace) continue;  // its body is out of the world
    const Push& push = (Want & kWantPush) != 0 ? pushes_[place] : none;
    answer.means[i] = mean_of(sums_[place], push, Want, motions[place]);
  }
}

NeighborMeans NeighborSet::means_of(const NeighborSum& sum, const Push& push, unsigned want, const Spot& spot) const {
  const double* const own = world_.store().live().data() + spot.live;
  NeighborMotion motion{};
  if ((want & kWantVelocity) != 0) {
    put(vec3_at(own + part_offsets().velocity), motion.velocity);
    put(vec3_at(own + part_offsets().spin), motion.spin);
  }
  return mean_of(sum, push, want, motion);
}

void NeighborSet::near(const Part& of, double radius, std::vector<Neighbor>& out) {
  gather();
  if (cloud_.size() == 0 || !(radius >= 0)) return out.clear();
  const auto reach = static_cast<float>(std::min(radius, kFarthest));
  Grid& grid = grid_for(reach);
  const std::uint32_t own = number_of(of);
  std::optional<std::span<const std::uint32_t>> near;
  const bool known = own != kNoPlace && world_.store().live()[spots_[own].enabled] != 0;
  if (known) near = lists_.of(own, reach, {cloud_, grid.grid, indices_, parts_.size()});
  const Spot spot = known ? spots_[own] : spot_of(of);
  const Vec3 center = known ? centers_[own] : center_of(spot);
  if (!near) {
    const PointQuery query{static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z),
                           spot.body};
    const std::uint32_t count = grid.grid.near(query, 0, reach, found_.data());
    for (std::uint32_t j = 0; j < count; j++) found_[j] = indices_[grid.grid.order()[found_[j]]];
    std::sort(found_.begin(), found_.begin() + count);
    near = std::span<const std::uint32_t>(found_.data(), count);
  }
  out.resize(near->size());
  for (std::size_t j = 0; j < near->size(); j++) {
    const std::uint32_t i = (*near)[j];
    const Vec3 offset = centers_[i] - center;
    out[j] = {i, offset, glm::length(offset)};
  }
}

}  // namespace limber

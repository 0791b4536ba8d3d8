// PartPairs: the list of pairs, and its application to Bullet.
#include "sim/world/part_pairs.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/memory/archive.h"
#include "model/overlap.h"
#include "sim/bullet/collision_filter.h"
#include "sim/bullet/island_world.h"
#include "sim/shapes/geometry.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr int kPairBits = 30;  // of a part's index, in the packed value of an undo step

// Returns true if the groups, masks and self_collision of two parts let them collide.
bool may_collide(Part& a, Part& b) {
  return bullet::CollisionFilter::of(a.rigid()).accepts(bullet::CollisionFilter::of(b.rigid()));
}

bool pair_before(const PartPair& pair, const std::pair<std::size_t, std::size_t>& key) {
  return std::pair<std::size_t, std::size_t>(pair.a, pair.b) < key;
}

std::size_t index_of(const Body& body, const Part& part) {
  const auto parts = body.parts();
  const auto at = std::find_if(parts.begin(), parts.end(), [&](const auto& each) { return each.get() == &part; });
  return static_cast<std::size_t>(at - parts.begin());
}

}  // namespace

void OverlapReport::add(const Body& body, const Part& a, const Part& b, double depth) {
  if (count_++ > 0) return;
  first_ = fmt::format("body '{}': '{}' and '{}' overlap at the first tick ({:.3g} mm); excluded from collision",
                       body.name(), a.name(), b.name(), depth * 1000);
}

void OverlapReport::log() {
  if (count_ == 0) return;
  const std::size_t more = std::exchange(count_, 0) - 1;
  log_warning("{}{}. Move the parts apart, or let them collide with body:include_pair(a, b).", first_,
              more > 0 ? fmt::format(" … and {} more of this kind", more) : "");
}

const PartPair* PartPairs::find(std::size_t a, std::size_t b) const {
  const std::pair<std::size_t, std::size_t> key = std::minmax(a, b);
  const auto at = std::lower_bound(state_.list.begin(), state_.list.end(), key, pair_before);
  return at != state_.list.end() && at->a == key.first && at->b == key.second ? &*at : nullptr;
}

PartPair& PartPairs::entry(std::size_t a, std::size_t b) {
  const std::pair<std::size_t, std::size_t> key = std::minmax(a, b);
  const auto at = std::lower_bound(state_.list.begin(), state_.list.end(), key, pair_before);
  if (at != state_.list.end() && at->a == key.first && at->b == key.second) return *at;
  return *state_.list.insert(at,
                             {static_cast<std::uint32_t>(key.first), static_cast<std::uint32_t>(key.second), 0, {}});
}

bool PartPairs::excludes(const Part& a, const Part& b) const {
  const PartPair* const pair = find(index_of(body_, a), index_of(body_, b));
  return pair != nullptr && pair->excluded();
}

Result<void> PartPairs::edit(const Part& a, const Part& b, PairEdit edit) {
  if (&a.body() != &body_ || &b.body() != &body_) {
    return Error{fmt::format("body '{}': both parts must be of this body; use collision groups for parts of two bodies",
                             body_.name())};
  }
  if (&a == &b)
    return Error{fmt::format("body '{}': a pair needs two different parts, not '{}' twice", body_.name(), a.name())};
  set_edit(index_of(body_, a), index_of(body_, b), edit);
  return {};
}

void PartPairs::set_edit(std::size_t a, std::size_t b, PairEdit edit) {
  PartPair& pair = entry(a, b);
  const auto before = static_cast<std::size_t>(pair.edit);
  body_.world().transaction().record(
      [](void* owner, std::size_t value) {
        constexpr std::size_t kIndexMask = (std::size_t{1} << kPairBits) - 1;
        static_cast<PartPairs*>(owner)->set_edit(value & kIndexMask, value >> kPairBits & kIndexMask,
                                                 static_cast<PairEdit>(value >> (2 * kPairBits)));
      },
      this, a | b << kPairBits | before << (2 * kPairBits));
  const bool was_excluded = pair.excluded();
  pair.edit = edit;
  const bool changed = pair.excluded() != was_excluded;
  if (pair.edit == PairEdit::none && pair.overlaps == 0)
    state_.list.erase(state_.list.begin() + (&pair - state_.list.data()));
  if (changed) apply(a, b);
}

// Returns true if the pair's exclusion changed.
bool PartPairs::set_overlaps(std::size_t a, std::size_t b) {
  PartPair& pair = entry(a, b);
  const bool before = pair.excluded();
  pair.overlaps = 1;
  return pair.excluded() != before;
}

// Applies a change of a pair's exclusion.
void PartPairs::apply(std::size_t a, std::size_t b) {
  const PartPair* const pair = find(a, b);
  bullet::IslandWorld& bullet = body_.world().bullet();
  btRigidBody& rigid_a = body_.parts()[a]->rigid();
  btRigidBody& rigid_b = body_.parts()[b]->rigid();
  if (pair != nullptr && pair->excluded()) {
    bullet.exclude_pair(rigid_a, rigid_b);
  } else {
    bullet.include_pair(rigid_a, rigid_b);
  }
}

// Applies the exclusions of new parts, which Bullet has no pairs of yet.
void PartPairs::apply_all() {
  for (const PartPair& pair : state_.list) {
    if (pair.excluded()) apply(pair.a, pair.b);
  }
}

void PartPairs::build(const model::BodyModel& model) {
  for (const model::Overlap& overlap : model.overlaps) {
    (void)set_overlaps(static_cast<std::size_t>(overlap.a), static_cast<std::size_t>(overlap.b));
  }
  for (const auto& [a, b] : model.exclusions) {
    (void)set_overlaps(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  }
  state_.checked_count = body_.parts().size();
  apply_all();
}

void PartPairs::build_copy(const PartPairs& source) {
  state_ = source.state_;
  apply_all();
}

void PartPairs::find_new_overlaps(OverlapReport& report) {
  const auto parts = body_.parts();
  if (state_.checked_count >= parts.size()) return;
  const std::size_t first_new = std::exchange(state_.checked_count, parts.size());
  if (parts.size() < 2) return;
  std::vector<model::OverlapPart> shapes;
  std::vector<std::pair<std::size_t, std::size_t>> joined;
  for (const auto& part : parts) shapes.push_back({part->geometry()->placed, part->pose()});
  for (const auto& joint : body_.joints()) {
    joined.push_back(std::minmax(index_of(body_, joint->parent()), index_of(body_, joint->child())));
  }
  std::sort(joined.begin(), joined.end());
  const model::OverlapResult result = model::find_overlaps(shapes, [&](std::size_t a, std::size_t b) {
    return b >= first_new && !(parts[a]->is_static() && parts[b]->is_static()) &&
           !std::binary_search(joined.begin(), joined.end(), std::pair(a, b));
  });
  for (const model::Overlap& overlap : result.found) {
    const auto a = static_cast<std::size_t>(overlap.a);
    const auto b = static_cast<std::size_t>(overlap.b);
    if (!set_overlaps(a, b)) continue;
    apply(a, b);
    if (may_collide(*parts[a], *parts[b])) report.add(body_, *parts[a], *parts[b], overlap.depth);
  }
}

void PartPairs::serialize(Archive& archive) {
  auto& [list, checked_count] = state_;
  archive.serialize_all(list, checked_count);
}

}  // namespace limber::sim

// PartPairs: the list of pairs, and its use by Body and World.
#include "sim/world/part_pairs.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/memory/archive.h"
#include "model/overlap.h"
#include "sim/bullet/island_world.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber {

namespace {

constexpr int kPairBits = 30;  // of a part's index, in the packed value of an undo step

bool pair_before(const PartPair& pair, const std::pair<std::size_t, std::size_t>& key) {
  return std::pair<std::size_t, std::size_t>(pair.a, pair.b) < key;
}

std::size_t index_of(const Body& body, const Part& part) {
  const auto parts = body.parts();
  const auto at = std::find_if(parts.begin(), parts.end(), [&](const auto& each) { return each.get() == &part; });
  return static_cast<std::size_t>(at - parts.begin());
}

}  // namespace

const PartPair* PartPairs::find(std::size_t a, std::size_t b) const {
  const std::pair<std::size_t, std::size_t> key = std::minmax(a, b);
  const auto at = std::lower_bound(list.begin(), list.end(), key, pair_before);
  return at != list.end() && at->a == key.first && at->b == key.second ? &*at : nullptr;
}

PartPair& PartPairs::entry(std::size_t a, std::size_t b) {
  const std::pair<std::size_t, std::size_t> key = std::minmax(a, b);
  const auto at = std::lower_bound(list.begin(), list.end(), key, pair_before);
  if (at != list.end() && at->a == key.first && at->b == key.second) return *at;
  return *list.insert(at, {static_cast<std::uint32_t>(key.first), static_cast<std::uint32_t>(key.second), 0, {}});
}

bool PartPairs::set_edit(std::size_t a, std::size_t b, PairEdit edit) {
  PartPair& pair = entry(a, b);
  const bool before = pair.excluded();
  pair.edit = edit;
  const bool changed = pair.excluded() != before;
  if (pair.edit == PairEdit::none && pair.overlaps == 0) list.erase(list.begin() + (&pair - list.data()));
  return changed;
}

bool PartPairs::set_overlaps(std::size_t a, std::size_t b) {
  PartPair& pair = entry(a, b);
  const bool before = pair.excluded();
  pair.overlaps = 1;
  return pair.excluded() != before;
}

void PartPairs::serialize(Archive& archive) {
  auto& [pairs, checked] = *this;
  archive.serialize_all(pairs, checked);
}

bool Body::excludes(const Part& a, const Part& b) const {
  const PartPair* const pair = state_.pairs.find(index_of(*this, a), index_of(*this, b));
  return pair != nullptr && pair->excluded();
}

Result<void> Body::edit_pair(const Part& a, const Part& b, PairEdit edit) {
  if (&a.body() != this || &b.body() != this) {
    return Error{fmt::format("body '{}': both parts must be of this body; use collision groups for parts of two bodies",
                             name())};
  }
  if (&a == &b)
    return Error{fmt::format("body '{}': a pair needs two different parts, not '{}' twice", name(), a.name())};
  set_pair(index_of(*this, a), index_of(*this, b), edit);
  return {};
}

void Body::set_pair(std::size_t a, std::size_t b, PairEdit edit) {
  const PartPair* const pair = state_.pairs.find(a, b);
  const auto before = static_cast<std::size_t>(pair == nullptr ? PairEdit::none : pair->edit);
  world_.transaction().record(
      [](void* owner, std::size_t value) {
        constexpr std::size_t kIndexMask = (std::size_t{1} << kPairBits) - 1;
        static_cast<Body*>(owner)->set_pair(value & kIndexMask, value >> kPairBits & kIndexMask,
                                            static_cast<PairEdit>(value >> (2 * kPairBits)));
      },
      this, a | b << kPairBits | before << (2 * kPairBits));
  if (state_.pairs.set_edit(a, b, edit)) apply_pair(a, b);
}

// Applies a change of a pair's exclusion.
void Body::apply_pair(std::size_t a, std::size_t b) {
  const PartPair* const pair = state_.pairs.find(a, b);
  IslandWorld& bullet = world_.bullet();
  if (pair != nullptr && pair->excluded()) {
    bullet.exclude_pair(parts_[a]->rigid(), parts_[b]->rigid());
  } else {
    bullet.include_pair(parts_[a]->rigid(), parts_[b]->rigid());
  }
}

// Applies the exclusions of new parts, which Bullet has no pairs of yet.
void Body::apply_pairs() {
  for (const PartPair& pair : state_.pairs.list) {
    if (pair.excluded()) apply_pair(pair.a, pair.b);
  }
}

void Body::find_overlaps() {
  const std::size_t first_new = std::exchange(state_.pairs.checked_count, parts_.size());
  if (parts_.size() < 2) return;
  std::vector<OverlapPart> shapes;
  std::vector<std::pair<std::size_t, std::size_t>> joined;
  for (const auto& part : parts_) shapes.push_back({part->geometry()->placed, part->pose()});
  for (const auto& joint : joints_) {
    joined.push_back(std::minmax(index_of(*this, joint->parent()), index_of(*this, joint->child())));
  }
  std::sort(joined.begin(), joined.end());
  const OverlapResult result = limber::find_overlaps(shapes, [&](std::size_t a, std::size_t b) {
    return b >= first_new && !(parts_[a]->is_static() && parts_[b]->is_static()) &&
           !std::binary_search(joined.begin(), joined.end(), std::pair(a, b));
  });
  for (const Overlap& overlap : result.found) {
    const auto a = static_cast<std::size_t>(overlap.a);
    const auto b = static_cast<std::size_t>(overlap.b);
    if (!state_.pairs.set_overlaps(a, b)) continue;
    apply_pair(a, b);
    world_.report_overlap(*this, *parts_[a], *parts_[b], overlap.depth);
  }
}

void World::report_overlap(const Body& body, const Part& a, const Part& b, double depth) {
  if (overlap_count_++ > 0) return;
  first_overlap_ =
      fmt::format("body '{}': '{}' and '{}' overlap at the first tick ({:.3g} mm); excluded from collision",
                  body.name(), a.name(), b.name(), depth * 1000);
}

void World::log_overlaps() {
  if (overlap_count_ == 0) return;
  const std::size_t more = std::exchange(overlap_count_, 0) - 1;
  log_warning("{}{}. Move the parts apart, or let them collide with body:include_pair(a, b).", first_overlap_,
              more > 0 ? fmt::format(" … and {} more of this kind", more) : "");
}

}  // namespace limber

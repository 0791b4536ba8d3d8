// ContactPoints: merging the points of substeps, and looking them up.
#include "sim/sensors/contact_points.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "base/memory/archive.h"
#include "properties/store.h"
#include "sim/bullet/bullet.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {

auto pair_of(const ContactPoint& point) { return std::tie(point.a, point.b); }

bool is_before(const ContactPoint& x, const ContactPoint& y) {
  return std::tie(x.a, x.b, x.order) < std::tie(y.a, y.b, y.order);
}

bool reports(const Store& store, NodeId id) {
  return store.alive(id) && static_cast<const Part*>(store.object(id))->reports_contacts();
}

}  // namespace

void ContactPoints::begin_tick() {
  state_.points.clear();
  state_.by_part.clear();
  state_.streamed.clear();
}

void ContactPoints::add(const Part& a, const Part& b, const btManifoldPoint& point) {
  const bool swapped = b.id() < a.id();
  const double sign = swapped ? -1 : 1;
  const btVector3 friction = point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                             point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
  ContactPoint& added = added_.emplace_back();
  added.a = swapped ? b.id() : a.id();
  added.b = swapped ? a.id() : b.id();
  added.position = 0.5 * (bullet::from_bt(point.getPositionWorldOnA()) + bullet::from_bt(point.getPositionWorldOnB()));
  added.normal = sign * bullet::from_bt(point.m_normalWorldOnB);
  added.friction = sign * bullet::from_bt(friction);
  added.impulse = static_cast<double>(point.getAppliedImpulse());
  added.distance = static_cast<double>(point.getDistance());
  added.order = static_cast<std::uint32_t>(added_.size());
  added.in_use = 1;
}

// Adds the point to the nearest of merged_[first, last) that no other point of this substep continues, or appends it.
void ContactPoints::merge(const ContactPoint& point, std::size_t first, std::size_t last) {
  ContactPoint* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; i++) {
    if (merged_[i].in_use != 0) continue;
    const Vec3 offset = merged_[i].position - point.position;
    if (const double distance = glm::dot(offset, offset); distance < least) {
      least = distance;
      nearest = &merged_[i];
    }
  }
  if (nearest == nullptr) {
    merged_.push_back(point);
    return;
  }
  const Vec3 friction = nearest->friction + point.friction;
  const double impulse = nearest->impulse + point.impulse;
  *nearest = point;
  nearest->friction = friction;
  nearest->impulse = impulse;
}

void ContactPoints::end_substep() {
  std::sort(added_.begin(), added_.end(), is_before);
  merged_.clear();
  auto old = state_.points.begin();
  const auto end = state_.points.end();
  const auto keep = [&] {
    merged_.push_back(*old++);
    merged_.back().in_use = 0;
  };
  for (std::size_t i = 0; i < added_.size();) {
    const ContactPoint& head = added_[i];
    while (old != end && pair_of(*old) < pair_of(head)) keep();
    const std::size_t first = merged_.size();
    while (old != end && pair_of(*old) == pair_of(head)) keep();
    const std::size_t last = merged_.size();
    for (; i < added_.size() && pair_of(added_[i]) == pair_of(head); i++) merge(added_[i], first, last);
  }
  while (old != end) keep();
  std::swap(merged_, state_.points);
  added_.clear();
}

void ContactPoints::end_tick(const Store& store, double seconds) {
  state_.seconds = seconds;
  for (std::size_t i = 0; i < state_.points.size(); i++) {
    const auto index = static_cast<std::uint32_t>(i);
    for (const NodeId id : {state_.points[i].a, state_.points[i].b}) {
      if (reports(store, id)) state_.by_part.push_back({id, index});
    }
  }
  std::sort(state_.by_part.begin(), state_.by_part.end());
  static const Property& stream = Part::table().at("stream_contacts");
  for (const PartContact& contact : state_.by_part) {
    if (store.values(contact.part, stream)[0] != 0) state_.streamed.push_back(contact);
  }
}

std::span<const PartContact> ContactPoints::of(NodeId part) const {
  const auto first = std::lower_bound(state_.by_part.begin(), state_.by_part.end(), PartContact{part, 0});
  auto last = first;
  while (last != state_.by_part.end() && last->part == part) ++last;
  return {first, last};
}

double ContactPoints::impulse_between(NodeId a, NodeId b) const {
  if (b < a) std::swap(a, b);
  auto point = std::lower_bound(state_.points.begin(), state_.points.end(), std::tie(a, b),
                                [](const ContactPoint& each, const auto& wanted) { return pair_of(each) < wanted; });
  double sum = 0;
  for (; point != state_.points.end() && pair_of(*point) == std::tie(a, b); ++point) sum += point->impulse;
  return sum;
}

void ContactPoints::serialize(Archive& archive) {
  auto& [points, by_part, streamed, seconds] = state_;
  archive.serialize_all(points, by_part, streamed, seconds);
}

}  // namespace limber::sim

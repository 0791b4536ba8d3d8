// Contacts: tracks pairs of reporting parts over the substeps of a tick.
#include "sim/world/contacts.h"

#include <algorithm>
#include <utility>

#include "base/memory/archive.h"
#include "sim/bullet/bullet.h"
#include "sim/collision/manifold_builder.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {
Part* part_of(const btCollisionObject* object) { return static_cast<Part*>(object->getUserPointer()); }
// initial distance of a pair: greater than that of any touching point, m
constexpr double kNoDistance = 1;
// a contact has closed if its surfaces are at most this far apart, m
constexpr btScalar kClosedDistance = 1e-4F;
}  // namespace

Contacts::Pair& Contacts::pair_of(Part* a, Part* b) {
  // Bullet may swap the objects of a pair that touches again. Pairs are few, so a linear search is fast enough.
  if (b->id() < a->id()) std::swap(a, b);
  for (Pair& pair : state_.pairs) {
    if (pair.a == a && pair.b == b) return pair;
  }
  state_.pairs.push_back({a, b, 0, kNoDistance, Vec3(0), false, false, false, false});
  return state_.pairs.back();
}

void Contacts::begin_tick() {
  for (std::vector<ContactEvent>& events : state_.events) events.clear();
  points_.begin_tick();
  for (Pair& pair : state_.pairs) {
    pair.touched_before = pair.touching && !pair.event_pending;
    pair.touching = false;
    if (pair.event_pending) continue;
    pair.impulse = 0;
    pair.distance = kNoDistance;
  }
}

// Adds a touching point as of the last substep.
void Contacts::Pair::add(btManifoldPoint& point) {
  touching = true;
  if ((point.m_contactPointFlags & collision::kContactClosed) == 0) {
    impulse += point.getAppliedImpulse();
    if (point.getAppliedImpulse() > 0 && point.getDistance() <= kClosedDistance) {
      point.m_contactPointFlags |= collision::kContactClosed;
    } else if (point.getAppliedImpulse() > 0) {
      closing = true;
    }
  }
  if (point.getDistance() < distance) {
    distance = point.getDistance();
    position = bullet::from_bt(point.getPositionWorldOnB());
  }
}

void Contacts::collect_points(btPersistentManifold& manifold) {
  Part* a = part_of(manifold.getBody0());
  Part* b = part_of(manifold.getBody1());
  if (manifold.getNumContacts() == 0 || a == nullptr || b == nullptr) return;
  if (!a->reports_contacts() && !b->reports_contacts()) return;
  for (int k = 0; k < manifold.getNumContacts(); k++) {
    btManifoldPoint& point = manifold.getContactPoint(k);
    if (point.getDistance() > 0 && point.getAppliedImpulse() <= 0) continue;
    pair_of(a, b).add(point);
    // beyond this distance the solver has no row for the point, whose impulse is that of an earlier step
    if (point.getDistance() <= manifold.getContactProcessingThreshold()) points_.add(*a, *b, point);
  }
}

void Contacts::collect(btDispatcher& dispatcher) {
  if (state_.reporting <= 0) return;
  for (Pair& pair : state_.pairs) pair.closing = false;
  for (int i = 0; i < dispatcher.getNumManifolds(); i++) collect_points(*dispatcher.getManifoldByIndexInternal(i));
  points_.end_substep();
}

void Contacts::add_event(ContactPhase phase, const Pair& pair, double impulse) {
  std::vector<ContactEvent>& events = state_.events[static_cast<std::size_t>(phase)];
  if (pair.a->reports_contacts()) events.push_back({pair.a->id(), pair.b->id(), impulse, pair.position});
  if (pair.b->reports_contacts()) events.push_back({pair.b->id(), pair.a->id(), impulse, pair.position});
}

void Contacts::end_tick(const Store& store, double seconds) {
  points_.end_tick(store, seconds);
  for (Pair& pair : state_.pairs) {
    if (pair.touched_before) {
      if (!pair.touching) {
        add_event(ContactPhase::end, pair, 0);
      } else {
        add_event(ContactPhase::stay, pair, points_.impulse_between(pair.a->id(), pair.b->id()));
      }
      continue;
    }
    if (!pair.touching && !pair.event_pending) continue;
    pair.event_pending = pair.closing && !pair.event_pending;
    if (pair.event_pending) continue;
    add_event(ContactPhase::begin, pair, pair.impulse);
    if (!pair.touching) add_event(ContactPhase::end, pair, 0);
  }
  std::erase_if(state_.pairs,
                [](const Pair& pair) { return !pair.touching && !pair.touched_before && !pair.event_pending; });
}

void Contacts::remove_part(const Part& part) {
  std::erase_if(state_.pairs, [&](const Pair& pair) { return pair.a == &part || pair.b == &part; });
}

void Contacts::serialize(Archive& archive) {
  auto& [reporting, pairs, events] = state_;
  archive.serialize_all(reporting, pairs, events[0], events[1], events[2], points_);
}

}  // namespace limber::sim

// Contacts: pairs of reporting parts over the tick's internal steps.
#include "sim/contacts.h"

#include <algorithm>
#include <utility>

#include "sim/contact_manifold.h"
#include "sim/part.h"

namespace limber {

namespace {
Part* part_of(const btCollisionObject* object) { return static_cast<Part*>(object->getUserPointer()); }
// farther than any point that counts as touching, m
constexpr double kNoDepth = 1;
// a contact has closed when its surfaces are at most this far apart, m
constexpr btScalar kClosed = 1e-4F;
}  // namespace

Contacts::Pair& Contacts::pair_of(Part* a, Part* b) {
  // Bullet may turn a pair round when it meets again; a handful of pairs at a time: a plain search
  if (b->id() < a->id()) std::swap(a, b);
  for (Pair& pair : pairs_) {
    if (pair.a == a && pair.b == b) return pair;
  }
  pairs_.push_back({a, b, 0, kNoDepth, Vec3(0), false, false, false, false});
  return pairs_.back();
}

void Contacts::begin_tick() {
  begun_.clear();
  for (Pair& pair : pairs_) {
    pair.before = pair.now && !pair.waits;
    pair.now = false;
    if (pair.waits) continue;
    pair.impulse = 0;
    pair.depth = kNoDepth;
  }
}

void Contacts::gather(btDispatcher& dispatcher) {
  if (reporting_ <= 0) return;
  for (Pair& pair : pairs_) pair.closing = false;
  for (int i = 0; i < dispatcher.getNumManifolds(); i++) {
    btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    Part* a = part_of(manifold.getBody0());
    Part* b = part_of(manifold.getBody1());
    if (manifold.getNumContacts() == 0 || a == nullptr || b == nullptr) continue;
    if (!a->reports_contacts() && !b->reports_contacts()) continue;
    for (int k = 0; k < manifold.getNumContacts(); k++) {
      btManifoldPoint& point = manifold.getContactPoint(k);
      if (point.getDistance() > 0 && point.getAppliedImpulse() <= 0) continue;
      Pair& pair = pair_of(a, b);
      pair.now = true;
      if ((point.m_contactPointFlags & kContactClosed) == 0) {
        pair.impulse += point.getAppliedImpulse();
        if (point.getAppliedImpulse() > 0 && point.getDistance() <= kClosed) {
          point.m_contactPointFlags |= kContactClosed;
        } else if (point.getAppliedImpulse() > 0) {
          pair.closing = true;
        }
      }
      if (point.getDistance() < pair.depth) {
        pair.depth = point.getDistance();
        pair.position = from_bt(point.getPositionWorldOnB());
      }
    }
  }
}

void Contacts::end_tick() {
  for (Pair& pair : pairs_) {
    if (pair.before || (!pair.now && !pair.waits)) continue;
    pair.waits = pair.closing && !pair.waits;
    if (pair.waits) continue;
    if (pair.a->reports_contacts()) begun_.push_back({pair.a->id(), pair.b->id(), pair.impulse, pair.position});
    if (pair.b->reports_contacts()) begun_.push_back({pair.b->id(), pair.a->id(), pair.impulse, pair.position});
  }
  std::erase_if(pairs_, [](const Pair& pair) { return !pair.now && !pair.before && !pair.waits; });
}

void Contacts::forget(const Part& part) {
  std::erase_if(pairs_, [&](const Pair& pair) { return pair.a == &part || pair.b == &part; });
}

}  // namespace limber

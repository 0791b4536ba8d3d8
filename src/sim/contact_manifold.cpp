// Reduces the contact points of a step to at most four, and carries impulses over from the step before.
#include "sim/contact_manifold.h"

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

constexpr int kMostKept = 4;
/// Points at most this far apart, or Bullet's breaking threshold where that is less, are contacts even where nothing
/// approaches, m.
constexpr btScalar kNear = 1e-3F;
/// A point is deeper, farther or wider than one before it only if it is so by more than rounding, so that the choice
/// among equal ones stays the same from step to step: m, and part of the value.
constexpr btScalar kDeeper = 1e-5F;
constexpr btScalar kMore = 1.001F;
/// A point continues one of the step before that is at most this many breaking thresholds away.
constexpr btScalar kSamePoint = 4;

const btRigidBody* moving(const btCollisionObject* object) {
  return object->isStaticObject() ? nullptr : btRigidBody::upcast(object);
}

// Upper bound of the speed of its points about its center, m/s; its box is at least as large as the part.
btScalar turn_speed(const btRigidBody& body) {
  const btBroadphaseProxy* box = body.getBroadphaseHandle();
  if (box == nullptr) return 0;
  return std::sqrt(body.getAngularVelocity().length2() * (box->m_aabbMax - box->m_aabbMin).length2());
}

// What solvers remember of a contact.
void inherit(const btManifoldPoint& from, btManifoldPoint& to) {
  to.m_appliedImpulse = from.m_appliedImpulse;
  to.m_appliedImpulseLateral1 = from.m_appliedImpulseLateral1;
  to.m_appliedImpulseLateral2 = from.m_appliedImpulseLateral2;
  to.m_lateralFrictionDir1 = from.m_lateralFrictionDir1;
  to.m_lateralFrictionDir2 = from.m_lateralFrictionDir2;
  to.m_contactMotion1 = from.m_contactMotion1;
  to.m_contactMotion2 = from.m_contactMotion2;
  to.m_contactPointFlags |= from.m_contactPointFlags & kContactClosed;
}

}  // namespace

ContactManifold::ContactManifold(btPersistentManifold& manifold, btScalar h)
    : manifold_(manifold),
      a_(moving(manifold.getBody0())),
      b_(moving(manifold.getBody1())),
      h_(h),
      near_(std::min(kNear, manifold.getContactBreakingThreshold())),
      turn_reach_(near_),
      reach_(near_),
      ahead_(manifold.getContactProcessingThreshold() > 0) {
  if (!ahead_) return;
  if (a_ != nullptr) way_ -= a_->getLinearVelocity() * h_;
  if (b_ != nullptr) way_ += b_->getLinearVelocity() * h_;
  turn_reach_ += ((a_ != nullptr ? turn_speed(*a_) : 0) + (b_ != nullptr ? turn_speed(*b_) : 0)) * h_;
  reach_ = turn_reach_ + way_.length();
}

// How far the two come nearer to each other at a point in the step. What turns moves on a circle: without the second
// order a fast wheel would be braked by points that never come down.
btScalar ContactManifold::approach(const btVector3& point, const btVector3& normal) const {
  const auto way = [&](const btRigidBody& body) {
    const btVector3 arm = point - body.getWorldTransform().getOrigin();
    const btVector3& spin = body.getAngularVelocity();
    const btVector3 turning = spin.cross(arm);
    return normal.dot(body.getLinearVelocity() + turning + spin.cross(turning) * (h_ / 2)) * h_;
  };
  return (b_ != nullptr ? way(*b_) : 0) - (a_ != nullptr ? way(*a_) : 0);
}

void ContactManifold::add(const btVector3& point_on_b, const btVector3& normal, btScalar distance) {
  if (distance > reach_ || count_ == kMaxPoints) return;
  if (distance > near_ && distance > near_ + approach(point_on_b, normal)) return;
  points_[static_cast<std::size_t>(count_++)] = {point_on_b, normal, distance};
}

int ContactManifold::find_deepest() const {
  int best = 0;
  for (int i = 1; i < count_; ++i) {
    if (at(i).distance < at(best).distance - kDeeper) best = i;
  }
  return best;
}

int ContactManifold::find_farthest(int from) const {
  int best = -1;
  btScalar most = SIMD_EPSILON * SIMD_EPSILON;
  for (int i = 0; i < count_; ++i) {
    const btScalar far = (at(i).on_b - at(from).on_b).length2();
    if (far > most * kMore) {
      most = far;
      best = i;
    }
  }
  return best;
}

// The point farthest from the line through a and b, on one side of it; -1: none that spans an area.
int ContactManifold::find_widest(int a, int b, btScalar side) const {
  const btVector3 line = at(b).on_b - at(a).on_b;
  const btVector3 across = at(a).normal.cross(line) * side;
  int best = -1;
  btScalar most = line.length2() * 1e-4F;
  for (int i = 0; i < count_; ++i) {
    const btScalar far = across.dot(at(i).on_b - at(a).on_b);
    if (far > most * kMore) {
      most = far;
      best = i;
    }
  }
  return best;
}

void ContactManifold::reduce() {
  if (count_ <= 1) return;
  int kept[kMostKept];
  int count = 0;
  kept[count++] = find_deepest();
  const int far = find_farthest(kept[0]);
  if (far >= 0) {
    kept[count++] = far;
    for (const btScalar side : {btScalar(1), btScalar(-1)}) {
      const int wide = find_widest(kept[0], far, side);
      if (wide >= 0) kept[count++] = wide;
    }
  }
  Point chosen[kMostKept];
  for (int i = 0; i < count; ++i) chosen[i] = at(kept[i]);
  for (int i = 0; i < count; ++i) points_[static_cast<std::size_t>(i)] = chosen[i];
  count_ = count;
}

void ContactManifold::finish() {
  if (count_ == 0) {
    manifold_.setNumContacts(0);
    return;
  }
  reduce();
  const btCollisionObject* a = manifold_.getBody0();
  const btCollisionObject* b = manifold_.getBody1();
  btManifoldPoint old[kMostKept];
  bool used[kMostKept] = {};
  const int old_count = std::min(manifold_.getNumContacts(), kMostKept);
  for (int i = 0; i < old_count; ++i) old[i] = manifold_.getContactPoint(i);
  manifold_.setNumContacts(count_);
  const btScalar friction = btManifoldResult::calculateCombinedFriction(a, b);
  const btScalar restitution = btManifoldResult::calculateCombinedRestitution(a, b);
  const btScalar rolling = btManifoldResult::calculateCombinedRollingFriction(a, b);
  const btScalar spinning = btManifoldResult::calculateCombinedSpinningFriction(a, b);
  const btScalar same = kSamePoint * manifold_.getContactBreakingThreshold();
  for (int i = 0; i < count_; ++i) {
    const btVector3 on_a = at(i).on_b + at(i).normal * at(i).distance;
    btManifoldPoint point(a->getWorldTransform().invXform(on_a), b->getWorldTransform().invXform(at(i).on_b),
                          at(i).normal, at(i).distance);
    point.m_positionWorldOnA = on_a;
    point.m_positionWorldOnB = at(i).on_b;
    point.m_combinedFriction = friction;
    point.m_combinedRestitution = restitution;
    point.m_combinedRollingFriction = rolling;
    point.m_combinedSpinningFriction = spinning;
    point.m_lateralFrictionDir1.setZero();
    point.m_lateralFrictionDir2.setZero();
    int nearest = -1;
    btScalar least = count_ == 1 && old_count == 1 ? BT_LARGE_FLOAT : same * same;
    for (int k = 0; k < old_count; ++k) {
      const btScalar away = std::min((old[k].m_localPointA - point.m_localPointA).length2(),
                                     (old[k].m_localPointB - point.m_localPointB).length2());
      if (!used[k] && away < least) {
        least = away;
        nearest = k;
      }
    }
    if (nearest >= 0) {
      used[nearest] = true;
      inherit(old[nearest], point);
      point.m_lifeTime = old[nearest].m_lifeTime + 1;
    }
    manifold_.getContactPoint(i) = point;
  }
}

void ContactResult::addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b, btScalar depth) {
  btPersistentManifold& manifold = *getPersistentManifold();
  const btCollisionObject* first = m_body0Wrap->getCollisionObject();
  if (manifold.getBody0() != first) first = m_body1Wrap->getCollisionObject();
  btManifoldPoint probe(first->getWorldTransform().invXform(point_on_b + normal_on_b * depth), point_on_b, normal_on_b,
                        depth);
  const int replaced = manifold.getCacheEntry(probe);
  const bool known = replaced >= 0 && depth <= manifold.getContactBreakingThreshold();
  if (known) inherit(manifold.getContactPoint(replaced), probe);
  btManifoldResult::addContactPoint(normal_on_b, point_on_b, depth);
  if (known) inherit(probe, manifold.getContactPoint(replaced));
}

}  // namespace limber

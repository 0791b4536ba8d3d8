// Reduces the contact points of a step to at most four, and transfers impulses from the previous step.
#include "sim/collision/manifold_builder.h"

#include <algorithm>
#include <cmath>

#include "sim/bullet/surface_motion.h"

namespace limber::sim::collision {
namespace {

constexpr int kMaxPoints = 4;
/// Distance (or Bullet's breaking threshold, if smaller) up to which points are contacts even without an approach, m.
constexpr btScalar kContactDistance = 1e-3F;
/// A point must be deeper, farther or wider by more than rounding errors to replace an earlier one, so that the choice
/// among equal points is stable from step to step: m, and relative.
constexpr btScalar kDepthTolerance = 1e-5F;
constexpr btScalar kRelativeMargin = 1.001F;
/// A point matches one of the previous step within this many breaking thresholds.
constexpr btScalar kMatchDistanceFactor = 4;

// Null: a body at rest, because it is static.
const btRigidBody* moving_body(const btCollisionObject* object) {
  return object->isStaticObject() && !bullet::is_moving_static(*object) ? nullptr : btRigidBody::upcast(object);
}

// Upper bound of the speed of the body's points about its center, m/s. Uses the AABB, which is at least as large as the
// part.
btScalar rotation_speed(const btRigidBody& body) {
  const btBroadphaseProxy* box = body.getBroadphaseHandle();
  if (box == nullptr) return 0;
  return std::sqrt(body.getAngularVelocity().length2() * (box->m_aabbMax - box->m_aabbMin).length2());
}

// True if a static body moves so fast that it would pass the other one between two steps: nothing can stop it.
bool must_predict(const btRigidBody* a, const btRigidBody* b, const btVector3& motion) {
  if (a == nullptr || b == nullptr || a->isStaticObject() == b->isStaticObject()) return false;
  const btScalar radius = (a->isStaticObject() ? b : a)->getCcdMotionThreshold();
  return motion.length2() > radius * radius;
}

// Distance from a body up to which its contacts are predicted: its inner radius, which a slow body doesn't exceed in a
// step; unlimited if that isn't set, or if nothing can stop the body.
btScalar prediction_distance(const btRigidBody* body) {
  if (body == nullptr) return 0;
  if (body->isStaticObject()) return BT_LARGE_FLOAT;
  const btScalar radius = body->getCcdMotionThreshold();
  return radius > 0 ? radius : BT_LARGE_FLOAT;
}

// Copies the warm-start data of a contact.
void copy_warm_start(const btManifoldPoint& from, btManifoldPoint& to) {
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

ManifoldBuilder::ManifoldBuilder(btPersistentManifold& manifold, btScalar h)
    : manifold_(manifold),
      a_(moving_body(manifold.getBody0())),
      b_(moving_body(manifold.getBody1())),
      h_(h),
      contact_distance_(std::min(kContactDistance, manifold.getContactBreakingThreshold())),
      max_rotation_distance_(contact_distance_),
      max_distance_(contact_distance_) {
  btVector3 motion(0, 0, 0);
  if (a_ != nullptr) motion -= a_->getLinearVelocity() * h_;
  if (b_ != nullptr) motion += b_->getLinearVelocity() * h_;
  // 0: contacts begin when the surfaces touch; see Part::apply_surface
  const btScalar threshold = must_predict(a_, b_, motion)
                                 ? btScalar(BT_LARGE_FLOAT)
                                 : std::min(manifold.getBody0()->getContactProcessingThreshold(),
                                            manifold.getBody1()->getContactProcessingThreshold());
  manifold_.setContactProcessingThreshold(threshold);
  if (threshold <= 0) return;
  relative_motion_ = motion;
  max_rotation_distance_ +=
      ((a_ != nullptr ? rotation_speed(*a_) : 0) + (b_ != nullptr ? rotation_speed(*b_) : 0)) * h_;
  // beyond that, a predicted contact would deflect bodies that miss each other; see bullet::ContinuousCollision
  const btScalar max_prediction = contact_distance_ + prediction_distance(a_) + prediction_distance(b_);
  max_distance_ = std::min(max_rotation_distance_ + relative_motion_.length(), max_prediction);
}

// Decrease of the distance at a point in the step. Rotation moves points on a circle: without the second-order term a
// fast wheel would be braked by points that never touch.
btScalar ManifoldBuilder::approach(const btVector3& point, const btVector3& normal) const {
  const auto displacement = [&](const btRigidBody& body) {
    const btVector3 arm = point - body.getWorldTransform().getOrigin();
    const btVector3& spin = body.getAngularVelocity();
    const btVector3 turning = spin.cross(arm);
    return normal.dot(body.getLinearVelocity() + turning + spin.cross(turning) * (h_ / 2)) * h_;
  };
  return (b_ != nullptr ? displacement(*b_) : 0) - (a_ != nullptr ? displacement(*a_) : 0);
}

void ManifoldBuilder::add(const btVector3& point_on_b, const btVector3& normal, btScalar distance) {
  if (distance > max_distance_ || count_ == kMaxCandidates) return;
  if (distance > contact_distance_ && distance > contact_distance_ + approach(point_on_b, normal)) return;
  points_[static_cast<std::size_t>(count_++)] = {point_on_b, normal, distance};
}

int ManifoldBuilder::find_deepest() const {
  int best = 0;
  for (int i = 1; i < count_; ++i) {
    if (at(i).distance < at(best).distance - kDepthTolerance) best = i;
  }
  return best;
}

int ManifoldBuilder::find_farthest(int from) const {
  int best = -1;
  btScalar largest = SIMD_EPSILON * SIMD_EPSILON;
  for (int i = 0; i < count_; ++i) {
    const btScalar distance2 = (at(i).on_b - at(from).on_b).length2();
    if (distance2 > largest * kRelativeMargin) {
      largest = distance2;
      best = i;
    }
  }
  return best;
}

// The point farthest from the line through a and b on one side; -1: none that spans an area.
int ManifoldBuilder::find_widest(int a, int b, btScalar side) const {
  const btVector3 line = at(b).on_b - at(a).on_b;
  const btVector3 across = at(a).normal.cross(line) * side;
  int best = -1;
  btScalar largest = line.length2() * 1e-4F;
  for (int i = 0; i < count_; ++i) {
    const btScalar distance = across.dot(at(i).on_b - at(a).on_b);
    if (distance > largest * kRelativeMargin) {
      largest = distance;
      best = i;
    }
  }
  return best;
}

void ManifoldBuilder::reduce() {
  if (count_ <= 1) return;
  int chosen_index[kMaxPoints];
  int count = 0;
  chosen_index[count++] = find_deepest();
  const int far = find_farthest(chosen_index[0]);
  if (far >= 0) {
    chosen_index[count++] = far;
    for (const btScalar side : {btScalar(1), btScalar(-1)}) {
      const int wide = find_widest(chosen_index[0], far, side);
      if (wide >= 0) chosen_index[count++] = wide;
    }
  }
  Point chosen[kMaxPoints];
  for (int i = 0; i < count; ++i) chosen[i] = at(chosen_index[i]);
  for (int i = 0; i < count; ++i) points_[static_cast<std::size_t>(i)] = chosen[i];
  count_ = count;
}

void ManifoldBuilder::write() {
  if (count_ == 0) {
    manifold_.setNumContacts(0);
    return;
  }
  reduce();
  const btCollisionObject* a = manifold_.getBody0();
  const btCollisionObject* b = manifold_.getBody1();
  btManifoldPoint old_points[kMaxPoints];
  bool used[kMaxPoints] = {};
  const int old_count = std::min(manifold_.getNumContacts(), kMaxPoints);
  for (int i = 0; i < old_count; ++i) old_points[i] = manifold_.getContactPoint(i);
  manifold_.setNumContacts(count_);
  const btScalar friction = btManifoldResult::calculateCombinedFriction(a, b);
  const btScalar restitution = btManifoldResult::calculateCombinedRestitution(a, b);
  const btScalar rolling = btManifoldResult::calculateCombinedRollingFriction(a, b);
  const btScalar spinning = btManifoldResult::calculateCombinedSpinningFriction(a, b);
  const btScalar match_distance = kMatchDistanceFactor * manifold_.getContactBreakingThreshold();
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
    // one point that follows one point is the same contact, however far it moved, such as that of a rolling sphere
    btScalar nearest2 = count_ == 1 && old_count == 1 ? BT_LARGE_FLOAT : match_distance * match_distance;
    for (int k = 0; k < old_count; ++k) {
      const btScalar distance2 = std::min((old_points[k].m_localPointA - point.m_localPointA).length2(),
                                          (old_points[k].m_localPointB - point.m_localPointB).length2());
      if (!used[k] && distance2 < nearest2) {
        nearest2 = distance2;
        nearest = k;
      }
    }
    if (nearest >= 0) {
      used[nearest] = true;
      copy_warm_start(old_points[nearest], point);
      point.m_lifeTime = old_points[nearest].m_lifeTime + 1;
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
  const bool replaces = replaced >= 0 && depth <= manifold.getContactBreakingThreshold();
  if (replaces) copy_warm_start(manifold.getContactPoint(replaced), probe);
  btManifoldResult::addContactPoint(normal_on_b, point_on_b, depth);
  if (replaces) copy_warm_start(probe, manifold.getContactPoint(replaced));
}

}  // namespace limber::sim::collision

// Islands at rest are found once a tick, and only when some part has been at rest long enough.
#include "sim/sleep.h"

#include <algorithm>

#include "base/prefetch.h"
#include "sim/dispatcher.h"
#include "sim/joint_constraint.h"

namespace limber {
namespace {

/// m and rad within which a part is at rest. In islands with joints, where parts at rest stay within 2e-7: what turns
/// round at its farthest point leaves this range within kRest if it accelerates by more than 8e-5 m/s² or rad/s².
struct Range {
  btScalar move;
  btScalar turn;
};
constexpr Range kExact{btScalar(1e-5), btScalar(1e-5)};
/// In the others, where the iterative solver lets stacks tremble.
constexpr Range kRough{btScalar(1e-4), btScalar(1e-3)};
constexpr auto kExactRest = static_cast<float>(SleepTracker::kRest);
constexpr auto kRoughRest = static_cast<float>(SleepTracker::kRest / 2);
/// m/s and rad/s above which a part is not at rest, though it may return to its place.
constexpr btScalar kSpeed = btScalar(0.01);
constexpr btScalar kSpin = btScalar(0.1);
/// Manifolds ahead of which memory is requested.
constexpr int kAhead = 8;

bool differs(const btTransform& a, const btTransform& b, const Range& range) {
  if ((a.getOrigin() - b.getOrigin()).length2() > range.move * range.move) return true;
  // a small turn by an angle t changes the three rows by 2·t² in total
  btScalar change = 0;
  for (int i = 0; i < 3; ++i) change += (a.getBasis()[i] - b.getBasis()[i]).length2();
  return change > 2 * range.turn * range.turn;
}

bool moves(const btRigidBody& body) {
  return !(body.getLinearVelocity().length2() <= kSpeed * kSpeed) ||
         !(body.getAngularVelocity().length2() <= kSpin * kSpin);
}

bool still(const btRigidBody& body) {
  return body.getLinearVelocity() == btVector3(0, 0, 0) && body.getAngularVelocity() == btVector3(0, 0, 0);
}

}  // namespace

void SleepTracker::add(btCollisionObject& object) {
  Track track;
  track.exact = track.rough = {object.getWorldTransform(), 0};
  track.group = 0;
  track.may_sleep = false;
  tracks_.push_back(track);
  wanted_.push_back(0);
  if (object.isStaticObject()) object.forceActivationState(ISLAND_SLEEPING);
  ++version_;
  wake(object);
}

void SleepTracker::remove(const btCollisionObject& object) {
  const int index = object.getWorldArrayIndex();
  if (index < 0 || index >= tracks_.size()) return;
  if (sleeping_ > 0 && sleeps(object)) {
    const std::uint32_t group = tracks_[index].group;
    for (int i = 0; i < tracks_.size(); ++i) {
      if (i != index && tracks_[i].group == group && sleeps(*world_.getCollisionObjectArray()[i]))
        wake(*world_.getCollisionObjectArray()[i]);
    }
    --sleeping_;
    ++version_;
  } else if (sleeping_ > 0 && object.isStaticObject()) {
    const btBroadphasePairArray& pairs = world_.getPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
      const auto* a = static_cast<const btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject);
      const auto* b = static_cast<const btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject);
      if (a == &object) wake(*b);
      if (b == &object) wake(*a);
    }
  }
  // the world moves its last object into the free place
  const int last = tracks_.size() - 1;
  tracks_[index] = tracks_[last];
  wanted_[index] = wanted_[last];
  tracks_.pop_back();
  wanted_.pop_back();
}

void SleepTracker::allow(btCollisionObject& object, bool may_sleep) {
  const int index = object.getWorldArrayIndex();
  if (index < 0 || index >= tracks_.size() || tracks_[index].may_sleep == may_sleep) return;
  tracks_[index].may_sleep = may_sleep;
  wake(object);
}

bool SleepTracker::waking(const btCollisionObject& object) const {
  const int index = object.getWorldArrayIndex();
  return index >= 0 && index < wanted_.size() && wanted_[index] != 0;
}

void SleepTracker::cancel(const btCollisionObject& object) {
  const int index = object.getWorldArrayIndex();
  if (index >= 0 && index < wanted_.size()) wanted_[index] = 0;
}

void SleepTracker::rouse(int index, bool mid_tick) {
  btCollisionObject& object = *world_.getCollisionObjectArray()[index];
  object.forceActivationState(DISABLE_DEACTIVATION);
  restart(tracks_[index]);
  if (mid_tick) btRigidBody::upcast(&object)->applyGravity();
  --sleeping_;
  ++version_;
}

void SleepTracker::wake_all() {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < tracks_.size(); ++i) {
    if (sleeps(*objects[i])) rouse(i, false);
    restart(tracks_[i]);
  }
}

// Wakes all that sleep in one of groups_.
bool SleepTracker::rouse_groups(bool mid_tick) {
  if (groups_.size() == 0) return false;
  std::uint32_t* const first = &groups_[0];
  std::sort(first, first + groups_.size());
  std::uint32_t* const last = std::unique(first, first + groups_.size());
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < tracks_.size(); ++i) {
    if (sleeps(*objects[i]) && std::binary_search(first, last, tracks_[i].group)) rouse(i, mid_tick);
  }
  groups_.resizeNoInitialize(0);
  return true;
}

bool SleepTracker::apply_wakes(bool mid_tick) {
  if (!any_wanted_.load(std::memory_order_relaxed)) return false;
  any_wanted_.store(false, std::memory_order_relaxed);
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  groups_.resizeNoInitialize(0);
  bool moved = false;
  for (int i = 0; i < wanted_.size(); ++i) {
    if (wanted_[i] == 0) continue;
    btCollisionObject& object = *objects[i];
    if (object.isStaticObject()) {
      if (!object.isActive()) {
        object.forceActivationState(ACTIVE_TAG);
        moved_.push_back(i);
      }
      moved = true;
    } else if (sleeps(object)) {
      want(object);
    }
    restart(tracks_[i]);
  }
  if (moved && sleeping_ > 0) {
    const auto pass_on = [&](const btCollisionObject& a, const btCollisionObject& b) {
      if (a.isStaticObject() && a.isActive() && sleeps(b)) want(b);
      if (b.isStaticObject() && b.isActive() && sleeps(a)) want(a);
    };
    const btBroadphasePairArray& pairs = world_.getPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
      pass_on(*static_cast<const btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject),
              *static_cast<const btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject));
    }
    for (int i = 0; i < world_.getNumConstraints(); ++i) {
      pass_on(world_.getConstraint(i)->getRigidBodyA(), world_.getConstraint(i)->getRigidBodyB());
    }
  }
  std::fill_n(&wanted_[0], wanted_.size(), std::uint8_t{0});
  return rouse_groups(mid_tick);
}

bool SleepTracker::wake_touched(bool mid_tick) {
  if (sleeping_ == 0) return false;
  groups_.resizeNoInitialize(0);
  btDispatcher& dispatcher = *world_.getDispatcher();
  const int count = dispatcher.getNumManifolds();
  for (int i = 0; i < count; ++i) {
    if (i + kAhead < count) prefetch_end(*dispatcher.getManifoldByIndexInternal(i + kAhead));
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    const btCollisionObject& a = *manifold.getBody0();
    const btCollisionObject& b = *manifold.getBody1();
    if (a.isActive() == b.isActive()) continue;
    if (sleeps(a)) want(a);
    if (sleeps(b)) want(b);
  }
  return rouse_groups(mid_tick);
}

void SleepTracker::end_step() {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < moved_.size(); ++i) objects[moved_[i]]->forceActivationState(ISLAND_SLEEPING);
  moved_.resizeNoInitialize(0);
}

void SleepTracker::observe(const btRigidBody& body, btScalar seconds) {
  Track& track = tracks_[body.getWorldArrayIndex()];
  if (!track.may_sleep) return;
  const bool fast = moves(body);
  const auto watch = [&](Rest& rest, const Range& range) {
    if (fast || differs(body.getWorldTransform(), rest.pose, range)) {
      rest = {body.getWorldTransform(), 0};
    } else {
      rest.seconds += static_cast<float>(seconds);
    }
  };
  watch(track.exact, kExact);
  watch(track.rough, kRough);
  if (track.rough.seconds >= kRoughRest && !any_rested_.load(std::memory_order_relaxed))
    any_rested_.store(true, std::memory_order_relaxed);
}

int SleepTracker::root_of(int place) {
  while (above_[place] != place) place = above_[place] = above_[above_[place]];
  return place;
}

void SleepTracker::unite(int a, int b) {
  if (a >= 0 && b >= 0) above_[root_of(a)] = root_of(b);
}

bool SleepTracker::end_tick(const Awake& awake) {
  if (!any_rested_.load(std::memory_order_relaxed)) return false;
  any_rested_.store(false, std::memory_order_relaxed);
  const int count = awake.parts.size();
  find_islands(awake);
  for (int i = 0; i < count; ++i) {
    const Track& track = tracks_[awake.parts[i]->getWorldArrayIndex()];
    const int root = root_of(i);
    const bool at_rest = jointed_[root] != 0 ? track.exact.seconds >= kExactRest : track.rough.seconds >= kRoughRest;
    const bool rests = track.may_sleep && at_rest;
    if (!rests || (supported_[root] == 0 && !still(*awake.parts[i]))) driven_[root] = 1;
  }
  const int before = sleeping_;
  group_of_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) group_of_[i] = 0;
  for (int i = 0; i < count; ++i) {
    const int root = root_of(i);
    if (driven_[root] != 0) continue;
    if (group_of_[root] == 0) group_of_[root] = ++last_group_;
    btRigidBody& body = *awake.parts[i];
    tracks_[body.getWorldArrayIndex()].group = group_of_[root];
    body.forceActivationState(ISLAND_SLEEPING);
    body.setLinearVelocity(btVector3(0, 0, 0));
    body.setAngularVelocity(btVector3(0, 0, 0));
    body.setInterpolationLinearVelocity(btVector3(0, 0, 0));
    body.setInterpolationAngularVelocity(btVector3(0, 0, 0));
    body.clearForces();
    ++sleeping_;
  }
  if (sleeping_ == before) return false;
  ++version_;
  for (int i = 0; i < awake.joints.size(); ++i) {
    const btTypedConstraint& joint = *awake.joints[i];
    if (!sleeps(joint.getRigidBodyA()) && !sleeps(joint.getRigidBodyB())) continue;
    if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(*awake.joints[i]).refresh();
  }
  return true;
}

// Unites what touches or is joined, and notes which islands are supported and which have a motor that commands a
// motion.
void SleepTracker::find_islands(const Awake& awake) {
  const int count = awake.parts.size();
  above_.resizeNoInitialize(count);
  supported_.resizeNoInitialize(count);
  jointed_.resizeNoInitialize(count);
  driven_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) {
    above_[i] = i;
    supported_[i] = jointed_[i] = driven_[i] = 0;
  }
  const auto place_of = [&](const btCollisionObject& object) { return awake.places[object.getWorldArrayIndex()]; };
  const auto each_link = [&](auto&& link) {
    btDispatcher& dispatcher = *world_.getDispatcher();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
      if (manifold.getNumContacts() > 0) link(place_of(*manifold.getBody0()), place_of(*manifold.getBody1()));
    }
    for (int i = 0; i < awake.joints.size(); ++i) {
      link(place_of(awake.joints[i]->getRigidBodyA()), place_of(awake.joints[i]->getRigidBodyB()));
    }
  };
  each_link([this](int a, int b) { unite(a, b); });
  each_link([this](int a, int b) {
    if ((a < 0) != (b < 0)) supported_[root_of(std::max(a, b))] = 1;
  });
  for (int i = 0; i < awake.joints.size(); ++i) {
    const btTypedConstraint& joint = *awake.joints[i];
    const int place = std::max(place_of(joint.getRigidBodyA()), place_of(joint.getRigidBodyB()));
    if (place < 0) continue;
    jointed_[root_of(place)] = 1;
    if (joint.getConstraintType() != JointConstraint::kType) continue;
    if (static_cast<const JointConstraint&>(joint).commands_motion()) driven_[root_of(place)] = 1;
  }
}

}  // namespace limber

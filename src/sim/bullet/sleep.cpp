// SleepTracker: islands at rest are determined once per tick, and only if a part has been at rest long enough.
#include "sim/bullet/sleep.h"

#include <algorithm>

#include "base/memory/prefetch.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/bullet/joints/tendon_constraint.h"
#include "sim/collision/dispatcher.h"

namespace limber::sim::bullet {
namespace {

/// Distance from its rest pose, m and rad, within which a part counts as at rest.
struct RestTolerance {
  btScalar distance;
  btScalar angle;
};
/// For islands with joints, where resting parts stay within 2e-7 m and rad. A part at a turning
/// point with an acceleration above 8e-5 m/s² or rad/s² isn't considered at rest: within kTimeToSleep it leaves this
/// range.
constexpr RestTolerance kJointedTolerance{btScalar(1e-5), btScalar(1e-5)};
/// For other islands, since stacks jitter in the iterative solver.
constexpr RestTolerance kOtherTolerance{btScalar(1e-4), btScalar(1e-3)};
constexpr auto kJointedRest = static_cast<float>(SleepTracker::kTimeToSleep);
constexpr auto kOtherRest = static_cast<float>(SleepTracker::kTimeToSleep / 2);
/// Speeds, m/s and rad/s, above which a part is not at rest, even if it is near its rest pose.
constexpr btScalar kMaxRestSpeed = btScalar(0.01);
constexpr btScalar kMaxRestSpin = btScalar(0.1);
/// Prefetch distance, in manifolds.
constexpr int kAhead = 8;

bool differs(const btTransform& a, const btTransform& b, const RestTolerance& tolerance) {
  if ((a.getOrigin() - b.getOrigin()).length2() > tolerance.distance * tolerance.distance) return true;
  // a small rotation by an angle t changes the three rows by 2·t² in total
  btScalar change = 0;
  for (int i = 0; i < 3; ++i) change += (a.getBasis()[i] - b.getBasis()[i]).length2();
  return change > 2 * tolerance.angle * tolerance.angle;
}

bool is_moving(const btRigidBody& body) {
  return !(body.getLinearVelocity().length2() <= kMaxRestSpeed * kMaxRestSpeed) ||
         !(body.getAngularVelocity().length2() <= kMaxRestSpin * kMaxRestSpin);
}

bool is_motionless(const btRigidBody& body) {
  return body.getLinearVelocity() == btVector3(0, 0, 0) && body.getAngularVelocity() == btVector3(0, 0, 0);
}

}  // namespace

void SleepTracker::add(btCollisionObject& object) {
  Track track;
  track.with_joints = track.without_joints = {object.getWorldTransform(), 0};
  track.group = 0;
  track.may_sleep = false;
  tracks_.push_back(track);
  wake_requested_.push_back(0);
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
  // the world moves its last object to the free index
  const int last = tracks_.size() - 1;
  tracks_[index] = tracks_[last];
  wake_requested_[index] = wake_requested_[last];
  tracks_.pop_back();
  wake_requested_.pop_back();
}

void SleepTracker::allow(btCollisionObject& object, bool may_sleep) {
  const int index = object.getWorldArrayIndex();
  if (index < 0 || index >= tracks_.size() || tracks_[index].may_sleep == may_sleep) return;
  tracks_[index].may_sleep = may_sleep;
  wake(object);
}

bool SleepTracker::wake_requested(const btCollisionObject& object) const {
  const int index = object.getWorldArrayIndex();
  return index >= 0 && index < wake_requested_.size() && wake_requested_[index] != 0;
}

void SleepTracker::cancel_wake(const btCollisionObject& object) {
  const int index = object.getWorldArrayIndex();
  if (index >= 0 && index < wake_requested_.size()) wake_requested_[index] = 0;
}

void SleepTracker::wake_body(int index, bool mid_tick) {
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
    if (sleeps(*objects[i])) wake_body(i, false);
    restart(tracks_[i]);
  }
}

// Wakes all bodies that sleep in one of groups_.
bool SleepTracker::wake_groups(bool mid_tick) {
  if (groups_.size() == 0) return false;
  std::uint32_t* const first = &groups_[0];
  std::sort(first, first + groups_.size());
  std::uint32_t* const last = std::unique(first, first + groups_.size());
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < tracks_.size(); ++i) {
    if (sleeps(*objects[i]) && std::binary_search(first, last, tracks_[i].group)) wake_body(i, mid_tick);
  }
  groups_.resizeNoInitialize(0);
  return true;
}

bool SleepTracker::execute_wakes(bool mid_tick) {
  if (!any_wake_requested_.load(std::memory_order_relaxed)) return false;
  any_wake_requested_.store(false, std::memory_order_relaxed);
  groups_.resizeNoInitialize(0);
  const bool moved = handle_requests();
  if (moved && sleeping_ > 0) queue_touched_by_moved();
  std::fill_n(&wake_requested_[0], wake_requested_.size(), std::uint8_t{0});
  return wake_groups(mid_tick);
}

// Handles the objects to be woken: activates static ones, queues the groups of sleeping ones. Returns true if one of
// them is static.
bool SleepTracker::handle_requests() {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  bool moved = false;
  for (int i = 0; i < wake_requested_.size(); ++i) {
    if (wake_requested_[i] == 0) continue;
    btCollisionObject& object = *objects[i];
    if (object.isStaticObject()) {
      if (!object.isActive()) {
        object.forceActivationState(ACTIVE_TAG);
        moved_.push_back(i);
      }
      moved = true;
    } else if (sleeps(object)) {
      queue_group(object);
    }
    restart(tracks_[i]);
  }
  return moved;
}

void SleepTracker::queue_touched_by_moved() {
  const auto queue_if_touched = [&](const btCollisionObject& a, const btCollisionObject& b) {
    if (a.isStaticObject() && a.isActive() && sleeps(b)) queue_group(b);
    if (b.isStaticObject() && b.isActive() && sleeps(a)) queue_group(a);
  };
  const btBroadphasePairArray& pairs = world_.getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    queue_if_touched(*static_cast<const btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject),
                     *static_cast<const btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject));
  }
  for (int i = 0; i < world_.getNumConstraints(); ++i) {
    for_each_link(*world_.getConstraint(i), queue_if_touched);
  }
}

bool SleepTracker::wake_touched(bool mid_tick) {
  if (sleeping_ == 0) return false;
  groups_.resizeNoInitialize(0);
  btDispatcher& dispatcher = *world_.getDispatcher();
  const int count = dispatcher.getNumManifolds();
  for (int i = 0; i < count; ++i) {
    if (i + kAhead < count) collision::prefetch_end(*dispatcher.getManifoldByIndexInternal(i + kAhead));
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    const btCollisionObject& a = *manifold.getBody0();
    const btCollisionObject& b = *manifold.getBody1();
    if (a.isActive() == b.isActive()) continue;
    if (sleeps(a)) queue_group(a);
    if (sleeps(b)) queue_group(b);
  }
  return wake_groups(mid_tick);
}

void SleepTracker::end_substep() {
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < moved_.size(); ++i) objects[moved_[i]]->forceActivationState(ISLAND_SLEEPING);
  moved_.resizeNoInitialize(0);
}

void SleepTracker::observe(const btRigidBody& body, btScalar seconds) {
  Track& track = tracks_[body.getWorldArrayIndex()];
  if (!track.may_sleep) return;
  const bool fast = is_moving(body);
  const auto update = [&](RestPose& rest_pose, const RestTolerance& tolerance) {
    if (fast || differs(body.getWorldTransform(), rest_pose.pose, tolerance)) {
      rest_pose = {body.getWorldTransform(), 0};
    } else {
      rest_pose.seconds += static_cast<float>(seconds);
    }
  };
  update(track.with_joints, kJointedTolerance);
  update(track.without_joints, kOtherTolerance);
  if (track.without_joints.seconds >= kOtherRest && !any_rested_.load(std::memory_order_relaxed))
    any_rested_.store(true, std::memory_order_relaxed);
}

bool SleepTracker::end_tick(const AwakeObjects& awake) {
  if (!any_rested_.load(std::memory_order_relaxed)) return false;
  any_rested_.store(false, std::memory_order_relaxed);
  find_islands(awake);
  find_restless(awake);
  const int before = sleeping_;
  const int count = awake.bodies().size();
  group_of_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) group_of_[i] = 0;
  for (int i = 0; i < count; ++i) {
    const int root = connected_.root(i);
    if (forced_awake_[root] != 0) continue;
    if (group_of_[root] == 0) group_of_[root] = ++last_group_;
    put_to_sleep(*awake.bodies()[i], group_of_[root]);
  }
  if (sleeping_ == before) return false;
  ++version_;
  for (int i = 0; i < awake.joints().size(); ++i) {
    btTypedConstraint& joint = *awake.joints()[i];
    if (!sleeps(joint.getRigidBodyA()) && !sleeps(joint.getRigidBodyB())) continue;
    if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).refresh();
  }
  return true;
}

// Forces the islands of parts that are not at rest to stay awake.
void SleepTracker::find_restless(const AwakeObjects& awake) {
  for (int i = 0; i < awake.bodies().size(); ++i) {
    const btRigidBody& body = *awake.bodies()[i];
    const Track& track = tracks_[body.getWorldArrayIndex()];
    const int root = connected_.root(i);
    const bool at_rest =
        jointed_[root] != 0 ? track.with_joints.seconds >= kJointedRest : track.without_joints.seconds >= kOtherRest;
    const bool rests = track.may_sleep && at_rest;
    if (!rests || (supported_[root] == 0 && !is_motionless(body))) forced_awake_[root] = 1;
  }
}

void SleepTracker::put_to_sleep(btRigidBody& body, std::uint32_t group) {
  tracks_[body.getWorldArrayIndex()].group = group;
  body.forceActivationState(ISLAND_SLEEPING);
  body.setLinearVelocity(btVector3(0, 0, 0));
  body.setAngularVelocity(btVector3(0, 0, 0));
  body.setInterpolationLinearVelocity(btVector3(0, 0, 0));
  body.setInterpolationAngularVelocity(btVector3(0, 0, 0));
  body.clearForces();
  ++sleeping_;
}

// Unites objects that touch or are joined, and determines which islands are supported and which have a motor that
// commands a motion.
void SleepTracker::find_islands(const AwakeObjects& awake) {
  const int count = awake.bodies().size();
  connected_.reset(count);
  supported_.resizeNoInitialize(count);
  jointed_.resizeNoInitialize(count);
  forced_awake_.resizeNoInitialize(count);
  for (int i = 0; i < count; ++i) supported_[i] = jointed_[i] = forced_awake_[i] = 0;
  const auto for_each_link = [&](auto&& link) {
    btDispatcher& dispatcher = *world_.getDispatcher();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
      if (manifold.getNumContacts() > 0)
        link(awake.index_of(*manifold.getBody0()), awake.index_of(*manifold.getBody1()));
    }
    for (int i = 0; i < awake.joints().size(); ++i) {
      bullet::for_each_link(*awake.joints()[i], [&](const btRigidBody& a, const btRigidBody& b) {
        link(awake.index_of(a), awake.index_of(b));
      });
    }
  };
  for_each_link([this](int a, int b) { connected_.unite(a, b); });
  for_each_link([this](int a, int b) {
    if ((a < 0) != (b < 0)) supported_[connected_.root(std::max(a, b))] = 1;
  });
  for (int i = 0; i < awake.joints().size(); ++i) {
    const btTypedConstraint& joint = *awake.joints()[i];
    const int index = awake.body_of_joint(i);
    if (index < 0) continue;
    jointed_[connected_.root(index)] = 1;
    if (joint.getConstraintType() != JointConstraint::kType) continue;
    if (static_cast<const JointConstraint&>(joint).commands_motion()) forced_awake_[connected_.root(index)] = 1;
  }
}

}  // namespace limber::sim::bullet

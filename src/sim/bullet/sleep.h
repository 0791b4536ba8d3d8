// SleepTracker: detects islands at rest, which steps then skip, and wakes them on any influence. [sim]
#pragma once

#include <atomic>
#include <cstdint>

#include "sim/bullet/awake_objects.h"
#include "sim/bullet/bullet.h"
#include "sim/bullet/union_find.h"

namespace limber::sim::bullet {

/// An island (parts that touch or are joined) falls asleep at the end of a tick when it has been at rest for
/// kTimeToSleep, or half of it without joints: none of its parts left its pose, no force acted, no property changed,
/// and no motor commanded a motion. A sleeping island has no velocity, its contacts retain their impulses and its
/// joints their readouts. Islands that neither touch nor are joined to a static object sleep only if they don't move at
/// all, since nothing brings them to rest.
///
/// btCollisionObject::isActive() is true for awake objects; static objects are active only in a step in which they were
/// moved. Objects are identified by their index in the world's array. Decisions depend only on an island's own history,
/// never on threads. Persistent data is allocated in the memory of the present BulletMemory::Scope.
class SleepTracker {
 public:
  /// Simulated time, s, for which an island must be at rest; half of it without joints.
  static constexpr double kTimeToSleep = 1;

  explicit SleepTracker(btDiscreteDynamicsWorld& world) : world_(world) {}

  /// Call after an object was added to the world. It can't sleep before allow() permits it.
  void add(btCollisionObject& object);
  /// Call before an object is removed: its island and objects that touch it wake in the next step.
  void remove(const btCollisionObject& object);
  /// Sets whether the object permits its island to sleep.
  void allow(btCollisionObject& object, bool may_sleep);

  /// Wakes the object and its island in the next substep and restarts its time at rest. If the object is static, wakes
  /// the objects that touch it or are joined to it instead. [any]
  void wake(const btCollisionObject& object) {
    const int i = object.getWorldArrayIndex();
    if (i < 0 || i >= wake_requested_.size()) return;
    std::atomic_ref<std::uint8_t>(wake_requested_[i]).store(1, std::memory_order_relaxed);
    any_wake_requested_.store(true, std::memory_order_relaxed);
  }
  /// True if wake() was called for the object since the last substep and not canceled.
  bool wake_requested(const btCollisionObject& object) const;
  void cancel_wake(const btCollisionObject& object);
  bool any_wake_requested() const { return any_wake_requested_.load(std::memory_order_relaxed); }
  /// Wakes everything at once.
  void wake_all();

  /// Executes wake() calls. `mid_tick`: gravity has been applied in this tick already. Returns true if something woke.
  bool execute_wakes(bool mid_tick);
  /// Wakes islands that an awake object touches. Call after contacts were found. Returns true if something woke.
  bool wake_touched(bool mid_tick);
  /// Ends a substep: static objects that were moved in it are inactive again.
  void end_substep();

  /// Compares the part's pose with its rest pose. Call in a tick's last substep, after the part has moved.
  /// `seconds`: length of the tick. [any, each thread for other parts]
  void observe(const btRigidBody& body, btScalar seconds);
  /// Ends a tick: puts islands at rest to sleep. Returns true if one fell asleep.
  bool end_tick(const AwakeObjects& awake);

  int sleeping() const { return sleeping_; }
  /// Changes whenever a part falls asleep, wakes or is added.
  std::uint64_t version() const { return version_; }

 private:
  struct RestPose {
    btTransform pose;  // pose at which it came to rest
    float seconds;     // time at rest
  };
  struct Track {
    RestPose with_joints;     // with the tolerance for islands with joints
    RestPose without_joints;  // with the tolerance for other islands
    std::uint32_t group;      // identifies the island that it sleeps with
    bool may_sleep;
  };
  static void restart(Track& track) { track.with_joints.seconds = track.without_joints.seconds = 0; }
  bool sleeps(const btCollisionObject& object) const { return !object.isActive() && !object.isStaticObject(); }
  void queue_group(const btCollisionObject& object) { groups_.push_back(tracks_[object.getWorldArrayIndex()].group); }
  bool handle_requests();
  void queue_touched_by_moved();
  bool wake_groups(bool mid_tick);
  void wake_body(int index, bool mid_tick);
  void find_islands(const AwakeObjects& awake);
  void find_restless(const AwakeObjects& awake);
  void put_to_sleep(btRigidBody& body, std::uint32_t group);

  btDiscreteDynamicsWorld& world_;
  btAlignedObjectArray<Track> tracks_;                 // by object
  btAlignedObjectArray<std::uint8_t> wake_requested_;  // by object: to be woken
  std::atomic<bool> any_wake_requested_{false};
  std::atomic<bool> any_rested_{false};
  int sleeping_ = 0;
  std::uint32_t last_group_ = 0;
  std::uint64_t version_ = 1;
  // scratch
  btAlignedObjectArray<std::uint32_t> groups_;  // to be woken
  btAlignedObjectArray<int> moved_;             // static objects that are active in this step
  UnionFind connected_;                         // awake parts that touch or are joined
  btAlignedObjectArray<std::uint8_t> supported_;
  btAlignedObjectArray<std::uint8_t> jointed_;
  btAlignedObjectArray<std::uint8_t> forced_awake_;  // by root: something keeps it awake
  btAlignedObjectArray<std::uint32_t> group_of_;
};

}  // namespace limber::sim::bullet

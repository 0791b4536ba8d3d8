// SleepTracker: decides which islands are at rest, so that steps skip them, and wakes them on any influence. [sim]
#pragma once

#include <atomic>
#include <cstdint>

#include "sim/bullet.h"

namespace limber {

/// An island (parts that touch or are joined) falls asleep at the end of a tick when, for half of kRest, with joints
/// for kRest, no part of it left its place, no force acted, no property changed, and no motor commands a motion. It has
/// no velocity while it sleeps, its contacts keep their impulses and its joints their readouts. Islands that neither
/// touch nor are joined to a static object sleep only when they do not move at all, since nothing brings them to rest.
///
/// btCollisionObject::isActive() tells whether an object is awake; static objects are active only in a step in which
/// they were moved. Objects are known by their index in the world's array. Decisions depend on an island's own history
/// alone, never on threads. All that it remembers lies in the memory of the BulletMemory::Scope it is used in.
class SleepTracker {
 public:
  /// s of simulated time for which an island must be at rest; half of it without joints.
  static constexpr double kRest = 1;

  explicit SleepTracker(btDiscreteDynamicsWorld& world) : world_(world) {}

  /// An object was added to the world. It may not sleep until allow() says so.
  void add(btCollisionObject& object);
  /// An object is about to be removed: its island and what touches it wake in the next step.
  void remove(const btCollisionObject& object);
  /// Whether the object's island may sleep as far as this object is concerned.
  void allow(btCollisionObject& object, bool may_sleep);

  /// From the next internal step on, the object is awake with its island, and its time at rest starts over; of a static
  /// object: what touches it or is joined to it. [any thread]
  void wake(const btCollisionObject& object) {
    const int i = object.getWorldArrayIndex();
    if (i < 0 || i >= wanted_.size()) return;
    std::atomic_ref<std::uint8_t>(wanted_[i]).store(1, std::memory_order_relaxed);
    any_wanted_.store(true, std::memory_order_relaxed);
  }
  /// Whether wake() was called for the object since the last internal step; cancel() takes that back.
  bool waking(const btCollisionObject& object) const;
  void cancel(const btCollisionObject& object);
  bool any_waking() const { return any_wanted_.load(std::memory_order_relaxed); }
  /// Everything is awake at once.
  void wake_all();

  /// Carries out wake(). `mid_tick`: gravity has been applied in this tick already. Returns whether something woke.
  bool apply_wakes(bool mid_tick);
  /// After contacts were found: wakes islands that something awake touches. Returns whether something woke.
  bool wake_touched(bool mid_tick);
  /// Ends an internal step.
  void end_step();

  /// In a tick's last internal step, once the part has moved: compares its pose with where it came to rest. `seconds`:
  /// of the tick. [any thread, each another part]
  void observe(const btRigidBody& body, btScalar seconds);
  /// What is awake: by object its place among the parts, negative for all others; the parts; joints between them.
  struct Awake {
    const btAlignedObjectArray<int>& places;
    const btAlignedObjectArray<btRigidBody*>& parts;
    const btAlignedObjectArray<btTypedConstraint*>& joints;
  };
  /// Ends a tick: puts islands at rest to sleep. Returns whether one fell asleep.
  bool end_tick(const Awake& awake);

  int sleeping() const { return sleeping_; }
  /// Changes whenever a part fell asleep, woke or was added.
  std::uint64_t version() const { return version_; }

 private:
  struct Rest {
    btTransform pose;  // where it came to rest
    float seconds;     // for which it has been there
  };
  struct Track {
    Rest exact;           // what counts in islands with joints
    Rest rough;           // what counts in the others
    std::uint32_t group;  // of the island that it sleeps with
    bool may_sleep;
  };
  static void restart(Track& track) { track.exact.seconds = track.rough.seconds = 0; }
  bool sleeps(const btCollisionObject& object) const { return !object.isActive() && !object.isStaticObject(); }
  void want(const btCollisionObject& object) { groups_.push_back(tracks_[object.getWorldArrayIndex()].group); }
  bool rouse_groups(bool mid_tick);
  void rouse(int index, bool mid_tick);
  int root_of(int place);
  void unite(int a, int b);
  void find_islands(const Awake& awake);

  btDiscreteDynamicsWorld& world_;
  btAlignedObjectArray<Track> tracks_;         // by object
  btAlignedObjectArray<std::uint8_t> wanted_;  // by object: to be woken
  std::atomic<bool> any_wanted_{false};
  std::atomic<bool> any_rested_{false};
  int sleeping_ = 0;
  std::uint32_t last_group_ = 0;
  std::uint64_t version_ = 1;
  // scratch
  btAlignedObjectArray<std::uint32_t> groups_;  // to be woken
  btAlignedObjectArray<int> moved_;             // static objects that are active in this step
  btAlignedObjectArray<int> above_;             // by place: union-find
  btAlignedObjectArray<std::uint8_t> supported_;
  btAlignedObjectArray<std::uint8_t> jointed_;
  btAlignedObjectArray<std::uint8_t> driven_;  // by root: something keeps it awake
  btAlignedObjectArray<std::uint32_t> group_of_;
};

}  // namespace limber

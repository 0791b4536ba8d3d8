// WorldTransaction: the rollback log of a guarded script call; rolls back the call's changes to the world if it fails.
// The store logs property values; this class logs other fields, forces, and objects that were added or removed. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/id.h"

namespace limber::sim {

class Body;
class Gear;
class Part;
class Shape;
class Tendon;
class World;

/// Requests to the owner of a scene, which fulfills them between two ticks.
struct WorldRequests {
  bool reset = false;
  bool panic = false;
  bool panic_end = false;
  /// Requests the end of a panic, and cancels an earlier request for one in the same tick.
  void end_panic() {
    panic = false;
    panic_end = true;
  }
  bool operator==(const WorldRequests&) const = default;
};

class WorldTransaction {
 public:
  explicit WorldTransaction(World& world);
  ~WorldTransaction();
  WorldTransaction(const WorldTransaction&) = delete;
  WorldTransaction& operator=(const WorldTransaction&) = delete;

  /// Starts logging, until commit() or rollback(). Allocates only while the logs grow.
  void begin();
  /// The call succeeded: keeps its changes and destroys the objects that it removed.
  void commit();
  /// The call failed: restores the world to its state at begin(), bit for bit. Added objects are removed, newest
  /// first.
  void rollback();
  bool active() const { return active_; }
  /// True if nothing was logged since begin(), so there is nothing to roll back.
  bool is_empty() const;

  /// Returns true at the first use of `saved_in_call` in a guarded call, and stores the number of the call in it; false
  /// outside of guarded calls.
  bool first_in_call(std::uint64_t& saved_in_call) const {
    return active_ && std::exchange(saved_in_call, call_) != call_;
  }
  /// Saves the values of fields, which must not move in memory until the call ends. Call before a change.
  template <class... T>
  requires(std::is_trivially_copyable_v<T>&&...) void save_fields(T&... fields) {
    if (active_) (save_bytes(&fields, sizeof fields), ...);
  }
  /// Saves the pending forces of a part. Call before a change, within a call.
  void save_forces(const Part& part);
  /// Saves nothing of a compound but the number of its children. Call before adding one.
  void save(Shape& shape);
  /// Saves Bullet's pose and velocity of a part. Call before its pending changes are applied ahead of the next step.
  void save_motion(Part& part);
  /// Removes the object at `index` of its list, and hides it until the call ends.
  void hide(std::vector<std::unique_ptr<Body>>& list, std::size_t index);
  void hide(std::vector<std::unique_ptr<Gear>>& list, std::size_t index);
  void hide(std::vector<std::unique_ptr<Tendon>>& list, std::size_t index);

  /// Logs that an object was added to the end of its list.
  template <class T>
  void record_added(std::vector<std::unique_ptr<T>>& list) {
    record([](void* objects, std::size_t) { static_cast<std::vector<std::unique_ptr<T>>*>(objects)->pop_back(); },
           &list);
  }
  /// Logs any other change. rollback() calls the logged functions from newest to oldest.
  using UndoFunction = void (*)(void* owner, std::size_t value);
  void record(UndoFunction undo, void* owner, std::size_t value = 0);

 private:
  struct Entry {
    UndoFunction undo;  // null: `owner` is a field, whose bytes were saved from index `value` on
    void* owner;
    std::size_t value;
  };
  struct SavedForces;
  struct SavedMotion;
  template <class T>
  struct Hidden;
  void save_bytes(void* field, std::size_t size);
  template <auto kHidden, class T>
  void hide_in(std::vector<std::unique_ptr<T>>& list, std::size_t index);
  template <class T>
  void destroy(std::vector<Hidden<T>>& hidden);

  World& world_;
  bool active_ = false;
  WorldRequests requests_;
  std::uint64_t call_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::byte> saved_bytes_;
  std::vector<SavedForces> forces_;
  std::vector<SavedMotion> motions_;
  std::vector<Hidden<Body>> hidden_bodies_;
  std::vector<Hidden<Gear>> hidden_gears_;  // destroyed before the bodies, like the tendons
  std::vector<Hidden<Tendon>> hidden_tendons_;
};

}  // namespace limber::sim

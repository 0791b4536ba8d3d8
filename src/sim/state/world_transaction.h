// WorldTransaction: the undo log of a guarded script call; rolls back the call's changes to the world if it fails. The
// store logs property values; this class logs forces, and objects that were added or removed. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "sim/visuals/camera_motion.h"

namespace limber {

class Body;
class Gear;
class Part;
class Shape;
class World;

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

  /// Save the pending forces of a part, and the state of a body that isn't in its properties. Call before a change.
  void save(Part& part);
  void save(Body& body);
  /// Saves the state of the camera moves. Call before a change.
  void save(CameraMoves& camera_moves);
  /// Saves the number of children of a compound. Call before adding one.
  void save(Shape& shape);
  /// Saves Bullet's pose and velocity of a part. Call before its pending changes are applied ahead of the next step.
  void save_motion(Part& part);
  // Log that the last element of the list was added.
  void body_added();
  void gear_added();
  void shape_added();
  void part_added(Body& body);
  void joint_added(Body& body);
  void motor_added(Body& body);
  /// Hides a removed body or gear, which was at `index` of its list, until the call ends.
  void hide(std::unique_ptr<Body> body, std::size_t index);
  void hide(std::unique_ptr<Gear> gear, std::size_t index);

  /// Logs a change made by another module. rollback() calls the logged functions from newest to oldest.
  using UndoFunction = void (*)(void* owner, std::size_t value);
  void record(UndoFunction undo, void* owner, std::size_t value = 0);

 private:
  struct Entry {
    UndoFunction undo;
    void* owner;
    std::size_t value;
  };
  struct SavedForces;
  struct SavedBody;
  struct SavedMotion;
  struct HiddenBody;
  struct HiddenGear;
  bool first_in_call(std::uint64_t& saved_in_call) const;

  World& world_;
  bool active_ = false;
  bool reset_requested_ = false;
  bool panic_requested_ = false;
  bool panic_end_requested_ = false;
  std::uint64_t call_ = 0;
  std::vector<Entry> entries_;
  std::vector<SavedForces> forces_;
  std::vector<SavedBody> bodies_;
  CameraMoves::State camera_moves_;
  std::vector<SavedMotion> motions_;
  std::vector<HiddenBody> hidden_bodies_;
  std::vector<HiddenGear> hidden_gears_;  // destroyed before the bodies
};

}  // namespace limber

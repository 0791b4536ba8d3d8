// Kinematics: moves the parts that are moved by setting their pose or velocity instead of by forces. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace limber::sim {

class Part;
class World;

/// What moves a part. The order is that of the property's choices.
enum class PartMotion : std::uint8_t {
  dynamic,    ///< Forces and impacts.
  kinematic,  ///< Its pose or velocity, when these are set; it is never pushed.
  fixed,  ///< Nothing ("static"); setting its pose in consecutive ticks, or its velocity, moves it as a kinematic one.
};

/// Motion of a part; the other fields are those of a part that isn't moved by forces.
struct KinematicState {
  PartMotion motion = PartMotion::dynamic;
  Vec3 linear{0};               ///< Velocity that was set, m/s and rad/s, world axes; zero: it stands.
  Vec3 angular{0};              ///< About its center of mass.
  std::uint64_t pose_tick = 0;  ///< 1 + the tick in which its pose was set last; 0: never.
  bool has_target = false;      ///< Its pose was set; the next tick moves it there.
  bool teleports = false;       ///< The next pose that is applied is a teleport.
};

/// A part that moves has a velocity in Bullet during the tick, so that contacts and joints see it, and is moved by
/// bullet::KinematicBodies in each substep. A part that stands costs nothing.
class Kinematics {
 public:
  explicit Kinematics(World& world) : world_(world) {}

  /// False: static parts don't move at velocities or between poses, only kinematic ones do (takes of older versions).
  void set_static_parts_move(bool on) { static_parts_move_ = on; }
  bool static_parts_move() const { return static_parts_move_; }
  /// Adds a part whose pose or velocity was set.
  void add(Part& part);
  void remove(const Part& part);
  /// True if a pose that is applied now is the target of the next tick, and not a teleport.
  bool moves_to_pose(const Part& part) const;
  /// Starts the motions of the next tick, of `seconds`. Call after all changes were applied.
  void begin_tick(double seconds);
  /// Puts the parts where they were to move: while no time passes.
  void place();
  /// Publishes the parts after a step, and removes those that stand.
  void end_tick();
  /// Finds the parts again after their states were loaded.
  void restore();
  /// Counts switches between dynamic and static parts, after which behaviors resolve their targets again.
  std::uint32_t motion_changes() const { return motion_changes_; }
  void count_motion_change() { motion_changes_++; }

 private:
  void start(Part& part, double seconds);

  World& world_;
  std::vector<Part*> parts_;
  std::uint32_t motion_changes_ = 0;
  bool static_parts_move_ = true;
  std::vector<bool> listed_;  // by Part::accumulator_index(): it is in parts_
};

}  // namespace limber::sim

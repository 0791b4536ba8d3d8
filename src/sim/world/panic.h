// Panic: brings the world to rest, against all drives and forces, and keeps it there until end(). No property
// changes: only the settings in Bullet differ meanwhile. [sim]
#pragma once

#include <cstdint>

#include "base/memory/archive.h"

namespace limber::sim::bullet {
enum class AxisDrive : std::uint8_t;
}  // namespace limber::sim::bullet

namespace limber::sim {

class World;
enum class MotorMode : std::uint8_t;

class Panic {
 public:
  /// Damping of all velocities, 1/s. It is the same for all, so it does no work against joints. After t seconds the
  /// remaining share of the initial kinetic energy is exp(-2·kDamping·t): 1 % after 0.4 s.
  static constexpr double kDamping = 6;
  /// Terminal velocity of falling bodies, m/s: gravity is limited to kDamping·kTerminalSpeed. The kinetic
  /// energy of bodies of mass m never exceeds (sqrt(E0)·exp(-kDamping·t) + kTerminalSpeed·sqrt(m/2))². Joints that were
  /// pushed away from their held position return at this speed, in rad/s or m/s.
  static constexpr double kTerminalSpeed = 0.1;

  static constexpr const char* kDoc =
      "Brings everything to rest: behaviors, morphs, forces and the scene's callbacks stop. A second call, after the "
      "first second, restores the newest good checkpoint.";

  explicit Panic(World& world) : world_(world) {}

  bool on() const { return state_.on; }
  /// The world's tick when the panic began, while it is on.
  std::uint64_t start_tick() const { return state_.start_tick; }
  /// True once its first second is over; before, further requests are ignored.
  bool first_second_over() const { return state_.first_second_over; }
  void end_first_second() { state_.first_second_over = true; }
  /// Starts a panic: until end(), behaviors are paused, forces are discarded, and motors act as set by
  /// `panic_motors`.
  void begin();
  /// Ends the panic: all drives and forces act as set.
  void end();
  /// Stores the present joint positions as the held ones, and applies `panic_motors`. Call when that has changed.
  void update_motors();

  /// Passes the property `gravity` to Bullet, limited while the panic is on.
  void apply_gravity();
  /// True if `panic_motors` is set to hold the motors.
  bool holds_motors() const;
  /// Returns the drive of an axis with motor mode `mode`: during a panic, it holds its position with its own
  /// strength, or is off.
  bullet::AxisDrive drive(MotorMode mode) const;
  /// Damps all velocities; call after each substep of h seconds.
  void damp(double h);
  /// For checkpoints.
  void serialize(Archive& archive) { archive.serialize(state_); }

 private:
  void set_on(bool on);

  World& world_;
  // what persists from tick to tick
  struct State {
    bool on = false;
    bool first_second_over = false;
    std::uint64_t start_tick = 0;
  } state_;
};

}  // namespace limber::sim

// Panic: the world comes to rest, whatever drives it, and stays so until this ends. Nothing that anybody has set is
// changed: what acts otherwise meanwhile is Bullet's alone. [sim]
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "sim/joint_constraint.h"
#include "sim/motor.h"

namespace limber {

class World;

class Panic {
 public:
  /// 1/s: all velocities fall by it alike, so that joints have nothing to say against it. After t seconds the kinetic
  /// energy that was there is exp(-2·kBrake·t) of itself: 1 % after 0.4 s.
  static constexpr double kBrake = 6;
  /// m/s: what falls or sinks does so no faster, since gravity is at most kBrake·kSink. The kinetic energy of bodies of
  /// mass m is never above (sqrt(E0)·exp(-kBrake·t) + kSink·sqrt(m/2))². Joints that were pushed away from where they
  /// are held come back with so many rad/s or m/s.
  static constexpr double kSink = 0.1;

  static constexpr const char* kDoc =
      "All comes to rest: behaviours, morphs, forces and the scene's callbacks stop. Once more, after the first "
      "second: back to the newest good moment.";

  explicit Panic(World& world) : world_(world) {}

  bool on() const { return on_; }
  /// The world's tick when it began, while it holds.
  std::uint64_t began() const { return began_; }
  /// Whether its first second is over, in which another request is ignored.
  bool settled() const { return settled_; }
  void settle() { settled_ = true; }
  /// Behaviours don't act and forces are lost until end(); motors do what `panic_motors` says.
  void begin();
  /// Everything acts again as it is set.
  void end();
  /// `panic_motors` is another one: what is held is held as it is now.
  void renew();

  /// Gravity in force, where `gravity` is set.
  Vec3 weight(const Vec3& gravity) const;
  /// What `panic_motors` says.
  bool holds_motors() const;
  /// What an axis does whose motor is set to that: it stays where it is, with the strength that it has, or nothing.
  AxisDrive drive(MotorMode mode) const;
  /// After each internal step of h seconds.
  void brake(double h);

 private:
  friend class WorldKey;
  void turn(bool on);

  World& world_;
  bool on_ = false;
  bool settled_ = false;
  std::uint64_t began_ = 0;
};

}  // namespace limber

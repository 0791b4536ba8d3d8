// RawScene: parts and joints as plain numbers, played in a stock Bullet world or in ours, so that the solvers can be
// compared on exactly the same thing.
#pragma once

#include <memory>
#include <vector>

#include "base/vec.h"

class btConstraintSolver;

namespace limber {

struct RawPart {
  Vec3 size{0.1, 0.1, 0.2};  ///< A box; a ball of radius size.x where size.y is 0.
  double mass = 1;           ///< 0: does not move.
  Pose pose;
};

struct RawJoint {
  int parent = 0;
  int child = 0;
  Vec3 place{0};  ///< World, at the start.
  Vec3 axis{0, 0, 1};
  bool fixed = false;
  double lower = 1;  ///< Above upper: free.
  double upper = -1;
  double speed = 10;  ///< Of the servo.
  double force = 0;   ///< Of the servo; 0: none.
  double stiffness = 0;
  double damping = 0;
  double amplitude = 0;  ///< The servo's target: amplitude·sin(2 pi·frequency·t + phase), or as a square wave.
  double frequency = 0.5;
  double phase = 0;
  bool square = false;
  double hold = 0;  ///< Added to the target.

  double target(double time) const;
};

struct RawScene {
  std::vector<RawPart> parts;
  std::vector<RawJoint> joints;
  bool floor = false;
  bool self_collision = false;
  Vec3 gravity{0, 0, -9.81};
  double attract = 0;  ///< Force towards (0, 0, 1), N per m and part.
  double step = 1.0 / 60;
  int iterations = 10;
  double servo_share = 0;  ///< Stock's servos: part of an error made good in a step; 0: as Bullet has it, 0.2.
  bool measure = false;    ///< Residuals too; it costs time.
};

enum class RawSolver { stock, sweeps, direct };

/// What is measured after a step.
struct RawFigures {
  double gap = 0;           ///< Between the two sides of a joint, m.
  double servo_error = 0;   ///< rad.
  double limit_passed = 0;  ///< rad.
  double speed = 0;         ///< Of a part, m/s.
  bool finite = true;
  void take(const RawFigures& o);
};

/// Of all moving parts, J.
struct RawEnergy {
  double kinetic = 0;
  double potential = 0;  ///< Against gravity; 0 at the origin.
};

/// A scene in a world. [sim]
class RawPlayer {
 public:
  static std::unique_ptr<RawPlayer> make(const RawScene& scene, RawSolver solver);
  /// Stock Bullet with another of its solvers, which outlives the player.
  static std::unique_ptr<RawPlayer> make_stock(const RawScene& scene, btConstraintSolver& solver);
  virtual ~RawPlayer() = default;
  /// One internal step; servos go where they should be at the present time.
  virtual void step() = 0;
  virtual RawFigures figures() const = 0;
  virtual RawEnergy energy() const = 0;
  virtual Pose pose(int part) const = 0;
  /// Island steps by solver, and residuals, of the direct one.
  struct Direct {
    double direct = 0, plain = 0, fallbacks = 0;
    double locked = 0, bounded = 0, contact = 0;
  };
  virtual Direct direct() const { return {}; }
};

/// Energy at ticks, J. A semi-implicit step moves by the velocities that it ends with: they are those of the way from
/// one tick to the next. At a tick kinetic energy is the mean of that on the way there and on the way on, which is
/// right to the second order of the step (the velocities of Störmer and Verlet; Hairer, Lubich and Wanner 2003) and,
/// where it errs, high. With the velocities of one of the ways it would be right to the first order alone. [sim]
class RawEnergyMeter {
 public:
  /// After a step, the first at least.
  explicit RawEnergyMeter(const RawPlayer& player) : player_(player), way_(player.energy()) {}
  /// After the next one: at the tick between the two.
  double take();

 private:
  const RawPlayer& player_;
  RawEnergy way_;  // kinetic on the way to the tick, potential there
};

}  // namespace limber

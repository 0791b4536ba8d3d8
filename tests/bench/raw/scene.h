// RawScene: parts and joints as plain data, simulated in a stock Bullet world or in ours, to compare the solvers on
// exactly the same scene.
#pragma once

#include <memory>
#include <vector>

#include "base/vec.h"

class btConstraintSolver;

namespace limber {

struct RawPart {
  Vec3 size{0.1, 0.1, 0.2};  ///< a box, or a sphere of radius size.x if size.y is 0
  double mass = 1;           ///< 0: static
  Pose pose;
};

struct RawJoint {
  int parent = 0;
  int child = 0;
  Vec3 position{0};  ///< world coordinates, at the start
  Vec3 axis{0, 0, 1};
  bool fixed = false;
  double lower = 1;  ///< above `upper`: free
  double upper = -1;
  double speed = 10;  ///< of the servo
  double force = 0;   ///< of the servo; 0: no servo
  double stiffness = 0;
  double damping = 0;
  double amplitude = 0;  ///< servo target: amplitude·sin(2 pi·frequency·t + phase), or a square wave
  double frequency = 0.5;
  double phase = 0;
  bool square = false;
  double offset = 0;  ///< added to the target

  double target(double time) const;
};

struct RawScene {
  std::vector<RawPart> parts;
  std::vector<RawJoint> joints;
  bool floor = false;
  bool self_collision = false;
  Vec3 gravity{0, 0, -9.81};
  double attraction = 0;  ///< force towards (0, 0, 1), N per m and part
  double step = 1.0 / 60;
  int iterations = 10;
  double servo_erp = 0;  ///< stock's servos: share of the error corrected per step; 0: Bullet's default, 0.2
  bool measure = false;  ///< measure residuals too, which takes time
};

enum class RawSolver { stock, iterative, direct };

/// Measurements after a step.
struct RawMeasurements {
  double gap = 0;              ///< between the two sides of a joint, m
  double servo_error = 0;      ///< rad
  double limit_violation = 0;  ///< rad
  double speed = 0;            ///< of a part, m/s
  bool finite = true;
  void accumulate_max(const RawMeasurements& other);
};

/// Of all moving parts, J.
struct RawEnergy {
  double kinetic = 0;
  double potential = 0;  ///< of gravity; 0 at the origin
};

/// Simulates a scene in a world. [sim]
class RawSimulation {
 public:
  static std::unique_ptr<RawSimulation> make(const RawScene& scene, RawSolver solver);
  /// Stock Bullet with another of its solvers, which must outlive the player.
  static std::unique_ptr<RawSimulation> make_stock(const RawScene& scene, btConstraintSolver& solver);
  virtual ~RawSimulation() = default;
  /// Advances by one substep, with servo targets for the present time.
  virtual void step() = 0;
  virtual RawMeasurements measurements() const = 0;
  virtual RawEnergy energy() const = 0;
  virtual Pose pose(int part) const = 0;
  /// Of the direct solver: number of island steps by kind, and largest residuals (DirectResiduals).
  struct Direct {
    double direct = 0, plain = 0, fallbacks = 0;
    double unbounded = 0, bounded = 0, coupled = 0;
  };
  virtual Direct direct() const { return {}; }
};

/// Energy at a tick, J. A semi-implicit step ends with the velocities that it moved by, which belong to the interval
/// between two ticks. The kinetic energy at a tick is the mean of those of the adjacent intervals; this is accurate
/// to second order in the step (the velocities of Störmer and Verlet; Hairer, Lubich and Wanner 2003), with an error
/// to the high side. The velocities of a single interval would be accurate to first order only. [sim]
class RawEnergyMeter {
 public:
  /// Call after at least one step.
  explicit RawEnergyMeter(const RawSimulation& simulation)
      : simulation_(simulation), last_energy_(simulation.energy()) {}
  /// Call after the next step: returns the energy at the tick before it.
  double measure();

 private:
  const RawSimulation& simulation_;
  RawEnergy last_energy_;  // kinetic: in the interval before the tick; potential: at the tick
};

}  // namespace limber

// Arms in Limber: an engine with a world that is built without a scene. Shared by the measurements.
#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/raw/loop.h"
#include "engine/engine.h"

namespace limber::sim {
class Shape;
}  // namespace limber::sim

namespace limber {

/// The same arms as RawLoop's, built with the world's functions. [sim]
class BenchArms {
 public:
  explicit BenchArms(const ArmScene& scene, int threads = 1);
  BenchArms(const BenchArms&) = delete;
  BenchArms& operator=(const BenchArms&) = delete;

  /// Sets the targets of all servos for this time through the setters, as a script or behavior does.
  void drive(double time);
  /// Runs a complete tick: commands, scripts, on-change callbacks, physics, readouts, snapshot.
  void tick() { engine_.tick(); }

  /// Largest position error of a joint, m.
  double joint_gap() const;
  /// Largest deviation of a joint from its target at this time, rad.
  double servo_error(double time) const;
  double time() { return engine_.world().time(); }
  /// Size of the heap before the arms were created, bytes.
  double heap_when_empty() const { return heap_when_empty_; }
  engine::Engine& engine() { return engine_; }
  engine::EngineLink& link() { return link_; }

 private:
  void add_floor(sim::Shape& plane);
  void add_arm(int arm, sim::Shape& box);

  ArmScene scene_;
  engine::EngineLink link_;
  engine::Engine engine_;
  std::vector<sim::Joint*> joints_;  // arm by arm, from the base upwards
  double heap_when_empty_ = 0;
};

/// Returns the default of sim.solver_iterations.
int default_iterations();
/// Returns a scene with this many arms: ticks of 1/60 s, 4 substeps.
ArmScene arm_scene(int arms);
/// Returns the same scene with the direct solver, which needs a single substep per tick.
ArmScene direct_arm_scene(int arms);

/// Runs Limber's arms and, if requested, the plain Bullet loop, interleaved. Returns the results.
nlohmann::ordered_json measure_arms(const ArmScene& scene, int warm_ticks, int ticks, bool compare_raw);

}  // namespace limber

// The arms of the bench in Limber: an engine whose world is filled by hand. Shared by `limber bench`, the benchmarks in
// tests/bench and tests.
#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "sim/raw_loop.h"

namespace limber {

/// The same arms as RawLoop's, through the world's own doors. [sim]
class BenchArms {
 public:
  explicit BenchArms(const ArmScene& scene, int threads = 1);
  BenchArms(const BenchArms&) = delete;
  BenchArms& operator=(const BenchArms&) = delete;

  /// Targets of all servos for this time, through the door: what a script or a behaviour would do.
  void drive(double time);
  /// The whole tick: commands, scripts, effects, physics, readouts, snapshot.
  void tick() { engine_.tick(); }

  double joint_gap() const;
  double servo_error(double time) const;
  double time() { return engine_.world().time(); }
  /// Heap before the arms were made, bytes.
  double heap_when_empty() const { return heap_when_empty_; }
  Engine& engine() { return engine_; }
  EngineLink& link() { return link_; }

 private:
  void add_floor(Shape& plane);
  void add_arm(int arm, Shape& box);

  ArmScene scene_;
  EngineLink link_;
  Engine engine_;
  std::vector<Joint*> joints_;  // arm by arm, from the base up
  double heap_when_empty_ = 0;
};

/// The default of sim.solver_iterations.
int default_iterations();
/// A scene with this many arms: ticks of 1/60 s, 4 substeps.
ArmScene bench_arm_scene(int arms);
/// The same with the direct solver, which needs one internal step a tick alone.
ArmScene direct_arm_scene(int arms);

/// Ticks both (raw where it is wanted), interleaved, and gives the figures.
nlohmann::ordered_json bench_arms(const ArmScene& scene, int warm_ticks, int ticks, bool compare_raw);

}  // namespace limber

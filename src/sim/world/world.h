// World: owns the bodies, gears, tendons, shapes and behaviors of a scene and runs the physical part of a tick:
// behaviors, property changes, Bullet, readouts, contacts, stability check. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "properties/store.h"
#include "sim/bullet/bullet_memory.h"
#include "sim/motion/kinematics.h"
#include "sim/neighbors/mass_table.h"
#include "sim/sensors/sensing.h"
#include "sim/state/motion_hash.h"
#include "sim/state/world_transaction.h"
#include "sim/world/awake_bodies.h"
#include "sim/world/force_accumulators.h"
#include "sim/world/object_list.h"
#include "sim/world/panic.h"
#include "sim/world/part_pairs.h"
#include "sim/world/stability.h"
#include "sim/world/world_setup.h"

class btDynamicsWorld;

namespace limber::model {
struct BodyModel;
}  // namespace limber::model

namespace limber::sim::bullet {
class IslandWorld;
}  // namespace limber::sim::bullet

namespace limber::sim {

class BehaviorList;
class Body;
class GearList;
class ShapeList;
class TendonList;
class Visuals;
struct BuildOptions;

/// Durations of the phases of a tick, in seconds.
struct TickTimes {
  double behaviors = 0;
  double flush = 0;
  double physics = 0;
  double readouts = 0;
};

class World {
 public:
  static const PropertyTable& table();

  explicit World(Store& store, const WorldSetup& setup = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Store& store() const { return store_; }
  NodeId id() const { return id_; }

  /// Adds an empty body. Errors: the name is taken or contains characters that can't be printed.
  Result<Body*> add_body(std::string name);
  Result<Body*> add_body(const std::shared_ptr<const model::BodyModel>& model, std::string name,
                         const BuildOptions& options);
  /// Copies a body of this or another world with all its values, to the same place, so that both overlap. Contacts are
  /// found in the next step: moving the copy (set_pose) before it avoids a collision of the two.
  Result<Body*> copy_body(const Body& source, std::string name);
  /// Removes a body, the gears of its joints, and the tendons that use it. In a guarded call the body is hidden at once
  /// and destroyed when the call succeeds.
  void remove_body(Body& body);
  Body* find_body(std::string_view name) const { return bodies_.find(name); }
  std::span<const std::unique_ptr<Body>> bodies() const { return bodies_.list(); }
  std::vector<std::string_view> body_names() const;
  /// Moves the bodies of `first` to the front of the list, in this order; the others follow in their previous order.
  void move_bodies_to_front(const std::vector<Body*>& first);

  GearList& gears() const { return *couplings_.gears; }
  TendonList& tendons() const { return *couplings_.tendons; }
  ShapeList& shapes() const { return *shapes_; }
  Visuals& visuals() const { return *visuals_; }
  BehaviorList& behaviors() const { return *behaviors_; }

  double time() const;
  std::uint64_t tick() const { return state_.tick; }
  double timestep() const;
  int substeps() const;
  std::uint64_t seed() const;

  /// Runs one tick: behaviors, pending property changes, `substeps` substeps, readouts, contacts, stability
  /// check. Returns how long they took.
  TickTimes step();
  /// Applies pending property changes without advancing time: while paused, and before the first tick.
  void flush();
  /// Requests to the owner of the scene; it consumes them between two ticks.
  WorldRequests& requests() { return state_.requests; }
  Panic& panic() { return panic_; }
  /// Removes all behaviors, bodies and shapes, and resets the world's own properties to their defaults.
  void clear();
  /// Sets the tick counter and the simulated time, and resets the solver's counters.
  void restart_time(std::uint64_t tick = 0, double time = 0);

  Kinematics& kinematics() { return part_inputs_.kinematics; }
  Sensing& sensing() const { return *sensing_; }
  StabilityCheck& stability() { return stability_; }
  const StabilityCheck& stability() const { return stability_; }
  /// Parts that overlap in their first tick; reported in the next step.
  OverlapReport& overlaps() { return overlaps_; }
  /// Returns a hash of all poses, velocities and persistent values, bit for bit. Includes the random
  /// generators of behaviors; ShowState::state_hash() adds that of the scene.
  std::uint64_t state_hash() const;
  /// Hash of the motion, for comparing two runs tick by tick.
  MotionHash& motion_hash() { return motion_hash_; }
  /// Serializes all that persists from tick to tick, except Bullet's memory and the values of properties.
  void serialize(Archive& archive);

  ForceAccumulators& force_accumulators() { return part_inputs_.forces; }
  MassTable& mass_table() { return mass_table_; }
  bullet::IslandWorld& bullet() { return *bullet_; }
  bullet::BulletMemory& bullet_memory() { return bullet_memory_; }
  /// The thread pool that runs the tick's parallel loops, or null. [sim]
  ThreadPool* thread_pool() const { return thread_pool_.get(); }
  /// Rolls back guarded calls of scripts.
  WorldTransaction& transaction() { return transaction_; }

 private:
  static void after_substep(btDynamicsWorld* bullet, float h);

  Store& store_;
  std::shared_ptr<ThreadPool> thread_pool_;  // runs the parallel loops of a step, or null
  NodeId id_;
  bullet::BulletMemory bullet_memory_;
  std::unique_ptr<bullet::IslandWorld> bullet_;
  struct PartInputs {  // what scripts and controllers do to parts
    ForceAccumulators forces;
    Kinematics kinematics;
  } part_inputs_{{}, Kinematics(*this)};
  MassTable mass_table_;
  std::unique_ptr<ShapeList> shapes_;
  ObjectList<Body> bodies_;
  struct Couplings {  // destroyed before the bodies
    std::unique_ptr<GearList> gears;
    std::unique_ptr<TendonList> tendons;
  } couplings_;
  std::unique_ptr<BehaviorList> behaviors_;
  std::unique_ptr<Visuals> visuals_;
  WorldTransaction transaction_{*this};
  std::unique_ptr<Sensing> sensing_ = std::make_unique<Sensing>(*this);
  StabilityCheck stability_{*this};
  OverlapReport overlaps_;
  AwakeBodies awake_bodies_{*this};
  Panic panic_{*this};
  MotionHash motion_hash_{*this};
  // what persists from tick to tick, besides its properties
  struct State {
    std::uint64_t tick = 0;
    double last_timestep = 0, time_at_timestep_change = 0;  // the present timestep, and the time at which it was set
    std::uint64_t tick_at_timestep_change = 0;
    WorldRequests requests;
    /// Counts a tick that began at `time`, and returns the time at its end: a product, since a sum of timesteps would
    /// drift from it.
    double end_tick(double timestep, double time);
  } state_;
};

}  // namespace limber::sim

// World: owns the bodies, gears, shapes and behaviors of a scene and runs the physical part of a tick: behaviors,
// property changes, Bullet, readouts, contacts, health checks. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "properties/store.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/bullet_memory.h"
#include "sim/neighbors/mass_table.h"
#include "sim/state/motion_hash.h"
#include "sim/state/world_transaction.h"
#include "sim/visuals/camera_motion.h"
#include "sim/visuals/overlay.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/contacts.h"
#include "sim/world/gear.h"
#include "sim/world/panic.h"
#include "sim/world/shape.h"
#include "sim/world/world_setup.h"

class btDynamicsWorld;

namespace limber {

class IslandWorld;
struct DirectCounts;

/// Durations of the phases of the last tick, in seconds.
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
  Result<Body*> add_body(const std::shared_ptr<const BodyModel>& model, std::string name, const BuildOptions& options);
  /// Copies a body of this or another world with all its values, to the same place. If the copy is moved (set_pose)
  /// before the next step, it never collides with its original.
  Result<Body*> copy_body(const Body& source, std::string name);
  /// Replaces `body` by a copy of `blueprint`, which may be of another world. The new body gets the pose of the old
  /// one, and the positions and velocities of the joints that both have, except joints flagged in `joints_to_reset`.
  /// Unchanged state is preserved bit for bit. The start pose is that of `blueprint`.
  Body& rebuild_body(Body& body, const Body& blueprint, const std::vector<bool>& joints_to_reset);
  /// Removes a body and the gears of its joints. In a guarded call the body is hidden at once and destroyed when the
  /// call succeeds.
  void remove_body(Body& body);
  Body* find_body(std::string_view name) const;
  std::span<const std::unique_ptr<Body>> bodies() const { return bodies_; }
  std::vector<std::string_view> body_names() const;

  /// Couples the own axes of two joints: position_b = ratio·position_a + offset. Without an offset, the present
  /// positions determine it. Errors: the name is taken or can't be printed, a joint without a single axis, a ratio of
  /// 0.
  Result<Gear*> add_gear(std::string name, Joint& joint_a, Joint& joint_b, double ratio,
                         std::optional<double> offset = {});
  /// Removes a gear. In a guarded call it is hidden at once and destroyed when the call succeeds.
  void remove_gear(Gear& gear);
  Gear* find_gear(std::string_view name) const;
  std::span<const std::unique_ptr<Gear>> gears() const { return gears_; }
  void move_gears_to_front(const std::vector<Gear*>& first);
  /// Requests that redundant gears are determined again before the next step.
  void mark_gears_dirty() { state_.gears_dirty = true; }

  Result<Shape*> add_shape(std::string name, ShapeModel model);
  Shape* find_shape(std::string_view name) const;
  std::span<const std::unique_ptr<Shape>> shapes() const { return shapes_; }

  /// Adds a shape with the visual's color for each visual of the model (visual_shape_name). Shapes that exist already
  /// are left unchanged: all bodies of the model share them.
  void add_shapes_for(const BodyModel& model);
  void remove_shape(Shape& shape);
  /// Returns the shape of this world that has the same name as `shape` of the other world, or a null id.
  NodeId matching_shape(const World& other, NodeId shape) const;
  /// Reorder the list: `first` to the front, in this order; the others follow in their previous order.
  void move_bodies_to_front(const std::vector<Body*>& first);
  void move_shapes_to_front(const std::vector<Shape*>& first);
  Visuals& visuals() { return *visuals_; }
  const Visuals& visuals() const { return *visuals_; }
  CameraMoves& camera_moves() { return camera_moves_; }
  BehaviorList& behaviors() { return *behaviors_; }
  const BehaviorList& behaviors() const { return *behaviors_; }

  double time() const;
  std::uint64_t tick() const { return state_.tick; }
  double timestep() const;
  int substeps() const;
  std::uint64_t seed() const;

  /// Runs one tick: behaviors, pending property changes, `substeps` internal steps, readouts, contacts, health
  /// checks.
  void step();
  /// Applies pending property changes without advancing time: while paused, and before the first tick.
  void flush();
  /// Requests a reset, which the owner of the scene performs between two ticks.
  void request_reset() { state_.requests.reset = true; }
  /// Returns whether sim:reset or /transport/reset requested a reset since the last call.
  bool consume_reset_request() { return std::exchange(state_.requests.reset, false); }
  /// Requests a panic, which the owner of the scene starts before the next step.
  void request_panic() { state_.requests.panic = true; }
  /// Returns whether sim:panic or /transport/panic requested a panic since the last call, however often.
  bool consume_panic_request() { return std::exchange(state_.requests.panic, false); }
  /// /transport/panic_end: ends a panic and cancels an earlier request for one in the same tick.
  void request_panic_end() {
    state_.requests.panic = false;
    state_.requests.panic_end = true;
  }
  bool consume_panic_end_request() { return std::exchange(state_.requests.panic_end, false); }
  WorldRequests& requests() { return state_.requests; }
  Panic& panic() { return panic_; }
  const Panic& panic() const { return panic_; }
  /// Removes all behaviors, bodies and shapes, and resets the world's own properties to their defaults.
  void clear();
  /// Applies pending property changes without adding bodies to Bullet's world: for a world that only describes a
  /// scene and is never stepped.
  void flush_detached();
  /// Sets the tick counter and the simulated time, and resets the solver's counters.
  void restart_time(std::uint64_t tick = 0, double time = 0);

  /// Contacts that began in the last tick between parts with `report_contacts`, in a deterministic order.
  std::span<const ContactEvent> contacts() const { return contacts_.events(); }
  /// Number of times that the stability check restored or disabled a body since the start; `--strict` checks it.
  std::uint64_t health_events() const { return state_.health_events; }
  /// Returns a hash of all poses, velocities and persistent values, bit for bit. Generators are added by their
  /// owners.
  std::uint64_t state_hash() const;
  /// Hash of the motion, for comparing two runs tick by tick.
  MotionHash& motion_hash() { return motion_hash_; }
  const TickTimes& times() const { return times_; }
  /// Serializes all that persists from tick to tick, except Bullet's memory and the values of properties.
  void serialize(Archive& archive);

  /// Returns an error unless an object with this name can be added to the group. `kind`: such as "body".
  Result<void> check_new_name(NodeId group, std::string_view kind, std::string_view name) const;
  /// Notes that two parts of a body overlap in its first tick; log_overlaps() reports it. [sim]
  void report_overlap(const Body& body, const Part& a, const Part& b, double depth);
  /// On-change callback of `gravity`; also called when a panic begins or ends.
  void apply_gravity();

  /// One geometry per link, built once per model and shared by all its bodies.
  const std::vector<std::shared_ptr<const Geometry>>& geometries_for(const std::shared_ptr<const BodyModel>& model);

  ForceAccumulators& force_accumulators() { return force_accumulators_; }
  MassTable& mass_table() { return mass_table_; }
  IslandWorld& bullet() { return *bullet_; }
  BulletMemory& bullet_memory() { return bullet_memory_; }
  /// The thread pool that runs the tick's parallel loops, or null. [sim]
  ThreadPool* thread_pool() const { return thread_pool_.get(); }
  /// The data of the debug overlay.
  const Overlay& overlay() const { return overlay_; }
  Contacts& contact_log() { return contacts_; }
  /// Rolls back guarded calls of scripts.
  WorldTransaction& transaction() { return transaction_; }

 private:
  void apply_solver_settings();
  void apply_panic_motors() { panic_.update_motors(); }
  void flush_restored_bodies();
  void publish_solver_counts(const DirectCounts& before);
  void update_gears();
  void warn_slipping_gears();
  void publish_time();
  void publish_bodies();
  void log_overlaps();
  bool awake_bodies_valid() const;
  void restore_body(Body& body, const Part& part, const std::string& instability);
  static void after_internal_step(btDynamicsWorld* bullet, float h);
  Result<void> act_reset(std::span<const double> args);
  Result<void> act_panic(std::span<const double> args);

  Store& store_;
  std::shared_ptr<ThreadPool> thread_pool_;  // runs the parallel loops of a step, or null
  NodeId id_, body_group_, gear_group_, shape_group_;
  BulletMemory bullet_memory_;
  std::unique_ptr<IslandWorld> bullet_;
  ForceAccumulators force_accumulators_;
  MassTable mass_table_;
  std::vector<std::unique_ptr<Shape>> shapes_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<std::unique_ptr<Gear>> gears_;  // destroyed before the bodies
  std::unique_ptr<BehaviorList> behaviors_;
  std::unique_ptr<Visuals> visuals_;
  CameraMoves camera_moves_{*this};
  struct ModelGeometry {
    std::shared_ptr<const BodyModel> model;  // keeps the map key's address from being reused
    std::vector<std::shared_ptr<const Geometry>> links;
  };
  std::unordered_map<const BodyModel*, ModelGeometry> geometries_;
  Contacts contacts_;
  WorldTransaction transaction_{*this};
  Panic panic_{*this};
  Overlay overlay_{*this};
  MotionHash motion_hash_{*this};
  TickTimes times_;
  // what persists from tick to tick, besides its properties
  struct State {
    std::uint64_t tick = 0;
    double last_timestep = 0, time_at_timestep_change = 0;  // the present timestep, and the time at which it was set
    std::uint64_t tick_at_timestep_change = 0;
    std::uint64_t health_events = 0;
    WorldRequests requests;
    bool body_restored = false;  // a body was restored in this tick
    bool gears_dirty = false;
  } state_;
  std::size_t overlap_count_ = 0;  // since log_overlaps()
  std::string first_overlap_;      // report of the first of them
  // Bodies that are not asleep, valid for these versions of the sleep tracker and the store; 0: not valid.
  std::vector<Body*> awake_bodies_;
  std::uint64_t awake_version_ = 0;
  std::uint64_t awake_structure_ = 0;
};

}  // namespace limber

// World: the bodies, their shapes, and the tick's physical half: effects, Bullet, readouts, contacts, health. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "params/store.h"
#include "sim/behavior_list.h"
#include "sim/body.h"
#include "sim/camera_moves.h"
#include "sim/contacts.h"
#include "sim/gear.h"
#include "sim/island_world.h"
#include "sim/motion_hash.h"
#include "sim/overlay.h"
#include "sim/panic.h"
#include "sim/part_solids.h"
#include "sim/shape.h"
#include "sim/visuals.h"
#include "sim/world_undo.h"

namespace limber {

/// Where the tick's time went, seconds of the last tick.
struct TickTimes {
  double behaviors = 0;
  double effects = 0;
  double physics = 0;
  double readouts = 0;
};

class World {
 public:
  static const Table& table();

  explicit World(Store& store, const WorldSetup& setup = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Store& store() const { return store_; }
  NodeId id() const { return id_; }

  /// Errors: a taken name, a name that can't be printed.
  Result<Body*> add_body(std::string name);
  Result<Body*> add_body(const std::shared_ptr<const BodyModel>& model, std::string name, const BuildOptions& options);
  /// At the same place, with all values; of a body of this world or of another. Placed (set_pose) before the next step,
  /// it never collides with its original.
  Result<Body*> copy_body(const Body& source, std::string name);
  /// In a guarded call it is out of sight at once, and goes when the call has ended well.
  /// Puts a body like `described` (of another world) in the place of `body`: where that is, with its joints' positions
  /// and speeds, where the two have the same. What is the same stays to the bit. The start pose is the described one.
  Body& rebuild_body(Body& body, const Body& described, const std::vector<bool>& joints_start_anew);
  void remove_body(Body& body);
  Body* find_body(std::string_view name) const;
  std::span<const std::unique_ptr<Body>> bodies() const { return bodies_; }
  std::vector<std::string_view> body_names() const;

  /// Couples the own axes of two joints: position_b = ratio·position_a + offset; without an offset, as they are now.
  /// Errors: a taken or unprintable name, joints without a single axis, a ratio of 0.
  Result<Gear*> add_gear(std::string name, Joint& joint_a, Joint& joint_b, double ratio,
                         std::optional<double> offset = {});
  /// In a guarded call it is out of sight at once. Removing a body removes the gears of its joints.
  void remove_gear(Gear& gear);
  Gear* find_gear(std::string_view name) const;
  std::span<const std::unique_ptr<Gear>> gears() const { return gears_; }
  void order_gears(const std::vector<Gear*>& first);
  /// Which gears are redundant is determined again before the next step.
  void gears_changed() { gears_changed_ = true; }

  Result<Shape*> add_shape(std::string name, ShapeModel model);
  Shape* find_shape(std::string_view name) const;
  std::span<const std::unique_ptr<Shape>> shapes() const { return shapes_; }

  /// A shape for each of the model's visuals (visual_shape_name), with its colour. Those that are there already are
  /// left as they are: all bodies of the model share them.
  void add_shapes_of(const BodyModel& model);
  void remove_shape(Shape& shape);
  /// The shape of that name as one of another world.
  NodeId same_shape(const World& other, NodeId shape) const;
  /// Brings bodies, shapes into this order; those that are not named stand behind, as they stood.
  void order_bodies(const std::vector<Body*>& first);
  void order_shapes(const std::vector<Shape*>& first);
  Visuals& visuals() { return *visuals_; }
  const Visuals& visuals() const { return *visuals_; }
  CameraMoves& camera_moves() { return camera_moves_; }
  BehaviorList& behaviors() { return *behaviors_; }
  const BehaviorList& behaviors() const { return *behaviors_; }

  double time() const;
  std::uint64_t tick() const { return tick_; }
  double timestep() const;
  int substeps() const;
  std::uint64_t seed() const;

  /// One tick: behaviours, effects of what was set, `substeps` internal steps, readouts, contacts, health.
  void step();
  /// Effects and readouts without time passing: while paused, and before the first tick.
  void settle();
  /// Between two ticks, by whoever runs the scene.
  void ask_reset() { reset_asked_ = true; }
  /// Whether sim:reset or /transport/reset asked for a reset since the last call.
  bool take_reset_request() { return std::exchange(reset_asked_, false); }
  /// Between two ticks, or before the next step, by whoever runs the scene.
  void ask_panic() { panic_asked_ = true; }
  /// Whether sim:panic or /transport/panic asked since the last call; several times are one.
  bool take_panic_request() { return std::exchange(panic_asked_, false); }
  /// /transport/panic_end: drops an earlier request for a panic in the same tick.
  void ask_panic_end() {
    panic_asked_ = false;
    panic_end_asked_ = true;
  }
  bool take_panic_end_request() { return std::exchange(panic_end_asked_, false); }
  Panic& panic() { return panic_; }
  const Panic& panic() const { return panic_; }
  /// Removes every behaviour, body and shape; the world's own rows return to their defaults.
  void clear();
  /// Effects without entering Bullet's world: for one that is only described, never stepped.
  void stand();
  /// Time and ticks from there on.
  void restart_time(std::uint64_t tick = 0, double time = 0);

  /// Parts with `report_contacts` that began to touch in the last tick, in a fixed order.
  std::span<const ContactEvent> contacts() const { return contacts_.begun(); }
  /// Bodies that health restored or switched off since the start: `--strict` asks.
  std::uint64_t health_events() const { return health_events_; }
  /// Over the bits of all poses, velocities, kept rows; generators are added by their owners.
  std::uint64_t state_hash() const;
  /// Whether two runs move alike, for every tick.
  MotionHash& motion_hash() { return motion_hash_; }
  const TickTimes& times() const { return times_; }

  /// One a link, built once a model and shared by all its bodies.
  const std::vector<std::shared_ptr<const Geometry>>& geometries_of(const std::shared_ptr<const BodyModel>& model);

  PartLoads& loads() { return loads_; }
  PartSolids& solids() { return solids_; }
  IslandWorld& bullet() { return *bullet_; }
  BulletMemory& bullet_memory() { return bullet_memory_; }
  /// What shares out the work of a tick, or null. [sim]
  Team* team() const { return team_.get(); }
  /// What the debug picture shows.
  const Overlay& overlay() const { return overlay_; }
  Contacts& contact_log() { return contacts_; }
  /// What takes a guarded call of a script back.
  WorldUndo& undo() { return undo_; }

 private:
  friend class Body;
  friend class Panic;
  friend class WorldUndo;
  friend class WorldKey;
  void effect_gravity();
  void effect_solver();
  void effect_panic_motors() { panic_.renew(); }
  void settle_healed();
  void tell_solved(const DirectCounts& before);
  void settle_gears();
  void report_slips();
  void tell_time();
  void tell_bodies();
  void report_overlap(const Body& body, const Part& a, const Part& b, double depth);
  void log_overlaps();
  bool awake_bodies_known() const;
  void heal(Body& body, const Part& part, const std::string& what);
  static void after_internal_step(btDynamicsWorld* bullet, btScalar h);
  Result<void> name_is_free(NodeId group, std::string_view kind, std::string_view name) const;
  Result<void> act_reset(std::span<const double> args);
  Result<void> act_panic(std::span<const double> args);

  Store& store_;
  std::shared_ptr<Team> team_;  // shares out a step, or null
  NodeId id_, body_group_, gear_group_, shape_group_;
  BulletMemory bullet_memory_;
  std::unique_ptr<IslandWorld> bullet_;
  PartLoads loads_;
  PartSolids solids_;
  std::vector<std::unique_ptr<Shape>> shapes_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<std::unique_ptr<Gear>> gears_;  // go before the bodies
  std::unique_ptr<BehaviorList> behaviors_;
  std::unique_ptr<Visuals> visuals_;
  CameraMoves camera_moves_{*this};
  struct ModelGeometry {
    std::shared_ptr<const BodyModel> model;  // keeps the key's address from being used again
    std::vector<std::shared_ptr<const Geometry>> links;
  };
  std::unordered_map<const BodyModel*, ModelGeometry> geometries_;
  Contacts contacts_;
  WorldUndo undo_{*this};
  Panic panic_{*this};
  Overlay overlay_{*this};
  MotionHash motion_hash_{*this};
  TickTimes times_;
  std::uint64_t tick_ = 0;
  double timestep_since_ = 0, time_then_ = 0;  // the timestep since a tick, and the time at it
  std::uint64_t tick_then_ = 0;
  std::uint64_t health_events_ = 0;
  bool reset_asked_ = false;
  bool panic_asked_ = false;
  bool panic_end_asked_ = false;
  bool healed_ = false;                // a body, in this tick
  std::size_t overlaps_reported_ = 0;  // since log_overlaps()
  std::string overlap_text_;           // the first of them
  bool gears_changed_ = false;
  // Bodies that are not asleep, as found at these versions of the sleep tracker and the store; 0: not yet.
  std::vector<Body*> awake_bodies_;
  std::uint64_t awake_version_ = 0;
  std::uint64_t awake_structure_ = 0;
};

}  // namespace limber

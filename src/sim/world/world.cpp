// World: its properties, its bodies and shapes, and the physical part of a tick.
#include "sim/world/world.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log/log.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "properties/values_hash.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/world/stability.h"

namespace limber {

namespace {

using namespace properties;

/// Bodies per task of the parallel readout loop; has no influence on the result.
constexpr int kBodiesPerTask = 4;

struct WorldProperties {
  const Property *gravity, *timestep, *substeps, *iterations, *seed, *time, *tick, *solver, *fallbacks, *sleeping,
      *islands_direct, *islands_iterative;
};

const WorldProperties& world_properties() {
  static const auto at = [](const char* name) { return &World::table().at(name); };
  static const WorldProperties found{at("gravity"),
                                     at("timestep"),
                                     at("substeps"),
                                     at("solver_iterations"),
                                     at("seed"),
                                     at("time"),
                                     at("tick"),
                                     at("solver"),
                                     at("solver_fallbacks"),
                                     at("sleeping_parts"),
                                     at("islands_direct"),
                                     at("islands_iterative")};
  return found;
}

}  // namespace

const PropertyTable& World::table() {
  static const PropertyTable table(
      "sim", "/physics/sim", "/physics/sim",
      {
          on_change<&World::apply_gravity>(
              vec3("gravity", "m/s²", {0, 0, -9.81}, -1e4, 1e4, "Gravitational acceleration.")),
          number("timestep", "s", 1.0 / 60, 1e-5, 1, "Simulated time per tick."),
          integer("substeps", 4, 1, 1000, "Number of internal steps per tick."),
          on_change<&World::apply_solver_settings>(integer(
              "solver_iterations", 50, 1, 10000, "Iterations of the contact and joint solver per internal step.")),
          on_change<&World::apply_panic_motors>(
              choice("panic_motors", {"held", "limp"}, 0,
                     "Motors during a panic: they hold their position with their own strength, or are off.")),
          on_change<&World::apply_solver_settings>(
              choice("solver", {"iterative", "direct"}, 1,
                     "Solver of joints: iterative, together with the contacts; or direct, "
                     "which is exact for trees of joints.")),
          transient(state(
              integer("seed", 1, 0, 9007199254740992,
                      "Seed of all random numbers; a change affects behaviors at once, scenes at their next start."))),
          transient(state(boolean("paused", false, "Simulated time is stopped; commands and OSC still work."))),
          transient(state(number("speed", "× real time", 1, 0.01, 100,
                                 "Speed of simulated time relative to real time, when it is paced."))),
          transient(state(number("history", "s", 30, 0, 30, "Length of the history for /transport/rewind; 0: none."))),
          transient(readout(number("time", "s", 0, 0, kUnbounded, "Simulated time."))),
          transient(readout(integer("tick", 0, 0, kUnbounded, "Ticks since the start."))),
          transient(readout(boolean("panicked", false, "True during a panic, which brings everything to rest."))),
          invokes<&World::act_panic>(action("panic", 0, 0, Panic::kDoc)),
          transient(
              readout(integer("solver_fallbacks", 0, 0, kUnbounded,
                              "Island steps that the direct solver left to the iterative one, since the start."))),
          transient(readout(integer("sleeping_parts", 0, 0, kUnbounded, "Number of sleeping parts."))),
          transient(
              readout(integer("islands_direct", 0, 0, kUnbounded,
                              "Island steps (an island: parts connected by joints or contacts) solved by the direct "
                              "solver, since the start."))),
          transient(readout(
              integer("islands_iterative", 0, 0, kUnbounded,
                      "Island steps solved by the iterative solver, regularly or as a fallback, since the start."))),
          invokes<&World::act_reset>(action("reset", 0, 0, "Restarts the scene; overridden values stay.")),
      });
  return table;
}

World::World(Store& store, const WorldSetup& setup) : store_(store), thread_pool_(setup.thread_pool) {
  {
    const BulletMemory::Scope scope(&bullet_memory_);
    bullet_ = std::make_unique<IslandWorld>(setup);
  }
  const NodeId physics = store_.add_group(store_.root(), "physics");
  id_ = store_.add(table(), physics, "sim", this);
  body_group_ = store_.add_group(physics, "body");
  gear_group_ = store_.add_group(physics, "gear");
  behaviors_ = std::make_unique<BehaviorList>(*this, physics);
  visuals_ = std::make_unique<Visuals>(store_);
  shape_group_ = store_.add_group(visuals_->id(), "shape");
  bullet_->setInternalTickCallback(&World::after_internal_step, this, false);
}

World::~World() { clear(); }

void World::clear() {
  panic_.end();
  behaviors_->clear();
  gears_.clear();
  bodies_.clear();
  shapes_.clear();
  geometries_.clear();
  for (const Property& property : table().properties()) {
    if (property.kind == PropertyKind::setting)
      (void)store_.set(id_, property, {property.initial.data(), property.width});
  }
  visuals_->clear();
  camera_moves_.stop();
}

void World::restart_time(std::uint64_t tick, double time) {
  state_.tick = tick;
  state_.last_timestep = 0;
  store_.mutable_values(id_, *world_properties().time)[0] = time;
  store_.mutable_values(id_, *world_properties().tick)[0] = static_cast<double>(tick);
  for (const Property* property :
       {world_properties().fallbacks, world_properties().islands_direct, world_properties().islands_iterative}) {
    store_.mutable_values(id_, *property)[0] = 0;
  }
}

Result<void> World::check_new_name(NodeId group, std::string_view kind, std::string_view name) const {
  if (const auto fault = name_error(name)) return Error{fmt::format("{}: {}", kind, *fault)};
  if (store_.child(group, name).null()) return {};
  return Error{fmt::format("there is a {} '{}' already; names are unique", kind, name)};
}

Result<Body*> World::add_body(std::string name) {
  if (const Result<void> available = check_new_name(body_group_, "body", name); !available)
    return Error{available.error()};
  bodies_.push_back(std::make_unique<Body>(*this, body_group_, std::move(name)));
  transaction_.record([](void* world, std::size_t) { static_cast<World*>(world)->bodies_.pop_back(); }, this);
  return bodies_.back().get();
}

Result<Body*> World::add_body(const std::shared_ptr<const BodyModel>& model, std::string name,
                              const BuildOptions& options) {
  Result<Body*> body = add_body(std::move(name));
  if (!body) return body;
  add_shapes_for(*model);
  (*body)->build(model, options);
  return body;
}

Result<Body*> World::copy_body(const Body& source, std::string name) {
  Result<Body*> body = add_body(std::move(name));
  if (!body) return body;
  if (source.model() != nullptr && &source.world() != this) add_shapes_for(*source.model());
  (*body)->build_copy(source);
  return body;
}

void World::remove_body(Body& body) {
  const auto at = std::ranges::find_if(bodies_, [&](const std::unique_ptr<Body>& b) { return b.get() == &body; });
  if (at == bodies_.end()) return;
  for (std::size_t i = gears_.size(); i-- > 0;) {
    if (gears_[i]->couples(body)) remove_gear(*gears_[i]);
  }
  mark_gears_dirty();  // its mimic relations are removed with it
  if (transaction_.active()) return transaction_.hide(bodies_, static_cast<std::size_t>(at - bodies_.begin()));
  bodies_.erase(at);
}

Body* World::find_body(std::string_view name) const {
  const NodeId id = store_.child(body_group_, name);
  return id.null() ? nullptr : static_cast<Body*>(store_.object(id));
}

std::vector<std::string_view> World::body_names() const {
  std::vector<std::string_view> names;
  for (const auto& body : bodies_) names.push_back(body->name());
  return names;
}

Result<Shape*> World::add_shape(std::string name, ShapeModel model) {
  if (const Result<void> available = check_new_name(shape_group_, "shape", name); !available)
    return Error{available.error()};
  if (const Result<void> valid = check_shape(model); !valid) {
    return Error{fmt::format("shape '{}': {}", name, valid.error())};
  }
  shapes_.push_back(std::make_unique<Shape>(store_, shape_group_, std::move(name), std::move(model)));
  transaction_.record([](void* world, std::size_t) { static_cast<World*>(world)->shapes_.pop_back(); }, this);
  return shapes_.back().get();
}

Shape* World::find_shape(std::string_view name) const {
  const NodeId id = store_.child(shape_group_, name);
  return id.null() ? nullptr : static_cast<Shape*>(store_.object(id));
}

const std::vector<std::shared_ptr<const Geometry>>& World::geometries_for(
    const std::shared_ptr<const BodyModel>& model) {
  ModelGeometry& cached = geometries_[model.get()];
  if (cached.model == nullptr) {
    cached.model = model;
    for (const LinkModel& link : model->links) cached.links.push_back(make_geometry(link.collisions, link.inertial));
  }
  return cached.links;
}

double World::time() const { return store_.values(id_, *world_properties().time)[0]; }
double World::timestep() const { return store_.values(id_, *world_properties().timestep)[0]; }
int World::substeps() const { return static_cast<int>(store_.values(id_, *world_properties().substeps)[0]); }
std::uint64_t World::seed() const {
  return static_cast<std::uint64_t>(store_.values(id_, *world_properties().seed)[0]);
}

void World::apply_gravity() {
  const double* g = store_.values(id_, *world_properties().gravity);
  bullet_->setGravity(to_bt(panic_.limited_gravity(Vec3(g[0], g[1], g[2]))));
}

void World::apply_solver_settings() {
  bullet_->wake_all();
  bullet_->getSolverInfo().m_numIterations = static_cast<int>(store_.values(id_, *world_properties().iterations)[0]);
  bullet_->set_direct(store_.values(id_, *world_properties().solver)[0] != 0);
}

Result<void> World::act_reset(std::span<const double>) {
  request_reset();
  return {};
}

Result<void> World::act_panic(std::span<const double>) {
  request_panic();
  return {};
}

void World::flush() {
  store_.flush(thread_pool_.get());
  for (const auto& body : bodies_) {
    body->add_to_world();
    if (!body->update_moved_joints()) continue;
    for (const auto& gear : gears_) {
      if (gear->couples(*body)) gear->constraint().reset();
    }
  }
  update_gears();
}

void World::step() {
  if (thread_pool_ != nullptr && bullet_->getNumCollisionObjects() > kDefaultGrain) thread_pool_->wake();
  const double start_time = system::clock_seconds();
  if (!panic_.on()) behaviors_->step(timestep());
  const double flush_time = system::clock_seconds();
  flush();
  for (const auto& body : bodies_) body->prepare_step();
  log_overlaps();
  if (panic_.on()) force_accumulators_.discard();
  overlay_.capture_forces(force_accumulators_);
  force_accumulators_.apply();
  contacts_.begin_tick();
  const double physics_time = system::clock_seconds();
  const DirectCounts previous_counts = bullet_->direct_counts();
  bullet_->step(timestep() / substeps(), substeps());
  const double readout_time = system::clock_seconds();
  contacts_.end_tick();
  state_.tick++;
  publish_time();
  store_.mutable_values(id_, *world_properties().tick)[0] = static_cast<double>(state_.tick);
  publish_solver_counts(previous_counts);
  store_.mutable_values(id_, *world_properties().sleeping)[0] = bullet_->sleep().sleeping();
  publish_bodies();
  if (std::exchange(state_.body_restored, false)) flush_restored_bodies();
  camera_moves_.step();
  times_ = {flush_time - start_time, physics_time - flush_time, readout_time - physics_time,
            system::clock_seconds() - readout_time};
}

// Computes the time as a product, since a sum of timesteps would drift from it.
void World::publish_time() {
  if (timestep() != state_.last_timestep) {
    state_.last_timestep = timestep();
    state_.time_at_timestep_change = time();
    state_.tick_at_timestep_change = state_.tick - 1;
  }
  store_.mutable_values(id_, *world_properties().time)[0] =
      state_.time_at_timestep_change +
      static_cast<double>(state_.tick - state_.tick_at_timestep_change) * state_.last_timestep;
}

bool World::awake_bodies_valid() const {
  return awake_version_ == bullet_->sleep().version() && awake_structure_ == store_.structure_version();
}

// Adds the islands solved in this tick to the readouts.
void World::publish_solver_counts(const DirectCounts& before) {
  const DirectCounts now = bullet_->direct_counts();
  const auto add = [&](const Property* property, std::uint64_t count) {
    store_.mutable_values(id_, *property)[0] += static_cast<double>(count);
  };
  const std::uint64_t direct = now.direct - before.direct;
  add(world_properties().fallbacks, now.fallbacks - before.fallbacks);
  add(world_properties().islands_direct, direct);
  add(world_properties().islands_iterative, now.islands - before.islands - direct);
}

// Publishes the state of all awake bodies; a sleeping body's readouts don't change.
void World::publish_bodies() {
  const bool list_is_valid = awake_bodies_valid();
  if (!list_is_valid) {
    awake_bodies_.clear();
    for (const auto& body : bodies_) awake_bodies_.push_back(body.get());
  }
  const auto publish = [&](int, int first, int end) {
    for (int i = first; i < end; i++) {
      Body& body = *awake_bodies_[static_cast<std::size_t>(i)];
      if (body.in_world()) body.publish();
    }
  };
  parallel_for_ranges(thread_pool_.get(), static_cast<int>(awake_bodies_.size()), publish, kBodiesPerTask);
  for (Body* const body : awake_bodies_) {
    body->log_warnings();
    body->warn_slipping_joints();
    const Joint* const separated = body->consume_separated_joint();
    if (separated == nullptr) continue;
    restore_body(*body, separated->child(),
                 fmt::format("joint '{}' has come apart by {:.3g} m", separated->name(), separated->gap()));
  }
  warn_slipping_gears();
  if (list_is_valid) return;
  std::erase_if(awake_bodies_, [](const Body* body) { return body->asleep(); });
  awake_version_ = bullet_->sleep().version();
  awake_structure_ = store_.structure_version();
}

// Warns once about each gear that limits, locks or contacts keep from its position.
void World::warn_slipping_gears() {
  for (const auto& gear : gears_) {
    GearConstraint& constraint = gear->constraint();
    if (!constraint.is_slipping() || !constraint.report_slip()) continue;
    log_warning(
        "gear '{}': joint '{}/{}' is {:.3g} away from the position set by the gear: limits, locks or contacts prevent "
        "it. Widen the limits, or set max_force to let the gear slip",
        gear->name(), gear->joint_b().body().name(), gear->joint_b().name(), std::abs(constraint.error()));
  }
}

void World::after_internal_step(btDynamicsWorld* bullet, btScalar h) {
  World& world = *static_cast<World*>(bullet->getWorldUserInfo());
  if (world.panic_.on()) {
    world.panic_.damp(static_cast<double>(h));
    world.bullet_->refresh_joints();
  }
  world.contacts_.collect(*bullet->getDispatcher());
  // NaN and infinite values must not reach the next internal step, where they would spread
  if (!world.bullet_->is_unstable()) return;
  for (const auto& body : world.bodies_) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) {
      const char* const instability =
          part->is_static() ? nullptr : find_instability(part->rigid(), static_cast<double>(h));
      if (instability == nullptr) continue;
      world.restore_body(*body, *part, fmt::format("part '{}' {}", part->name(), instability));
      break;
    }
  }
}

void World::restore_body(Body& body, const Part& part, const std::string& instability) {
  state_.body_restored = true;
  if (body.restore_good_pose(part, instability)) state_.health_events++;
}

void World::flush_restored_bodies() {
  flush();
  for (const auto& body : bodies_) body->finish_restore();
}

void World::serialize(Archive& archive) {
  archive.serialize_all(state_, panic_, store_, contacts_, camera_moves_, force_accumulators_);
  for (const auto& body : bodies_) body->serialize(archive);
  for (const auto& gear : gears_) gear->serialize(archive);
  behaviors_->serialize(archive);
  if (archive.loading()) awake_version_ = 0;
}

std::uint64_t World::state_hash() const {
  std::uint64_t fixed = 0;
  for (const NodeId id : {id_, visuals_->id(), visuals_->camera().id(), visuals_->appearance().id()})
    fixed += fixed_node_hash(store_, id);
  NumberHash numbers(hash_bytes(panic_.on() ? "panic" : "limber") + fixed);
  for (const auto& shape : shapes_) numbers.add_word(persistent_hash(store_, shape->id()));
  for (const auto& gear : gears_) numbers.add_word(persistent_hash(store_, gear->id()));
  numbers.add(time(), static_cast<double>(state_.tick), static_cast<double>(seed()));
  std::uint64_t hash = numbers.value();
  for (const auto& body : bodies_) hash = body->state_hash(hash);
  return behaviors_->state_hash(hash);
}

}  // namespace limber

// World: its properties, its bodies, and the physical part of a tick.
#include "sim/world/world.h"

#include <utility>

#include "base/memory/archive.h"
#include "base/system/clock.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/island_world.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear_list.h"
#include "sim/mocap/mocap_list.h"
#include "sim/sensors/readouts.h"
#include "sim/shapes/shape_list.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"

namespace limber::sim {

namespace {

using namespace properties;

struct WorldProperties {
  const Property *timestep, *substeps, *iterations, *seed, *time, *tick, *solver, *fallbacks, *sleeping,
      *islands_direct, *islands_iterative;
};

const WorldProperties& world_properties() {
  static const auto at = [](const char* name) { return &World::table().at(name); };
  static const WorldProperties found{at("timestep"),
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

// Adds the islands solved in this tick to the readouts.
void publish_solver_counts(World& world, const solver::DirectCounts& before) {
  const solver::DirectCounts now = world.bullet().direct_counts();
  const auto add = [&](const Property* property, std::uint64_t count) {
    world.store().mutable_values(world.id(), *property)[0] += static_cast<double>(count);
  };
  const std::uint64_t direct = now.direct - before.direct;
  add(world_properties().fallbacks, now.fallbacks - before.fallbacks);
  add(world_properties().islands_direct, direct);
  add(world_properties().islands_iterative, now.islands - before.islands - direct);
}

// Applies pending property changes, and adds new parts and joints to Bullet's world.
void apply_changes(World& world) {
  world.store().flush(world.thread_pool());
  for (const auto& body : world.bodies()) body->add_to_world();
}

// Lets joints read the poses that were set.
void update_moved_joints(World& world) {
  for (const auto& body : world.bodies()) {
    if (body->update_moved_joints()) world.gears().reset_constraints(*body);
  }
  world.gears().update();
  world.tendons().update();
}

// Callbacks of the properties.

void apply_gravity(World& world) { world.panic().apply_gravity(); }

void apply_panic_motors(World& world) { world.panic().update_motors(); }

void apply_solver_settings(World& world) {
  bullet::IslandWorld& bullet = world.bullet();
  bullet.wake_all();
  bullet.getSolverInfo().m_numIterations =
      static_cast<int>(world.store().values(world.id(), *world_properties().iterations)[0]);
  bullet.set_direct(world.store().values(world.id(), *world_properties().solver)[0] != 0);
}

Result<void> request_reset(World& world, std::span<const double>) {
  world.requests().reset = true;
  return {};
}

Result<void> request_panic(World& world, std::span<const double>) {
  world.requests().panic = true;
  return {};
}

}  // namespace

const PropertyTable& World::table() {
  static const PropertyTable table(
      "sim", "/physics/sim", "/physics/sim",
      {
          on_change<&apply_gravity>(vec3("gravity", "m/s²", {0, 0, -9.81}, -1e4, 1e4, "Gravitational acceleration.")),
          number("timestep", "s", 1.0 / 60, 1e-5, 1, "Simulated time per tick."),
          integer("substeps", 4, 1, 1000, "Number of equal substeps in a tick; more are more accurate and slower."),
          on_change<&apply_solver_settings>(
              integer("solver_iterations", 50, 1, 10000, "Iterations of the contact and joint solver per substep.")),
          on_change<&apply_panic_motors>(
              choice("panic_motors", {"held", "limp"}, 0,
                     "Motors during a panic: they hold their position with their own strength, or are off.")),
          on_change<&apply_solver_settings>(
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
          invokes<&request_panic>(action("panic", 0, 0, Panic::kDoc)),
          transient(readout(integer("solver_fallbacks", 0, 0, kUnbounded,
                                    "Island steps in which the direct solver failed and the iterative one took over, "
                                    "since the start."))),
          transient(readout(integer("sleeping_parts", 0, 0, kUnbounded, "Number of sleeping parts."))),
          transient(
              readout(integer("islands_direct", 0, 0, kUnbounded,
                              "Island steps (an island: parts connected by joints or contacts) solved by the direct "
                              "solver, since the start."))),
          transient(readout(
              integer("islands_iterative", 0, 0, kUnbounded,
                      "Island steps solved by the iterative solver, regularly or as a fallback, since the start."))),
          computed<&read_world_momentum>(readout(vec3("momentum", "kg·m/s", {0, 0, 0}, -kUnbounded, kUnbounded,
                                                      "Total momentum of all parts that can move."))),
          computed<&read_world_angular_momentum>(
              readout(vec3("angular_momentum", "kg·m²/s", {0, 0, 0}, -kUnbounded, kUnbounded,
                           "Total angular momentum about the world's origin."))),
          computed<&read_world_kinetic_energy>(
              readout(number("kinetic_energy", "J", 0, 0, kUnbounded, "Total energy of motion and rotation."))),
          computed<&read_world_potential_energy>(
              readout(number("potential_energy", "J", 0, -kUnbounded, kUnbounded,
                             "Total energy in the gravity field; 0 at the world's origin."))),
          invokes<&request_reset>(action("reset", 0, 0, "Restarts the scene; values set by controllers stay.")),
      });
  return table;
}

World::World(Store& store, const WorldSetup& setup)
    : store_(store),
      thread_pool_(setup.thread_pool),
      id_(store.add(table(), store.add_group(store.root(), "physics"), "sim", this)),
      bodies_(store, store.add_group(store.parent(id_), "body")) {
  {
    const bullet::BulletMemory::Scope scope(&bullet_memory_);
    bullet_ = std::make_unique<bullet::IslandWorld>(setup);
  }
  const NodeId physics = store_.parent(id_);
  couplings_ = {std::make_unique<GearList>(*this, physics), std::make_unique<TendonList>(*this)};
  behaviors_ = std::make_unique<BehaviorList>(*this, physics);
  visuals_ = std::make_unique<Visuals>(*this);
  shapes_ = std::make_unique<ShapeList>(store_, visuals_->id(), transaction_);
  bullet_->setInternalTickCallback(&World::after_substep, this, false);
}

World::~World() { clear(); }

void World::clear() {
  panic_.end();
  behaviors_->clear();
  sensing_->mocap().clear();
  gears().clear();
  tendons().clear();
  bodies_.objects().clear();
  shapes_->clear();
  for (const Property& property : table().properties()) {
    if (property.kind == PropertyKind::setting)
      (void)store_.set(id_, property, {property.initial.data(), property.width});
  }
  visuals_->clear();
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

Result<Body*> World::add_body(std::string name) {
  if (const Result<void> available = bodies_.check_new_name("body", name); !available) return Error{available.error()};
  Body& body = bodies_.add(std::make_unique<Body>(*this, bodies_.group(), std::move(name)));
  transaction_.record_added(bodies_.objects());
  return &body;
}

Result<Body*> World::add_body(const std::shared_ptr<const model::BodyModel>& model, std::string name,
                              const BuildOptions& options) {
  Result<Body*> body = add_body(std::move(name));
  if (!body) return body;
  shapes_->add_visuals(*model);
  (*body)->build(model, options);
  return body;
}

Result<Body*> World::copy_body(const Body& source, std::string name) {
  Result<Body*> body = add_body(std::move(name));
  if (!body) return body;
  if (source.model() != nullptr && &source.world() != this) shapes_->add_visuals(*source.model());
  (*body)->build_copy(source);
  return body;
}

void World::remove_body(Body& body) {
  const std::size_t index = bodies_.index_of(body);
  if (index == bodies_.list().size()) return;
  gears().remove_from(body);
  tendons().remove_from(body);
  if (transaction_.active()) return transaction_.hide(bodies_.objects(), index);
  bodies_.objects().erase(bodies_.objects().begin() + static_cast<std::ptrdiff_t>(index));
}

void World::move_bodies_to_front(const std::vector<Body*>& first) { bodies_.move_to_front(first); }

std::vector<std::string_view> World::body_names() const {
  std::vector<std::string_view> names;
  for (const auto& body : bodies()) names.push_back(body->name());
  return names;
}

double World::time() const { return store_.values(id_, *world_properties().time)[0]; }
double World::timestep() const { return store_.values(id_, *world_properties().timestep)[0]; }
int World::substeps() const { return static_cast<int>(store_.values(id_, *world_properties().substeps)[0]); }
std::uint64_t World::seed() const {
  return static_cast<std::uint64_t>(store_.values(id_, *world_properties().seed)[0]);
}

void World::flush() {
  apply_changes(*this);
  part_inputs_.kinematics.place();
  update_moved_joints(*this);
  visuals_->fixtures().step(0);
}

TickTimes World::step() {
  if (thread_pool_ != nullptr && bullet_->getNumCollisionObjects() > kDefaultGrain) thread_pool_->wake();
  const double start_time = system::clock_seconds();
  if (!panic_.on()) {
    sensing_->mocap().step(timestep());
    behaviors_->step(timestep());
  }
  const double flush_time = system::clock_seconds();
  apply_changes(*this);
  part_inputs_.kinematics.begin_tick(timestep());
  update_moved_joints(*this);
  for (const auto& body : bodies()) {
    body->recovery().save_new_start_pose();
    body->pairs().find_new_overlaps(overlaps_);
  }
  overlaps_.log();
  if (panic_.on()) part_inputs_.forces.discard();
  visuals_->overlay().capture_forces(part_inputs_.forces);
  sensing_->begin_tick();
  part_inputs_.forces.apply();
  const double physics_time = system::clock_seconds();
  const solver::DirectCounts previous_counts = bullet_->direct_counts();
  bullet_->step(timestep() / substeps(), substeps());
  const double readout_time = system::clock_seconds();
  sensing_->end_contacts();
  store_.mutable_values(id_, *world_properties().time)[0] = state_.end_tick(timestep(), time());
  store_.mutable_values(id_, *world_properties().tick)[0] = static_cast<double>(state_.tick);
  behaviors_->clock().step();
  publish_solver_counts(*this, previous_counts);
  store_.mutable_values(id_, *world_properties().sleeping)[0] = bullet_->sleep().sleeping();
  awake_bodies_.publish();
  tendons().publish();
  part_inputs_.kinematics.end_tick();
  sensing_->end_tick();
  gears().warn_slipping();
  stability_.end_tick();
  visuals_->camera_moves().step();
  visuals_->fixtures().step(timestep());
  return {flush_time - start_time, physics_time - flush_time, readout_time - physics_time,
          system::clock_seconds() - readout_time};
}

double World::State::end_tick(double timestep, double time) {
  if (timestep != last_timestep) {
    last_timestep = timestep;
    time_at_timestep_change = time;
    tick_at_timestep_change = tick;
  }
  tick++;
  return time_at_timestep_change + static_cast<double>(tick - tick_at_timestep_change) * last_timestep;
}

void World::after_substep(btDynamicsWorld* bullet, btScalar h) {
  World& world = *static_cast<World*>(bullet->getWorldUserInfo());
  if (world.panic_.on()) {
    world.panic_.damp(static_cast<double>(h));
    world.bullet_->refresh_joints();
  }
  world.sensing_->end_substep(static_cast<double>(h));
  world.stability_.check_parts(static_cast<double>(h));
}

void World::serialize(Archive& archive) {
  archive.serialize_all(state_, stability_, panic_, store_, *sensing_, visuals_->camera_moves(), part_inputs_.forces);
  for (const auto& body : bodies()) body->serialize(archive);
  archive.serialize_all(gears(), tendons(), *behaviors_);
  if (!archive.loading()) return;
  awake_bodies_.invalidate();
  part_inputs_.kinematics.restore();
}

}  // namespace limber::sim

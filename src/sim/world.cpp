// World: its rows, its bodies and shapes, the physical half of a tick.
#include "sim/world.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "params/values_hash.h"
#include "sim/health.h"

namespace limber {

namespace {

using namespace rows;

/// Bodies that are read out at a time; it changes no result.
constexpr int kBodies = 4;

struct WorldRows {
  const Row *gravity, *timestep, *substeps, *iterations, *seed, *time, *tick, *solver, *fallbacks, *sleeping,
      *islands_direct, *islands_iterative;
};

const WorldRows& world_rows() {
  static const auto at = [](const char* name) { return &World::table().at(name); };
  static const WorldRows found{at("gravity"),
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

const Table& World::table() {
  static const Table table(
      "sim", "/physics/sim", "/physics/sim",
      {
          effect<&World::effect_gravity>(
              vec3("gravity", "m/s²", {0, 0, -9.81}, -1e4, 1e4, "Acceleration of everything that moves.")),
          number("timestep", "s", 1.0 / 60, 1e-5, 1, "What a tick advances the time by."),
          integer("substeps", 4, 1, 1000, "Equal internal steps that a tick is made of."),
          effect<&World::effect_solver>(integer("solver_iterations", 50, 1, 10000,
                                                "Rounds of the contact and joint solver in each internal step.")),
          effect<&World::effect_panic_motors>(
              choice("panic_motors", {"held", "limp"}, 0,
                     "What motors do while a panic holds: stay where they are, with their own strength, or nothing.")),
          effect<&World::effect_solver>(
              choice("solver", {"iterative", "direct"}, 1,
                     "How joints are solved: in rounds with the contacts, or exactly, as trees.")),
          live(state(
              integer("seed", 1, 0, 9007199254740992,
                      "What every random draw derives from: a behaviour's at once, a scene's from the next start."))),
          live(state(boolean("paused", false, "Time stands still; commands and OSC are still answered."))),
          live(state(number("speed", "× real time", 1, 0.01, 100, "How fast simulated time runs when it is paced."))),
          live(state(number("history", "s", 30, 0, 30, "Of the past that is kept for /transport/rewind; 0: nothing."))),
          live(readout(number("time", "s", 0, 0, kUnbounded, "Simulated time."))),
          live(readout(integer("tick", 0, 0, kUnbounded, "Ticks since the start."))),
          live(readout(boolean("panicked", false, "A panic holds: everything comes to rest."))),
          act<&World::act_panic>(action("panic", 0, 0, Panic::kDoc)),
          live(readout(integer("solver_fallbacks", 0, 0, kUnbounded,
                               "Steps of islands that the direct solver left to the iterative one, since the start."))),
          live(readout(integer("sleeping_parts", 0, 0, kUnbounded, "Parts that are asleep, at rest."))),
          live(readout(integer("islands_direct", 0, 0, kUnbounded,
                               "Steps of islands (parts that joints or contacts connect) that the direct solver "
                               "solved, since the start."))),
          live(readout(integer("islands_iterative", 0, 0, kUnbounded,
                               "Steps of islands that the iterative solver solved, by rule or as a fallback, since the "
                               "start."))),
          act<&World::act_reset>(action("reset", 0, 0, "The scene from its start, with the performer's values.")),
      });
  return table;
}

World::World(Store& store, const WorldSetup& setup) : store_(store), team_(setup.team) {
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
  for (const Row& row : table().rows()) {
    if (row.kind == RowKind::property) (void)store_.set(id_, row, {row.initial.data(), row.width});
  }
  visuals_->clear();
  camera_moves_.stop();
}

void World::restart_time(std::uint64_t tick, double time) {
  tick_ = tick;
  timestep_since_ = 0;
  store_.tell(id_, *world_rows().time)[0] = time;
  store_.tell(id_, *world_rows().tick)[0] = static_cast<double>(tick);
  for (const Row* row : {world_rows().fallbacks, world_rows().islands_direct, world_rows().islands_iterative}) {
    store_.tell(id_, *row)[0] = 0;
  }
}

Result<void> World::name_is_free(NodeId group, std::string_view kind, std::string_view name) const {
  if (const auto fault = name_fault(name)) return Error{fmt::format("{}: {}", kind, *fault)};
  if (store_.child(group, name).null()) return {};
  return Error{fmt::format("there is a {} '{}' already; names are unique", kind, name)};
}

Result<Body*> World::add_body(std::string name) {
  if (const Result<void> free = name_is_free(body_group_, "body", name); !free) return Error{free.error()};
  bodies_.push_back(std::make_unique<Body>(*this, body_group_, std::move(name)));
  undo_.made_body();
  return bodies_.back().get();
}

Result<Body*> World::add_body(const std::shared_ptr<const BodyModel>& model, std::string name,
                              const BuildOptions& options) {
  Result<Body*> body = add_body(std::move(name));
  if (!body) return body;
  add_shapes_of(*model);
  (*body)->build(model, options);
  return body;
}

Result<Body*> World::copy_body(const Body& source, std::string name) {
  Result<Body*> body = add_body(std::move(name));
  if (!body) return body;
  if (source.model() != nullptr && &source.world() != this) add_shapes_of(*source.model());
  (*body)->build_copy(source);
  return body;
}

void World::remove_body(Body& body) {
  const auto at = std::ranges::find_if(bodies_, [&](const std::unique_ptr<Body>& b) { return b.get() == &body; });
  if (at == bodies_.end()) return;
  for (std::size_t i = gears_.size(); i-- > 0;) {
    if (gears_[i]->couples(body)) remove_gear(*gears_[i]);
  }
  gears_changed();  // its mimic relations no longer count
  if (undo_.active()) undo_.hide(std::move(*at), static_cast<std::size_t>(at - bodies_.begin()));
  bodies_.erase(at);
}

Body* World::find_body(std::string_view name) const {
  const NodeId id = store_.child(body_group_, name);
  return id.null() ? nullptr : static_cast<Body*>(store_.thing(id));
}

std::vector<std::string_view> World::body_names() const {
  std::vector<std::string_view> names;
  for (const auto& body : bodies_) names.push_back(body->name());
  return names;
}

Result<Shape*> World::add_shape(std::string name, ShapeModel model) {
  if (const Result<void> free = name_is_free(shape_group_, "shape", name); !free) return Error{free.error()};
  if (const Result<void> possible = check_shape(model); !possible) {
    return Error{fmt::format("shape '{}': {}", name, possible.error())};
  }
  shapes_.push_back(std::make_unique<Shape>(store_, shape_group_, std::move(name), std::move(model)));
  undo_.made_shape();
  return shapes_.back().get();
}

Shape* World::find_shape(std::string_view name) const {
  const NodeId id = store_.child(shape_group_, name);
  return id.null() ? nullptr : static_cast<Shape*>(store_.thing(id));
}

const std::vector<std::shared_ptr<const Geometry>>& World::geometries_of(
    const std::shared_ptr<const BodyModel>& model) {
  ModelGeometry& known = geometries_[model.get()];
  if (known.model == nullptr) {
    known.model = model;
    for (const LinkModel& link : model->links) known.links.push_back(make_geometry(link.collisions, link.inertial));
  }
  return known.links;
}

double World::time() const { return store_.values(id_, *world_rows().time)[0]; }
double World::timestep() const { return store_.values(id_, *world_rows().timestep)[0]; }
int World::substeps() const { return static_cast<int>(store_.values(id_, *world_rows().substeps)[0]); }
std::uint64_t World::seed() const { return static_cast<std::uint64_t>(store_.values(id_, *world_rows().seed)[0]); }

void World::effect_gravity() {
  const double* g = store_.values(id_, *world_rows().gravity);
  bullet_->setGravity(to_bt(panic_.weight(Vec3(g[0], g[1], g[2]))));
}

void World::effect_solver() {
  bullet_->wake_all();
  bullet_->getSolverInfo().m_numIterations = static_cast<int>(store_.values(id_, *world_rows().iterations)[0]);
  bullet_->set_direct(store_.values(id_, *world_rows().solver)[0] != 0);
}

Result<void> World::act_reset(std::span<const double>) {
  reset_asked_ = true;
  return {};
}

Result<void> World::act_panic(std::span<const double>) {
  panic_asked_ = true;
  return {};
}

void World::settle() {
  store_.apply_marks(team_.get());
  for (const auto& body : bodies_) {
    body->enter();
    if (!body->settle_joints()) continue;
    for (const auto& gear : gears_) {
      if (gear->couples(*body)) gear->constraint().reset();
    }
  }
  settle_gears();
}

void World::step() {
  if (team_ != nullptr && bullet_->getNumCollisionObjects() > kPlaces) team_->rouse();
  const double begin = system::clock_seconds();
  if (!panic_.on()) behaviors_->step(timestep());
  const double start = system::clock_seconds();
  settle();
  for (const auto& body : bodies_) {
    if (std::exchange(body->fresh_, false)) body->take_start_pose();
    if (body->has_unchecked_parts()) body->find_overlaps();
  }
  log_overlaps();
  if (panic_.on()) loads_.drop();
  overlay_.take_loads(loads_);
  loads_.push();
  contacts_.begin_tick();
  const double before = system::clock_seconds();
  const DirectCounts solved = bullet_->direct_counts();
  bullet_->step(timestep() / substeps(), substeps());
  const double after = system::clock_seconds();
  contacts_.end_tick();
  tick_++;
  tell_time();
  store_.tell(id_, *world_rows().tick)[0] = static_cast<double>(tick_);
  tell_solved(solved);
  store_.tell(id_, *world_rows().sleeping)[0] = bullet_->sleep().sleeping();
  tell_bodies();
  if (std::exchange(healed_, false)) settle_healed();
  camera_moves_.step();
  times_ = {start - begin, before - start, after - before, system::clock_seconds() - after};
}

// A sum of timesteps would drift from their product.
void World::tell_time() {
  if (timestep() != timestep_since_) {
    timestep_since_ = timestep();
    time_then_ = time();
    tick_then_ = tick_ - 1;
  }
  store_.tell(id_, *world_rows().time)[0] = time_then_ + static_cast<double>(tick_ - tick_then_) * timestep_since_;
}

bool World::awake_bodies_known() const {
  return awake_version_ == bullet_->sleep().version() && awake_structure_ == store_.structure_version();
}

// Adds the islands of this tick to the readouts.
void World::tell_solved(const DirectCounts& before) {
  const DirectCounts now = bullet_->direct_counts();
  const auto add = [&](const Row* row, std::uint64_t count) {
    store_.tell(id_, *row)[0] += static_cast<double>(count);
  };
  const std::uint64_t direct = now.direct - before.direct;
  add(world_rows().fallbacks, now.fallbacks - before.fallbacks);
  add(world_rows().islands_direct, direct);
  add(world_rows().islands_iterative, now.islands - before.islands - direct);
}

// Bodies that sleep keep what was read of them when they fell asleep.
void World::tell_bodies() {
  const bool known = awake_bodies_known();
  if (!known) {
    awake_bodies_.clear();
    for (const auto& body : bodies_) awake_bodies_.push_back(body.get());
  }
  const auto tell = [&](int, int first, int end) {
    for (int i = first; i < end; i++) {
      Body& body = *awake_bodies_[static_cast<std::size_t>(i)];
      if (!body.in_world()) continue;
      body.torn_ = nullptr;
      body.tell();
      if (!body.broken_ && body.torn_ == nullptr) body.take_good_pose();
    }
  };
  share_out_places(team_.get(), static_cast<int>(awake_bodies_.size()), tell, kBodies);
  for (Body* const body : awake_bodies_) {
    body->say_caps();
    body->report_slips();
    Joint* const torn = std::exchange(body->torn_, nullptr);
    if (torn == nullptr || body->broken_) continue;
    heal(*body, torn->child(), fmt::format("joint '{}' has come apart by {:.3g} m", torn->name(), torn->gap()));
  }
  report_slips();
  if (known) return;
  std::erase_if(awake_bodies_, [](const Body* body) { return body->asleep(); });
  awake_version_ = bullet_->sleep().version();
  awake_structure_ = store_.structure_version();
}

// Of the world's own gears.
void World::report_slips() {
  for (const auto& gear : gears_) {
    GearConstraint& constraint = gear->constraint();
    if (!constraint.slips() || !constraint.report_slip()) continue;
    log_warning(
        "gear '{}': joint '{}/{}' is {:.3g} away from its position by the gear: limits, locks or contacts hold it. "
        "Widen the limits, or set max_force for a gear that slips",
        gear->name(), gear->joint_b().body().name(), gear->joint_b().name(), std::abs(constraint.error()));
  }
}

void World::after_internal_step(btDynamicsWorld* bullet, btScalar h) {
  World& world = *static_cast<World*>(bullet->getWorldUserInfo());
  if (world.panic_.on()) {
    world.panic_.brake(static_cast<double>(h));
    world.bullet_->refresh_joints();
  }
  world.contacts_.gather(*bullet->getDispatcher());
  // what is no number must not reach the next internal step, where it would spread
  if (!world.bullet_->ails()) return;
  for (const auto& body : world.bodies_) {
    if (!body->in_world()) continue;
    for (const auto& part : body->parts()) {
      const char* const what = part->is_static() ? nullptr : ailment(part->rigid(), static_cast<double>(h));
      if (what == nullptr) continue;
      world.heal(*body, *part, fmt::format("part '{}' {}", part->name(), what));
      break;
    }
  }
}

void World::heal(Body& body, const Part& part, const std::string& what) {
  const bool known = body.broken_;
  const std::string cause = known ? "" : likely_cause(body, part, *bullet_->getDispatcher(), substeps());
  for (std::size_t i = 0; i < body.parts_.size(); i++) {
    Part& each = *body.parts_[i];
    each.set_pose(i < body.good_poses_ ? body.last_good_[i] : each.start_pose());
    each.set_velocity(Vec3(0), Vec3(0));
    each.effect_pose();
    each.effect_velocity();
    each.wake();  // with what touches it: its contacts are forgotten below
    // the force that did it would do it again in this tick's next internal step
    each.rigid().clearForces();
    each.rigid().applyGravity();
    // and contacts start from the impulses that held them before
    if (each.rigid().isInWorld()) {
      bullet_->getPairCache()->cleanProxyFromPairs(each.rigid().getBroadphaseHandle(), bullet_->getDispatcher());
    }
  }
  for (const auto& joint : body.joints_) joint->read_anew();
  healed_ = true;
  if (std::exchange(body.broken_, true)) return;  // said in this tick
  health_events_++;
  if (std::exchange(body.restored_once_, true)) {
    body.set_enabled(false);
    log_warning("body '{}': {} again; the body is switched off (reset or enabled = true brings it back); {}",
                body.name(), what, cause);
  } else {
    log_warning("body '{}': {}; the body is put back to its last good pose, at rest; {}", body.name(), what, cause);
  }
}

void World::settle_healed() {
  settle();
  for (const auto& body : bodies_) {
    if (!std::exchange(body->broken_, false)) continue;
    for (const auto& part : body->parts()) part->rigid().clearForces();  // those for a next internal step
  }
}

std::uint64_t World::state_hash() const {
  std::uint64_t fixed = 0;
  for (const NodeId id : {id_, visuals_->id(), visuals_->camera().id(), visuals_->look().id()})
    fixed += fixed_node_hash(store_, id);
  NumberHash numbers(hash_bytes(panic_.on() ? "panic" : "limber") + fixed);
  for (const auto& shape : shapes_) numbers.add_word(kept_hash(store_, shape->id()));
  for (const auto& gear : gears_) numbers.add_word(kept_hash(store_, gear->id()));
  numbers.add(time(), static_cast<double>(tick_), static_cast<double>(seed()));
  std::uint64_t hash = numbers.value();
  for (const auto& body : bodies_) hash = body->state_hash(hash);
  return behaviors_->state_hash(hash);
}

}  // namespace limber

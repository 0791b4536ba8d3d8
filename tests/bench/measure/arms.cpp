// Builds and drives the arms; interleaved measurement of Limber and plain Bullet.
#include "bench/measure/arms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "base/check.h"
#include "base/system/process.h"
#include "bench/measure/times.h"
#include "sim/bullet/bullet_phases.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "support/world_objects.h"

namespace limber {

namespace {

engine::EngineOptions options_with(int threads) {
  engine::EngineOptions options;
  options.threads = threads;
  return options;
}

using Json = nlohmann::ordered_json;

constexpr int kRound = 4;  // consecutive ticks of Limber or plain Bullet before the other runs
// maximal number of ticks with phase counters inside Bullet, which cost some time themselves
constexpr int kPhaseTicks = 8;

void set(Store& store, NodeId id, const PropertyTable& table, const char* property, std::vector<double> values) {
  LIMBER_CHECK(store.set(id, table.at(property), values).ok());
}

// share of the tick outside of the physics
double overhead_share(const engine::PhaseTimes& t) {
  return (t.commands + t.scripts + t.behaviors + t.callbacks + t.readouts + t.snapshot + t.gc) / (t.total() + t.gc);
}

// samples of Limber or of plain Bullet
struct ArmSide {
  TimeSamples ticks;  // wall time
  TimeSamples work;   // processor time
  double gap = 0;
  double error = 0;

  template <class Loop>
  void play(Loop& loop, double& time, const ArmScene& scene, int count, const std::function<void()>& after = {}) {
    for (int i = 0; i < count; i++) {
      loop.drive(time);
      const double work_start = system::thread_seconds();
      const double start = system::clock_seconds();
      loop.tick();
      ticks.add(system::clock_seconds() - start);
      work.add(system::thread_seconds() - work_start);
      if (after) after();
      time += scene.step * scene.substeps;
    }
    gap = std::max(gap, loop.joint_gap());
    error = std::max(error, loop.servo_error(time));
  }
  Json figures() const {
    return {{"tick_us", ticks.microseconds()},
            {"joint_gap_mm", rounded(gap * 1e3, 2)},
            {"servo_error_rad", rounded(error, 3)}};
  }
};

// phases of the engine's tick
struct Phases {
  TimeSamples commands, scripts, behaviors, effects, physics, readouts, snapshot, collector, overhead, snapshot_part;

  void add(const engine::PhaseTimes& t) {
    commands.add(t.commands);
    scripts.add(t.scripts);
    behaviors.add(t.behaviors);
    effects.add(t.callbacks);
    physics.add(t.physics);
    readouts.add(t.readouts);
    snapshot.add(t.snapshot);
    collector.add(t.gc);
    overhead.add(overhead_share(t));
    snapshot_part.add(t.snapshot / (t.total() + t.gc));
  }
  Json microseconds() const {
    const auto median = [](const TimeSamples& s) { return TimeSamples::in_microseconds(s.quantile(0.5)); };
    return {{"commands", median(commands)}, {"scripts", median(scripts)},    {"behaviors", median(behaviors)},
            {"effects", median(effects)},   {"physics", median(physics)},    {"readouts", median(readouts)},
            {"snapshot", median(snapshot)}, {"collector", median(collector)}};
  }
};

// memory of the arms in a plain loop, without the world
double raw_bytes_per_part(const ArmScene& scene) {
  ArmScene none = scene;
  none.arms = 0;
  const double before = system::heap_bytes();
  RawLoop empty(none);
  const double world = system::heap_bytes() - before;
  RawLoop full(scene);
  for (int i = 0; i < 2; i++) full.tick();
  return (system::heap_bytes() - before - 2 * world) / (scene.arms * (scene.parts + 1));
}

// phases inside Bullet, of the fastest tick
Json bullet_phases(BenchArms& arms, int ticks) {
  sim::bullet::BulletPhases best;
  double best_sum = 0;
  for (int i = 0; i < ticks; i++) {
    arms.drive(arms.time());
    const sim::bullet::BulletPhaseCounter counter;
    arms.tick();
    const sim::bullet::BulletPhases& p = counter.phases();
    const double sum = p.broadphase + p.narrowphase + p.islands + p.solver;
    if (i > 0 && sum >= best_sum) continue;
    best = p;
    best_sum = sum;
  }
  return {{"broadphase", TimeSamples::in_microseconds(best.broadphase)},
          {"narrowphase", TimeSamples::in_microseconds(best.narrowphase)},
          {"islands", TimeSamples::in_microseconds(best.islands)},
          {"solver", TimeSamples::in_microseconds(best.solver)}};
}

}  // namespace

int default_iterations() { return static_cast<int>(sim::World::table().at("solver_iterations").initial[0]); }

ArmScene arm_scene(int arms) {
  ArmScene scene;
  scene.arms = arms;
  scene.solver_iterations = default_iterations();
  return scene;
}

ArmScene direct_arm_scene(int arms) {
  ArmScene scene = arm_scene(arms);
  scene.step = 1.0 / 60;
  scene.substeps = 1;
  scene.direct = true;
  return scene;
}

BenchArms::BenchArms(const ArmScene& scene, int threads) : scene_(scene), engine_(link_, options_with(threads)) {
  LIMBER_CHECK(engine_.start().ok());
  sim::World& world = engine_.world();
  heap_when_empty_ = system::heap_bytes();
  set(world.store(), world.id(), sim::World::table(), "timestep", {scene.step * scene.substeps});
  set(world.store(), world.id(), sim::World::table(), "substeps", {static_cast<double>(scene.substeps)});
  set(world.store(), world.id(), sim::World::table(), "solver_iterations",
      {static_cast<double>(scene.solver_iterations)});
  set(world.store(), world.id(), sim::World::table(), "solver", {scene.direct ? 1.0 : 0.0});
  model::ShapeModel box;
  box.size = scene.size;
  model::ShapeModel plane;
  plane.kind = model::ShapeKind::plane;
  add_floor(**world.shapes().add("plane", plane));
  sim::Shape& shape = **world.shapes().add("box", box);
  for (int arm = 0; arm < scene.arms; arm++) add_arm(arm, shape);
}

void BenchArms::add_floor(sim::Shape& plane) {
  sim::Body& floor = **engine_.world().add_body("floor");
  LIMBER_CHECK(floor.add_part("plane", plane, 0, Pose{}).ok());
}

void BenchArms::add_arm(int arm, sim::Shape& box) {
  Store& store = engine_.store();
  sim::Body& body = **engine_.world().add_body(fmt::format("arm{}", arm + 1));
  sim::Part* below = *body.add_part("base", box, 0, {scene_.center(arm, -1), quat_identity()});
  for (int i = 0; i < scene_.parts; i++) {
    sim::Part* above =
        *body.add_part(fmt::format("part{}", i + 1), box, scene_.mass, {scene_.center(arm, i), quat_identity()});
    const Vec3 position = scene_.center(arm, i) + scene_.to_joint();
    const Vec3 axis = ArmScene::axis(i) == 0 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    sim::Joint& joint =
        **body.add_joint(fmt::format("joint{}", i + 1), *below, *above, model::JointType::revolute, position, axis);
    set(store, joint.id(), sim::Joint::table(), "angular_lower_limit", {0, 0, -scene_.limit});
    set(store, joint.id(), sim::Joint::table(), "angular_upper_limit", {0, 0, scene_.limit});
    const sim::Motor& motor = **body.add_motor(joint);
    set(store, motor.id(), sim::Motor::table(), "angular_velocity", {0, 0, scene_.speed});
    set(store, motor.id(), sim::Motor::table(), "max_angular_force", {0, 0, scene_.force});
    joints_.push_back(&joint);
    below = above;
  }
}

void BenchArms::drive(double time) {
  for (std::size_t i = 0; i < joints_.size(); i++) {
    joints_[i]->motor()->set_target(ArmScene::target(static_cast<int>(i) % scene_.parts, time));
  }
}

double BenchArms::joint_gap() const {
  double gap = 0;
  for (const sim::Joint* joint : joints_) gap = std::max(gap, glm::length(joint->constraint().pose().offsets()));
  return gap;
}

double BenchArms::servo_error(double time) const {
  double error = 0;
  for (std::size_t i = 0; i < joints_.size(); i++) {
    const double target = ArmScene::target(static_cast<int>(i) % scene_.parts, time);
    error = std::max(error, std::abs(joints_[i]->value() - target));
  }
  return error;
}

nlohmann::ordered_json measure_arms(const ArmScene& scene, int warm_ticks, int ticks, bool compare_raw) {
  const double moving = scene.arms * (scene.parts + 1);
  ArmSide warm, ours, bare;
  BenchArms arms(scene);
  double time = arms.time();
  warm.play(arms, time, scene, warm_ticks);
  const double bytes = (system::heap_bytes() - arms.heap_when_empty()) / moving;
  std::unique_ptr<RawLoop> raw;
  double raw_time = 0;
  if (compare_raw) {
    raw = std::make_unique<RawLoop>(scene);
    warm.play(*raw, raw_time, scene, warm_ticks);
  }

  Phases phases;
  for (int done = 0; done < ticks; done += kRound) {
    const int count = std::min(kRound, ticks - done);
    ours.play(arms, time, scene, count, [&] { phases.add(arms.engine().times()); });
    if (raw) bare.play(*raw, raw_time, scene, count);
  }

  Json figures = {{"parts", static_cast<int>(moving)},
                  {"settings",
                   {{"timestep_s", scene.step * scene.substeps},
                    {"substeps", scene.substeps},
                    {"solver_iterations", scene.solver_iterations}}},
                  {"ticks", ticks}};
  figures.update(ours.figures());
  figures["simulated_seconds_per_second"] = rounded(scene.step * scene.substeps / ours.ticks.quantile(0.5), 2);
  figures["phases_us"] = phases.microseconds();
  figures["around_physics_percent"] = rounded(100 * phases.overhead.quantile(0.5), 2);
  figures["snapshot_percent"] = rounded(100 * phases.snapshot_part.quantile(0.5), 2);
  figures["hash"] = fmt::format("{:016x}", arms.engine().state_hash());
  figures["bullet_us"] = bullet_phases(arms, std::min(ticks, kPhaseTicks));
  figures["bytes_per_part"] = rounded(bytes, 0);
  if (!raw) return figures;
  figures["raw"] = bare.figures();
  figures["raw"]["bytes_per_part"] = rounded(raw_bytes_per_part(scene), 0);
  const auto ratio = [](const TimeSamples& a, const TimeSamples& b, double part) {
    return rounded(a.quantile(part) / b.quantile(part), 3);
  };
  figures["ratio"] = {{"min", ratio(ours.ticks, bare.ticks, 0)},
                      {"median", ratio(ours.ticks, bare.ticks, 0.5)},
                      {"processor_min", ratio(ours.work, bare.work, 0)},
                      {"processor_median", ratio(ours.work, bare.work, 0.5)}};
  return figures;
}

}  // namespace limber

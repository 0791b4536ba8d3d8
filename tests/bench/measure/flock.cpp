// A flock in a cube; the engine's phase times give the cost of the behaviors.
#include "bench/measure/measures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/check.h"
#include "base/random.h"
#include "bench/measure/times.h"
#include "engine/engine.h"
#include "support/world_objects.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kNeighbors = 30;
constexpr double kNeighborDistance = 1;  // m

void set(Store& store, NodeId id, std::string_view property, double value) {
  LIMBER_CHECK(store.set(id, property, {&value, 1}).ok());
}

// balls with random velocities in a cube; its size gives the desired number of neighbors
void add_balls(sim::World& world, int bodies) {
  model::ShapeModel ball;
  ball.kind = model::ShapeKind::sphere;
  ball.radius = 0.02;
  sim::Shape& shape = **world.shapes().add("ball", ball);
  const double side =
      std::cbrt(bodies * 4.0 / 3 * kPi * kNeighborDistance * kNeighborDistance * kNeighborDistance / kNeighbors);
  Random random(1, "flock");
  const Vec3 half(side / 2);
  const auto between = [&](const Vec3& size) {
    return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * size;
  };
  for (int i = 0; i < bodies; i++) {
    sim::Body& body = **world.add_body(fmt::format("ball{}", i + 1));
    sim::Part& part = **body.add_part("ball", shape, 0.1, {between(half), quat_identity()});
    part.set_velocity(between(Vec3(0.1)), between(Vec3(0.1)));
  }
}

sim::BehaviorGroup& add_group(sim::World& world, const char* type) {
  sim::GroupSetup setup;
  setup.bodies = sim::Selection({"ball*"});
  sim::BehaviorGroup& group = **world.behaviors().add_group(type, type, setup);
  set(world.store(), group.id(), "max_dist", kNeighborDistance);
  set(world.store(), group.id(), "amount", 1e-4);
  return group;
}

// mean number of neighbors over all parts, including those at the faces of the cube
double mean_neighbors(sim::BehaviorGroup& group) {
  std::vector<sim::Part*> parts;
  for (const auto& member : group.members()) parts.push_back(member->parts().front());
  double sum = 0;
  for (const sim::NeighborMeans& means : group.neighbors().means(parts, 0, kNeighborDistance, sim::kWantVelocity))
    sum += means.count;
  return sum / static_cast<double>(parts.size());
}

}  // namespace

nlohmann::ordered_json measure_flock(int bodies, const MeasureOptions& options) {
  engine::EngineLink link;
  engine::Engine engine(link, engine::EngineOptions{});
  LIMBER_CHECK(engine.start().ok());
  sim::World& world = engine.world();
  const double gravity[] = {0, 0, 0};
  LIMBER_CHECK(world.store().set(world.id(), "gravity", gravity).ok());
  set(world.store(), world.id(), "substeps", 1);
  add_balls(world, bodies);
  sim::BehaviorGroup& cohesion = add_group(world, "cohesion");
  sim::BehaviorGroup& alignment = add_group(world, "alignment");
  const int usual = std::clamp(400000 / bodies, 5, 200);
  const int ticks = options.ticks > 0 ? options.ticks : usual;
  TimeSamples behaviors, cohesions, alignments, ticks_whole;
  for (int i = -3; i < ticks; i++) {
    engine.tick();
    if (i < 0) continue;
    behaviors.add(engine.times().behaviors);
    cohesions.add(cohesion.seconds_per_member() * bodies);
    alignments.add(alignment.seconds_per_member() * bodies);
    ticks_whole.add(engine.times().total());
  }
  return {{"bodies", bodies},
          {"neighbors", rounded(mean_neighbors(cohesion), 1)},
          {"ticks", ticks},
          {"behaviors_us", behaviors.microseconds()},
          {"behaviors_ns_a_part", rounded(1e9 * behaviors.quantile(0) / bodies, 1)},
          {"cohesion_us", cohesions.microseconds()},
          {"alignment_us", alignments.microseconds()},
          {"tick_us", ticks_whole.microseconds()},
          {"hash", fmt::format("{:016x}", engine.state_hash())}};
}

}  // namespace limber

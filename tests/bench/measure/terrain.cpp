// A hundred quadrupeds on 512 × 512 heights against a plane, tick by tick in turns.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/check.h"
#include "bench/measure/measures.h"
#include "bench/measure/times.h"
#include "engine/engine.h"
#include "model/mesh/heightfield.h"
#include "model/model_library.h"
#include "sim/shapes/shape_list.h"
#include "support/world_objects.h"

namespace limber {

namespace {

constexpr int kDogs = 100;
constexpr int kSide = 512;

model::ShapeModel hills() {
  std::vector<double> heights;
  heights.reserve(std::size_t{kSide} * kSide);
  for (int row = 0; row < kSide; row++) {
    for (int column = 0; column < kSide; column++)
      heights.push_back(0.05 * fixed::sin(0.11 * column) * fixed::sin(0.13 * row));
  }
  return *model::heightfield_shape({kSide, kSide, 30, 30, heights}, "hills");
}

/// Quadrupeds that trot on the spot, 2 m apart.
class Herd {
 public:
  Herd(const std::shared_ptr<const model::BodyModel>& dog, const model::ShapeModel& ground)
      : engine_(link_, engine::EngineOptions{}) {
    LIMBER_CHECK(engine_.start().ok());
    sim::World& world = engine_.world();
    sim::Shape& shape = **world.shapes().add("ground", ground);
    LIMBER_CHECK((*world.add_body("ground"))->add_part("ground", shape, 0, Pose{}).ok());
    for (int i = 0; i < kDogs; i++) {
      sim::BuildOptions options;
      options.position = Vec3(2.0 * (i % 10) - 9, 2.0 * (i - i % 10) / 10 - 9, 0.43);
      LIMBER_CHECK(world.add_body(dog, fmt::format("dog{}", i), options).ok());
    }
  }
  /// Plays a tick and returns its duration in seconds.
  double tick() {
    const double start = system::clock_seconds();
    const double phase = 2 * kPi * 2 * engine_.world().time();
    for (const auto& body : engine_.world().bodies()) {
      const auto& motors = body->motors();  // hip, thigh and knee of each leg
      for (std::size_t leg = 0; leg < motors.size() / 3; leg++) {
        const bool diagonal = leg == 0 || leg == 3;
        const double lift = std::max(0.0, diagonal ? fixed::sin(phase) : -fixed::sin(phase));
        motors[3 * leg + 1]->set_target(-0.15 * lift);
        motors[3 * leg + 2]->set_target(0.3 * lift);
      }
    }
    engine_.tick();
    return system::clock_seconds() - start;
  }

  /// The number of quadrupeds whose trunk is higher than half of its height at the start.
  int standing() {
    int count = 0;
    for (const auto& body : engine_.world().bodies()) {
      if (!body->motors().empty() && body->parts()[0]->pose().position.z > 0.2) count++;
    }
    return count;
  }

 private:
  engine::EngineLink link_;
  engine::Engine engine_;
};

}  // namespace

nlohmann::ordered_json measure_terrain(const MeasureOptions&) {
  constexpr int kWarm = 60;
  constexpr int kTicks = 240;
  model::ModelLibrary library;
  const auto dog = library.load(app::data_dir() + "/urdf/quadruped.urdf");
  if (!dog) return {{"fault", dog.error()}};
  model::ShapeModel plane;
  plane.kind = model::ShapeKind::plane;
  const double start = system::clock_seconds();
  const model::ShapeModel terrain = hills();
  const double built = system::clock_seconds();
  Herd on_plane(*dog, plane);
  Herd on_hills(*dog, terrain);
  TimeSamples plane_times, hill_times;
  for (int i = 0; i < kWarm + kTicks; i++) {
    const double of_plane = on_plane.tick();
    const double of_hills = on_hills.tick();
    if (i < kWarm) continue;
    plane_times.add(of_plane);
    hill_times.add(of_hills);
  }
  const double of_plane = plane_times.quantile(0.5);
  const double of_hills = hill_times.quantile(0.5);
  return {{"quadrupeds", kDogs},
          {"standing", on_plane.standing()},
          {"standing_on_hills", on_hills.standing()},
          {"build_ms", rounded((built - start) * 1e3, 1)},
          {"plane_ms", rounded(of_plane * 1e3, 2)},
          {"terrain_ms", rounded(of_hills * 1e3, 2)},
          {"ratio", rounded(of_hills / of_plane, 2)}};
}

}  // namespace limber

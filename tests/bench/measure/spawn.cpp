// Import, build, copy, first tick.
#include "bench/measure/measures.h"

#include <fmt/format.h>

#include "app/paths.h"
#include "base/check.h"
#include "bench/measure/times.h"
#include "engine/engine.h"
#include "model/model_library.h"
#include "support/world_objects.h"

namespace limber {

nlohmann::ordered_json measure_spawn(const MeasureOptions&) {
  constexpr int kCopies = 1000;
  constexpr int kSide = 32;
  const std::string file = app::data_dir() + "/urdf/arm17.urdf";
  engine::EngineLink link;
  engine::Engine engine(link, engine::EngineOptions{});
  LIMBER_CHECK(engine.start().ok());
  sim::World& world = engine.world();
  model::ModelLibrary library;

  const double start = system::clock_seconds();
  const auto model = library.load(file);
  if (!model) return {{"fault", model.error()}};
  const Result<sim::Body*> first = world.add_body(*model, "arm", sim::BuildOptions{});
  if (!first) return {{"fault", first.error()}};
  const double loaded = system::clock_seconds();
  for (int i = 1; i <= kCopies; i++) {
    const Result<sim::Body*> copy = world.copy_body(**first, fmt::format("arm{}", i));
    LIMBER_CHECK(copy.ok());
    Pose pose = (*copy)->pose();
    const int row = i / kSide;
    pose.position += Vec3(2.0 * (i % kSide), 2.0 * row, 0);
    (*copy)->set_pose(pose);
  }
  const double copied = system::clock_seconds();
  engine.tick();
  const double ticked = system::clock_seconds();
  const auto milliseconds = [](double seconds) { return rounded(seconds * 1e3, 2); };
  return {{"copies", kCopies},
          {"parts", (kCopies + 1) * (*first)->parts().size()},
          {"load_ms", milliseconds(loaded - start)},
          {"copies_ms", milliseconds(copied - loaded)},
          {"first_tick_ms", milliseconds(ticked - copied)},
          {"whole_ms", milliseconds(ticked - start)}};
}

}  // namespace limber

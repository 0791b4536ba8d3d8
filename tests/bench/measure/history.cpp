// Plays scenes for some seconds and rewinds them.
#include "bench/measure/measures.h"

#include <fstream>
#include <string>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/check.h"
#include "bench/measure/show_folder.h"
#include "bench/measure/times.h"
#include "engine/engine.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHistoryArms = R"(
local arm = sim:load_urdf("{0}/urdf/arm17.urdf", {{ name = "arm1" }})
for i = 2, {1} do arm:copy("arm" .. i, {{ position = vec3(2 * (i % 32), 2 * math.floor(i / 32), 0) }}) end
{2}
)";
constexpr const char* kHistoryForces = R"(
sim:on_step(function()
  for _, body in ipairs(sim.bodies) do
    body.parts[2]:apply_force(vec3(math.sin(sim.time + #body.name), 0, rng:uniform(0, 1)))
  end
end)
)";

Json measure_history(const ShowFolder& folder, int arms, const std::string& more, int ticks) {
  std::ofstream(folder.scene()) << fmt::format(kHistoryArms, app::data_dir(), arms, more);
  engine::EngineLink link;
  engine::EngineOptions options;
  options.scene = folder.scene();
  options.fast = true;
  engine::Engine engine(link, options);
  LIMBER_CHECK(engine.start().ok());
  TimeSamples plain, with_checkpoint, back;
  double before = 0;
  double grown = 0;
  for (int i = 0; i < ticks; i++) {
    const double start = system::thread_seconds();
    engine.tick();
    const double seconds = system::thread_seconds() - start;
    if (engine.history().newest_tick() != engine.world().tick()) {
      plain.add(seconds);
      continue;
    }
    const auto bytes = static_cast<double>(engine.history().bytes());
    if (before > 0) {
      with_checkpoint.add(seconds);
      grown += bytes - before;
    }
    before = bytes;
  }
  const int seconds = ticks / 60;
  const double checkpoints = seconds - 1;
  for (int i = 0; i < 3; i++) {
    link.command_queue.push({{{"/transport/rewind", {Arg::of(0.9)}}}, {CommandSource::osc, 0x7f000001, 4000}});
    const double start = system::thread_seconds();
    engine.idle();
    back.add(system::thread_seconds() - start);
    for (int k = 0; k < 54; k++) engine.tick();
  }
  return {{"tick_us", TimeSamples::in_microseconds(plain.quantile(0.5))},
          {"tick_with_key_us", TimeSamples::in_microseconds(with_checkpoint.quantile(0.5))},
          {"mb_of_30_s", rounded((before + grown / checkpoints * (30 - checkpoints)) / (1u << 20u), 1)},
          {"rewind_ms", rounded(1000 * back.quantile(0.5), 2)}};
}

}  // namespace

Json measure_history(const MeasureOptions& options) {
  const int ticks = options.ticks > 0 ? options.ticks : 360;
  const ShowFolder folder;
  return {{"ticks", ticks},
          {"arms_1", measure_history(folder, 1, "", ticks)},
          {"arms_100", measure_history(folder, 100, "", ticks)},
          {"arms_1000", measure_history(folder, 1000, "", ticks)},
          {"arms_100_lua", measure_history(folder, 100, kHistoryForces, ticks)}};
}

}  // namespace limber

// Draws all arms in motion. As in a window, a frame is prepared while the GPU draws the previous one. The simulation
// runs ahead: a GPU that waits for it in between would lower its clock rate.
#include "bench/measure/measures.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/check.h"
#include "bench/measure/arms.h"
#include "bench/measure/times.h"
#include "support/world_objects.h"
#include "ui/render/gl.h"
#include "ui/render/offscreen.h"
#include "ui/render/renderer.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

struct PictureScene {
  int arms;
  render::Quality quality;
  const char* quality_name;
  int width, height;
};

constexpr int kTicks = 8;
constexpr int kFramesPerTick = 2;  // the display runs at twice the rate of the simulation

// places the camera so that all arms are in view
void view_all_arms(BenchArms& arms) {
  sim::World& world = arms.engine().world();
  Vec3 low(0), high(0);
  for (const auto& body : world.bodies()) {
    for (const auto& part : body->parts()) {
      if (part->is_static()) continue;
      low = glm::min(low, part->pose().position);
      high = glm::max(high, part->pose().position);
    }
  }
  const Vec3 center = 0.5 * (low + high);
  const Vec3 eye = center + glm::length(high - low) * Vec3(0.6, -0.6, 0.45);
  Store& store = world.store();
  LIMBER_CHECK(store.set(world.visuals().camera().id(), "eye", {&eye.x, 3}).ok());
  LIMBER_CHECK(store.set(world.visuals().camera().id(), "target", {&center.x, 3}).ok());
}

// `warm`: untimed frames for the upload of meshes and the warm-up of the driver
Json draw(render::GlApi api, const PictureScene& scene, int warm, int frames) {
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::make(api, app::shader_dir(), scene.quality);
  if (!renderer) return {{"error", renderer.error()}};
  BenchArms arms(arm_scene(scene.arms));
  const auto tick = [&] {
    arms.drive(arms.time());
    arms.tick();
    return arms.link().snapshots.read();
  };
  tick();
  view_all_arms(arms);
  std::vector<std::shared_ptr<const engine::Snapshot>> snapshots;
  snapshots.reserve(kTicks);
  for (int i = 0; i < kTicks; i++) snapshots.push_back(tick());
  TimeSamples processor;
  double begin = 0;
  for (int i = 0; i < warm + frames; i++) {
    const auto at = static_cast<std::size_t>(i / kFramesPerTick % (kTicks - 1));
    const engine::Snapshot& before = *snapshots[at];
    const engine::Snapshot& now = *snapshots[at + 1];
    const double mix = 1.0 * (i % kFramesPerTick) / kFramesPerTick;
    if (i == warm) {
      (*renderer)->finish();
      begin = system::clock_seconds();
    }
    const double begin_own = system::thread_seconds();
    const Result<void> drawn = (*renderer)->draw(before, now, mix, scene.width, scene.height);
    if (!drawn) return {{"error", drawn.error()}};
    if (i >= warm) processor.add(system::thread_seconds() - begin_own);
  }
  (*renderer)->finish();
  const double frame_seconds = (system::clock_seconds() - begin) / frames;
  return {{"quality", scene.quality_name},
          {"size", fmt::format("{} x {}", scene.width, scene.height)},
          {"parts", scene.arms * 17},
          {"frames", frames},
          {"frames_a_second", rounded(1 / frame_seconds, 1)},
          {"frame_us", TimeSamples::in_microseconds(frame_seconds)},
          {"processor_us", processor.microseconds()}};
}

}  // namespace

nlohmann::ordered_json measure_picture(const MeasureOptions& options) {
  const Result<std::unique_ptr<render::OffscreenContext>> context = render::OffscreenContext::make(options.gl);
  if (!context) return {{"error", context.error()}};
  const bool software = render::gl_is_software();
  // software needs seconds for the large scene
  const int warm = software ? 2 : 100;
  const int frames = options.ticks > 0 ? options.ticks : software ? 100 : 600;
  const int frames_large = software ? std::min(frames, 3) : frames;
  const render::GlApi api = (*context)->api();
  return {{"drawn_by", render::gl_driver()},
          {"with", render::gl_api_info(api).name},
          {"small", draw(api, {16, render::Quality::low, "low", 640, 360}, warm, frames)},
          {"large", draw(api, {1000, render::Quality::high, "high", 1920, 1080}, warm, frames_large)}};
}

}  // namespace limber

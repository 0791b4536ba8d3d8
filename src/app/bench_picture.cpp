// All arms are seen, in motion; as in a window, a frame is prepared while the card draws the one before. The simulation
// runs ahead: a card that waits for it in between would slow its clock down.
#include "app/bench_picture.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "app/bench_arms.h"
#include "app/bench_times.h"
#include "app/paths.h"
#include "base/check.h"
#include "view/gl.h"
#include "view/offscreen.h"
#include "view/renderer.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

struct PictureScene {
  int arms;
  Quality quality;
  const char* quality_name;
  int width, height;
};

constexpr int kTicks = 8;
constexpr int kFramesATick = 2;  // the display is twice as fast as the simulation

// from above a corner, the whole field in sight
void look_at_all(BenchArms& arms) {
  World& world = arms.engine().world();
  Vec3 low(0), high(0);
  for (const auto& body : world.bodies()) {
    for (const auto& part : body->parts()) {
      if (part->is_static()) continue;
      low = glm::min(low, part->pose().position);
      high = glm::max(high, part->pose().position);
    }
  }
  const Vec3 middle = 0.5 * (low + high);
  const Vec3 eye = middle + glm::length(high - low) * Vec3(0.6, -0.6, 0.45);
  Store& store = world.store();
  LIMBER_CHECK(store.set(world.visuals().camera().id(), "eye", {&eye.x, 3}).ok());
  LIMBER_CHECK(store.set(world.visuals().camera().id(), "target", {&middle.x, 3}).ok());
}

// `warm`: frames in which meshes are handed over and the driver finds its pace
Json draw(GlApi api, const PictureScene& scene, int warm, int frames) {
  Result<std::unique_ptr<Renderer>> renderer = Renderer::make(api, shader_dir(), scene.quality);
  if (!renderer) return {{"error", renderer.error()}};
  BenchArms arms(bench_arm_scene(scene.arms));
  const auto tick = [&] {
    arms.drive(arms.time());
    arms.tick();
    return arms.link().snapshots.read();
  };
  tick();
  look_at_all(arms);
  std::vector<std::shared_ptr<const Snapshot>> moments;
  moments.reserve(kTicks);
  for (int i = 0; i < kTicks; i++) moments.push_back(tick());
  Samples own;
  double begin = 0;
  for (int i = 0; i < warm + frames; i++) {
    const auto at = static_cast<std::size_t>(i / kFramesATick % (kTicks - 1));
    const Snapshot& before = *moments[at];
    const Snapshot& now = *moments[at + 1];
    const double mix = 1.0 * (i % kFramesATick) / kFramesATick;
    if (i == warm) {
      (*renderer)->finish();
      begin = system::clock_seconds();
    }
    const double begin_own = system::thread_seconds();
    const Result<void> drawn = (*renderer)->draw(before, now, mix, scene.width, scene.height);
    if (!drawn) return {{"error", drawn.error()}};
    if (i >= warm) own.add(system::thread_seconds() - begin_own);
  }
  (*renderer)->finish();
  const double a_frame = (system::clock_seconds() - begin) / frames;
  return {{"quality", scene.quality_name},
          {"size", fmt::format("{} x {}", scene.width, scene.height)},
          {"parts", scene.arms * 17},
          {"frames", frames},
          {"frames_a_second", rounded(1 / a_frame, 1)},
          {"frame_us", Samples::in_microseconds(a_frame)},
          {"processor_us", own.microseconds()}};
}

}  // namespace

nlohmann::ordered_json bench_picture(const BenchOptions& options) {
  const Result<std::unique_ptr<Offscreen>> context = Offscreen::make(options.gl);
  if (!context) return {{"error", context.error()}};
  const bool software = gl_is_software();
  // software draws the large one for seconds
  const int warm = software ? 2 : 100;
  const int frames = options.ticks > 0 ? options.ticks : software ? 100 : 600;
  const int frames_large = software ? std::min(frames, 3) : frames;
  const GlApi api = (*context)->api();
  return {{"drawn_by", gl_driver()},
          {"with", gl_api_info(api).name},
          {"small", draw(api, {16, Quality::low, "low", 640, 360}, warm, frames)},
          {"large", draw(api, {1000, Quality::high, "high", 1920, 1080}, warm, frames_large)}};
}

}  // namespace limber

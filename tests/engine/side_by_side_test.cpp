// Islands solved by several threads: the same state, to the bit, for any number of them.
#include <gtest/gtest.h>

#include "base/sanitized.h"
#include "show.h"

namespace limber::engine::test {
namespace {

// arms that sway, some of them in contact, and heaps of boxes on the same floor
constexpr const char* kCrowd = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local arm = sim:load_urdf(ROOT .. "/urdf/arm6.urdf", { name = "arm1" })
for i = 2, 12 do arm:copy("arm" .. i, { position = vec3(0.3 * (i % 4), i, 0) }) end
for i, body in ipairs(sim.bodies) do
  if body.name ~= "floor" then body:add_behavior("random_force", "gust", { parts = "*" }) end
end
local box = sim:add_box_shape("box", vec3(0.1, 0.1, 0.1))
for i = 0, 59 do
  sim:add_body("box" .. i):add_part("p", box, { position = vec3(-2 - i % 3, 0.03 * i, 0.06 + 0.11 * math.floor(i / 6)) })
end
)";

// enough drops to need several trees of boxes; each step removes one from either end
constexpr const char* kRain = R"(
local box = sim:add_box_shape("box", vec3(0.1, 0.1, 0.1))
for i = 1, 400 do
  sim:add_body("drop" .. i):add_part("p", box, { position = vec3(i % 20, math.floor(i / 20), 0) })
end
local gone = 0
sim:on_step(function()
  gone = gone + 1
  sim:body("drop" .. gone):remove()
  sim:body("drop" .. 401 - gone):remove()
end)
)";

std::uint64_t hash_with(int threads, const std::string& scene, int ticks, std::size_t bodies) {
  const SceneFile file(scene);
  EngineOptions options = fast_options(file.path());
  options.threads = threads;
  Show show(options);
  show.ticks(ticks);
  EXPECT_EQ(show.engine.world().bodies().size(), bodies);
  return show.engine.state_hash();
}

TEST(ParallelIslands, AnyNumberOfThreadsGivesTheSameState) {
  const int ticks = kSanitized ? 30 : 150;
  for (const std::string solver : {"iterative", "direct"}) {
    const std::string scene =
        "local ROOT = \"" LIMBER_SOURCE_DIR "\"\n" + std::string(kCrowd) + "sim.solver = \"" + solver + "\"\n";
    const std::uint64_t alone = hash_with(1, scene, ticks, 73);
    for (const int threads : {2, 3, 8})
      EXPECT_EQ(hash_with(threads, scene, ticks, 73), alone) << solver << " " << threads;
  }
}

TEST(ParallelIslands, ManyAddedAndRemovedBodiesGiveTheSameState) {
  const std::uint64_t alone = hash_with(1, kRain, 60, 280);
  EXPECT_NE(alone, hash_with(1, kRain, 59, 282));
  for (const int threads : {2, 3}) EXPECT_EQ(hash_with(threads, kRain, 60, 280), alone) << threads;
}

}  // namespace
}  // namespace limber::engine::test

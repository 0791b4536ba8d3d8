// Terrain, tendons and meshes of several pieces in rewinds, presets and takes.
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

// Two balls on a cable, angles whose mesh consists of two convex pieces, on hilly ground.
constexpr const char* kGroundScene = R"(
sim.gravity = vec3(0, 0, -9.81)
local ground = sim:add_heightfield_shape("ground", { size = { 6, 6 }, rows = 61, columns = 61,
  heights = function(x, y) return 0.2 * math.cos(2 * x) * math.cos(1.5 * y) end })
sim:add_body("ground"):add_part("ground", ground)
local ball = sim:add_sphere_shape("ball", 0.1)
local pair = sim:add_body("pair")
pair:add_part("a", ball, { position = vec3(0.3, 0.1, 0.6) })
pair:add_part("b", ball, { position = vec3(0.8, 0.2, 0.7) })
pair:add_tendon("cable", { points = { { "a" }, { "b", 0, 0, 0.05 } }, stiffness = 50, damping = 1 })
local angle = sim:add_convex_mesh_shape("angle", "angle.obj", { concave = true })
for i = 1, 3 do
  sim:add_body("angle" .. i):add_part("angle", angle, { position = vec3(-0.5, 0.3 * i, 0.4 + 0.4 * i) })
end
osc:on("/push", function(x) pair:part("a"):apply_impulse(vec3(x, 0.02, 0.1)) end)
)";

// An angle in the x-z plane: arms of 0.4 and 0.3 m, 0.1 m thick.
constexpr const char* kAngle = R"(v 0 0 0
v 0.4 0 0
v 0.4 0 0.1
v 0.1 0 0.1
v 0.1 0 0.3
v 0 0 0.3
v 0 0.1 0
v 0.4 0.1 0
v 0.4 0.1 0.1
v 0.1 0.1 0.1
v 0.1 0.1 0.3
v 0 0.1 0.3
f 1 2 3 4 5 6
f 12 11 10 9 8 7
f 1 7 8 2
f 2 8 9 3
f 3 9 10 4
f 4 10 11 5
f 5 11 12 6
f 6 12 7 1
)";

void write_ground_scene(const ShowFolder& folder) {
  folder.write("scripts/scene.lua", kGroundScene);
  folder.write("scripts/angle.obj", kAngle);
}

void play_inputs(Show& show, std::uint64_t to, std::vector<std::uint64_t>& hashes) {
  while (show.engine.world().tick() < to) {
    const std::uint64_t tick = show.engine.world().tick();
    if (tick % 20 == 5) show.send("/push", 0.01 * static_cast<double>(tick % 7));
    if (tick == 30) show.send("/physics/body/pair/tendon/cable/stiffness", 80);
    show.ticks(1);
    hashes.push_back(show.engine.state_hash());
  }
}

TEST(GroundTake, RewindIsExact) {
  const ShowFolder folder;
  write_ground_scene(folder);
  const EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  std::vector<std::uint64_t> expected, hashes;
  Show reference(options);
  play_inputs(reference, 180, expected);
  ASSERT_EQ(reference.engine.world().find_body("angle1")->parts()[0]->geometry()->children.size(), 2u);
  Show show(options);
  play_inputs(show, 120, hashes);
  for (const int back : {40, 95, 3}) {
    show.send("/transport/step", -back);
    show.send("/transport/play");
    show.engine.idle();
    const std::uint64_t now = show.engine.world().tick();
    ASSERT_EQ(now, hashes.size() - static_cast<std::size_t>(back));
    hashes.resize(now);
    ASSERT_EQ(show.engine.state_hash(), hashes.back());
    play_inputs(show, 180, hashes);
    EXPECT_EQ(hashes, expected) << "after " << back << " ticks back";
  }
}

TEST(GroundTake, PresetsRestoreTendonsAndPoses) {
  const ShowFolder folder;
  write_ground_scene(folder);
  Show show(fast_options(folder.path("scripts/scene.lua")));
  std::vector<std::uint64_t> hashes;
  play_inputs(show, 20, hashes);
  show.send("/preset/store", "start", "all", "poses", "velocities");
  show.ticks(1);
  const Vec3 place = show.engine.world().find_body("angle2")->pose().position;
  play_inputs(show, 100, hashes);
  EXPECT_EQ(show.read("/physics/body/pair/tendon/cable/stiffness"), 80);
  EXPECT_GT(glm::length(show.engine.world().find_body("angle2")->pose().position - place), 0.1);
  show.send("/preset/recall", "start");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/body/pair/tendon/cable/stiffness"), 50);
  EXPECT_LT(glm::length(show.engine.world().find_body("angle2")->pose().position - place), 0.1);
}

TEST(GroundTake, ReplaysToTheSameState) {
  const ShowFolder folder;
  write_ground_scene(folder);
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("ground.take");
  std::uint64_t hash = 0;
  {
    Show show(options);
    std::vector<std::uint64_t> hashes;
    play_inputs(show, 150, hashes);
    show.engine.end_take();
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  std::filesystem::remove(folder.path("scripts/angle.obj"));  // a take has its own copy
  expect_replay(options.record, hash);
}

}  // namespace
}  // namespace limber::engine::test

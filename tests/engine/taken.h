// Fixtures for take tests: a session with everything that a take must contain (floods, reloads, spawned bodies, stopped
// scripts, morphs, a change of the scene), random by a seed; and its replay.
#pragma once

#include "base/random.h"
#include "engine/edited.h"

namespace limber::engine::test {

inline constexpr const char* kTakeScene = R"(
params { { "count", 2, min = 1, max = 3, rerun = true }, { "wind", 0.5, min = 0, max = 2 } }
local tool = require "tool"
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
for i = 1, params.count do
  local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" .. i, position = vec3(i, 0, 0) })
  arm:add_behavior("sway", "sway", { depth = tool.depth })
  arm:add_behavior("sway", "again", { depth = tool.depth })
  arm:add_behavior("random_force", "gust", { parts = "*" })
end
if tool.more then sim:load_urdf("urdf/bead.urdf", { name = "bead", position = vec3(0, 3, 1) }) end
state.pushes = 0
osc:on("/push", function(x)
  state.pushes = state.pushes + 1
  sim:body("arm1").parts[2]:apply_impulse(vec3(x, rng:uniform(-0.01, 0.01), params.wind / 100))
end)
osc:on("/loop", function(n)
  sim.gravity = vec3(0, 0, n)
  while n == n do end
end)
osc:on("/spawn", function(name) sim:body("arm1"):copy(name, { position = vec3(rng:uniform(2, 4), 2, 1) }) end)
osc:on("/gone", function(name) if sim:find_body(name) then sim:body(name):remove() end end)
sim:every(0.25, function() presets:store("now") end)
--MORE
)";
// for a run that reads another set of models than the previous one
inline constexpr const char* kTakeBead = R"(<robot name="bead"><link name="bead">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><sphere radius="0.1"/></geometry></collision>
</link></robot>)";
inline constexpr const char* kTakeSway = R"(return behavior {
  params = { { "depth", 0.4, min = 0, max = 1 }, { "hang", false } },
  start = function(self) self.state.phase = 0 end,
  step = function(self, dt)
    while self.hang do end
    self.state.phase = self.state.phase + dt * self.rng:uniform(0.5, 1.5)
    for i, motor in ipairs(self.motors) do motor.target = self.depth * math.sin(self.state.phase + i) end
  end,
}
)";
inline constexpr const char* kTakeOtherScene = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 5 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(0.01 * i, 0, 0.3 * i) }) end
osc:on("/push", function(x) sim:body("ball3").parts[1]:apply_impulse(vec3(x, 0, rng:uniform(0, 0.1))) end)
)";

/// Text of a preset file with the preset "filed".
inline std::string preset_file_text(const std::string& path, const std::string& values) {
  return fmt::format(R"({{"limber presets": 1, "presets": [{{"name": "filed", "values": {{"{}": {{{}}}}}}}]}})", path,
                     values);
}

inline void write_take_scene(const ShowFolder& folder) {
  namespace fs = std::filesystem;
  const fs::path from = fs::path(LIMBER_SOURCE_DIR) / "urdf";
  fs::create_directories(folder.path("urdf"));
  fs::copy(from / "arm6.urdf", folder.path("urdf/arm6.urdf"));
  fs::copy(from / "meshes", folder.path("urdf/meshes"), fs::copy_options::recursive);
  folder.write("urdf/bead.urdf", kTakeBead);
  folder.write("scripts/scene.lua", kTakeScene);
  folder.write("scripts/other.lua", kTakeOtherScene);
  folder.write("scripts/scene.presets.json", preset_file_text("/physics/body/arm1/behavior/sway", "\"depth\": 0.75"));
  folder.write("scripts/other.presets.json", preset_file_text("/physics/body/ball2/part/p", "\"linear_damping\": 0.5"));
  folder.write("scripts/lib/tool.lua", "return { depth = 0.3 }\n");
  folder.write("behaviors_lua/sway.lua", kTakeSway);
}

inline EngineOptions take_options(const ShowFolder& folder) {
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.scene_options.limits.call_ms = 8 * script::kBudgetScale;
  options.scene_options.seed = 7;
  return options;
}

/// Evaluates Lua code as from a console.
inline void evaluate(Show& show, const std::string& text) {
  auto request = std::make_shared<EvaluationRequest>();
  request->text = text;
  request->on_result = [](const Evaluation&) {};
  show.link.command_queue.push({{}, {CommandSource::console}, std::move(request)});
}

/// Sends random inputs of a performer, including scripts that never end.
inline void play_random_inputs(Show& show, const ShowFolder& folder, int ticks, std::uint64_t seed) {
  Random random(seed, "hands");
  const auto random_int = [&](int n) { return static_cast<int>(random.uniform() * n); };
  for (int i = 0; i < ticks; i++) {
    for (int k = random_int(6); k > 0; k--) show.send("/push", random.uniform(-0.02, 0.02));
    show.send("/physics/motor/angularspringstiffness", "arm1", random.uniform(0, 20));
    if (random_int(20) == 0) show.send("/spawn", fmt::format("extra{}", random_int(4)));
    if (random_int(30) == 0) show.send("/gone", fmt::format("extra{}", random_int(4)));
    if (random_int(40) == 0) show.send("/preset/store", fmt::format("p{}", random_int(3)));
    if (random_int(20) == 0) show.send("/preset/recall", fmt::format("p{}", random_int(3)), 0.3);
    if (random_int(50) == 0) show.send("/preset/recall", "filed", 0.2);
    if (random_int(20) == 0)
      evaluate(show, fmt::format("sim:body('arm1').parts[3]:apply_impulse(rng:direction() * {})", 0.01));
    if (random_int(60) == 0) evaluate(show, "sim.gravity.x = sim.nothing");
    if (random_int(60) == 0) evaluate(show, "while true do end");
    if (i % 70 == 11) show.send("/physics/behavior/parameter", "arm1", "sway", "hang", 1);
    if (i % 70 == 25) {
      show.send("/physics/behavior/parameter", "arm1", "sway", "hang", 0);
      show.send("/physics/behavior/parameter", "arm1", "sway", "active", 1);
    }
    if (random_int(25) == 0) show.send("/edit/undo");
    if (random_int(30) == 0) show.send("/edit/redo");
    // a behavior that is stepped after another one in the same call
    if (i % 70 == 41) show.send("/physics/behavior/parameter", "arm1", "again", "hang", 1);
    if (i % 70 == 55) {
      show.send("/physics/behavior/parameter", "arm1", "again", "hang", 0);
      show.send("/physics/behavior/parameter", "arm1", "again", "active", 1);
    }
    if (random_int(60) == 0) show.send("/scene/count", 1 + random_int(3));
    if (random_int(90) == 0) show.send("/transport/reset");
    if (random_int(60) == 0) show.send("/transport/step", 3);
    if (random_int(30) == 0) show.send("/transport/play");
    if (i % 40 == 9) show.send("/physics/body/arm1/behavior/again/place", 1 + i % 3);
    if (i % 50 == 17) show.send("/loop", i);
    if (i % 60 == 31) {
      folder.write("scripts/lib/tool.lua",
                   fmt::format("return {{ depth = {}, more = {} }}\n", 0.1 + 0.01 * random_int(30), i % 120 == 31));
      run_while_ticking(show, [&] { show.engine.reload(); });
    }
    show.ticks(1);
  }
}

/// Records such a session; returns the state hash at its end.
inline std::uint64_t record_take(const ShowFolder& folder, const std::string& take, int ticks, std::uint64_t seed) {
  log_to_stderr(false);
  EngineOptions options = take_options(folder);
  options.record = take;
  Show show(options);
  play_random_inputs(show, folder, ticks, seed);
  run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.change_scene(folder.path("scripts/other.lua")).ok()); });
  for (int i = 0; i < ticks / 10; i++) {
    show.send("/push", 0.01 * i);
    if (i == 3) show.send("/preset/recall", "filed");
    show.ticks(1);
  }
  EXPECT_EQ(show.read("/physics/body/ball2/part/p/linear_damping"), 0.5);
  show.engine.end_take();
  const std::uint64_t hash = show.engine.state_hash();
  show.engine.finish_saving();
  return hash;
}

struct ReplayOutcome {
  ReplayResult result;
  std::uint64_t hash = 0;
  std::string error;  ///< Why the replay did not start.
};

inline ReplayOutcome replay_take(const std::string& take, bool current_scripts = false) {
  log_to_stderr(false);
  EngineLink link;
  EngineOptions options = fast_options();
  options.replay = take;
  options.current_scripts = current_scripts;
  Engine engine(link, options);
  if (const Result<void> started = engine.start(); !started) return {{}, 0, started.error()};
  engine.run();
  return {engine.replay_result(), engine.state_hash(), ""};
}

/// Expects that the take replays to its end, with this final hash.
inline void expect_replay(const std::string& take, std::uint64_t hash) {
  const ReplayOutcome replayed = replay_take(take);
  EXPECT_EQ(replayed.error, "");
  EXPECT_FALSE(replayed.result.diverged_at.has_value()) << text_of(replayed.result);
  EXPECT_EQ(replayed.hash, hash);
}

inline std::string file_bytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace limber::engine::test

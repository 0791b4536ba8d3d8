// Fixtures for rewind tests: a scene with all kinds of state that a checkpoint must contain, inputs that depend only on
// the tick, and comparison with a run without rewinds.
#pragma once

#include <string>
#include <vector>

#include "base/random.h"
#include "engine/edited.h"

namespace limber::engine::test {

// Uses Lua state, timers, coroutines, contacts and generators, and makes them visible by impulses on bodies.
inline constexpr const char* kRewindScene = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local box, ball = sim:add_box_shape("box", vec3(0.2, 0.25, 0.15)), sim:add_sphere_shape("ball", 0.12)
for i = 1, 9 do
  local stone = sim:add_body("stone" .. i)
  stone:add_part("p", i % 2 == 0 and box or ball, { position = vec3(0.06 * (i % 4), 0.05 * (i % 3), 0.2 + 0.25 * i) })
  stone.parts[1].report_contacts = true
  stone:add_behavior("random_force", "gust", { max_amp = 2 })
end
for i = 1, 2 do
  local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" .. i, position = vec3(i, 0, 0) })
  arm:add_behavior("sway", "sway", { depth = 0.4 })
end
sim:add_group_behavior("drift", "drift", { bodies = "stone*" })
local written, names, touches = {}, {}, 0
local walk = coroutine.wrap(function()
  local n = 0
  while true do n = (n * 1.25 + rng:uniform(0, 1)) % 3; coroutine.yield(n) end
end)
local function stone(i) return sim:body("stone" .. i).parts[1] end
sim:every(0.1, function() stone(1):apply_impulse(vec3(walk() * 0.02, 0, 0)) end)
sim:after(2.3, function() stone(2):apply_impulse(vec3(0, 0, 3)) end)
sim:on_step(function(dt)
  written[#written + 1] = stone(3).position.z
  names["n" .. #written % 37] = (names["n" .. #written % 37] or 0) + written[#written]
  if #written > 150 then
    local sum = 0
    for _, z in ipairs(written) do sum = sum + z end
    written = {}
    stone(3):apply_impulse(vec3(sum * 0.001, names.n5 * 0.01, 0))
    sim:after(0.5, function() stone(4):apply_force(vec3(0, sum * 0.01 + touches * 0.01, 0)) end)
    print("written", sum)
  end
end)
sim:on_contact(function() touches = touches + 1 end)
osc:on("/push", function(x)
  state.pushes = (state.pushes or 0) + 1
  sim:body("arm1").parts[3]:apply_impulse(vec3(x, rng:uniform(-0.01, 0.01), state.pushes * 0.0001))
  osc:send("/pushed", state.pushes)
end)
osc:on("/mistake", function(x) touches = touches + x; sim.gravity = vec3(0, 0, x); error("no " .. x) end)
osc:on("/loop", function(n) sim.gravity = vec3(0, 0, n); while n == n do end end)
osc:on("/recall", function(name) presets:recall(name, 0.4) end)
)";
inline constexpr const char* kRewindSway = R"(return behavior {
  params = { { "depth", 0.4, min = 0, max = 1 } },
  start = function(self) self.state.phase = 0; self.past = {} end,
  step = function(self, dt)
    local past = self.past
    past[#past % 50 + 1] = self.rng:uniform(0.5, 1.5)
    self.state.phase = self.state.phase + dt * past[#past]
    for i, motor in ipairs(self.motors) do motor.target = self.depth * math.sin(self.state.phase + i) end
  end,
}
)";
inline constexpr const char* kRewindDrift = R"(return behavior {
  group = true,
  start = function(self) self.state.steps = 0 end,
  step = function(self, dt)
    self.state.steps = self.state.steps + 1
    self.parts[1]:apply_force(vec3(math.sin(self.state.steps * 0.1), self.rng:uniform(-1, 1), 0))
  end,
}
)";

inline void write_rewind_scene(const ShowFolder& folder, const std::string& scene = kRewindScene) {
  namespace fs = std::filesystem;
  const fs::path from = fs::path(LIMBER_SOURCE_DIR) / "urdf";
  fs::create_directories(folder.path("urdf"));
  fs::copy(from / "arm6.urdf", folder.path("urdf/arm6.urdf"));
  fs::copy(from / "meshes", folder.path("urdf/meshes"), fs::copy_options::recursive);
  folder.write("scripts/scene.lua", scene);
  folder.write("behaviors_lua/sway.lua", kRewindSway);
  folder.write("behaviors_lua/drift.lua", kRewindDrift);
}

inline EngineOptions rewind_options(const ShowFolder& folder) {
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.scene_options.seed = 11;
  return options;
}

/// Sends the inputs before the tick that follows `tick`.
using TickInputs = void (*)(Show& show, std::uint64_t tick);
inline void no_inputs(Show&, std::uint64_t) {}

/// Sends messages of many kinds, depending only on the tick: floods, invalid ones, undo, presets, Lua code, errors.
inline void random_inputs(Show& show, std::uint64_t tick) {
  Random random(tick, "hands");
  const auto random_int = [&](int n) { return static_cast<int>(random.uniform() * n); };
  for (int k = random_int(8); k > 0; k--) show.send("/push", random.uniform(-0.02, 0.02));
  show.send("/physics/motor/angularspringstiffness", "arm1", random.uniform(0, 20));
  if (tick == 10) show.send("/preset/store", "p1");
  if (tick == 40) show.send("/preset/store", "p2");
  if (tick > 60 && random_int(25) == 0) show.send("/preset/recall", random_int(2) == 0 ? "p1" : "p2", 0.7);
  if (tick > 60 && random_int(60) == 0) show.send("/recall", "p1");
  if (random_int(9) == 0) show.send("/physics/sim/gravity", random.uniform(-2, 2), 0, random.uniform(-12, -6));
  if (random_int(15) == 0) show.send("/physics/body/arm2/enabled", random_int(2));
  if (random_int(12) == 0) show.send("/edit/undo");
  if (random_int(18) == 0) show.send("/edit/redo");
  if (random_int(20) == 0) show.send("/mistake", random.uniform(-3, 3));
  if (random_int(20) == 0) show.send("/physics/body/missing/part/p/mass", 3);
  if (random_int(30) == 0) show.send("/physics/part/hold", "stone5", "p", 0, 0, 0, random.uniform(-1, 1), 0, 1);
  if (random_int(30) == 0) show.send("/physics/behavior/parameter", "gust", "active", random_int(2));
  if (random_int(40) == 0) show.send("/physics/body/stone6/reset");
  if (random_int(25) == 0) {
    auto request = std::make_shared<EvaluationRequest>();
    request->text = "sim:body('stone7').parts[1]:apply_impulse(rng:direction() * 0.1)";
    request->on_result = [](const Evaluation&) {};
    show.link.command_queue.push({{}, {CommandSource::console}, std::move(request)});
  }
}

/// Plays to a tick; stores the state hash after each tick in `hashes`, by tick.
inline void play_to(Show& show, std::uint64_t tick, TickInputs inputs, std::vector<std::uint64_t>& hashes) {
  hashes.resize(tick + 1);
  while (show.engine.world().tick() < tick) {
    inputs(show, show.engine.world().tick());
    show.ticks(1);
    hashes[show.engine.world().tick()] = show.engine.state_hash();
  }
}

/// Plays to a tick and compares the state hashes. False at the first difference.
inline bool replays_identically(Show& show, std::uint64_t tick, TickInputs inputs,
                                const std::vector<std::uint64_t>& hashes) {
  while (show.engine.world().tick() < tick) {
    inputs(show, show.engine.world().tick());
    show.ticks(1);
    const std::uint64_t now = show.engine.world().tick();
    EXPECT_EQ(show.engine.state_hash(), hashes[now]) << "tick " << now;
    if (show.engine.state_hash() != hashes[now]) return false;
  }
  return true;
}

}  // namespace limber::engine::test

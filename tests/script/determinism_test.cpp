// The same scene gives bit-identical runs: compiled or interpreted, in another world, after other scenes.
#include <gtest/gtest.h>

#include <lua.hpp>

#include "stage.h"

namespace limber::script {
namespace {

constexpr const char* kRepeatedScene = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local box = sim:add_box_shape("box", { 0.2, 0.3, 0.4 })
local bodies = {}
for i = 1, 8 do
  local body = sim:add_body("b" .. i)
  local base = body:add_part("base", box, { position = rng:uniform(vec3(-1, -1, 1), vec3(1, 1, 3)) })
  local tip = body:add_part("tip", box, { position = base.position + vec3(0, 0, 0.5) })
  body:add_joint("j", base, tip, { axis = rng:direction() })
  body:add_motor("j")
  bodies[body] = { phase = math.random() }
end
params { { "depth", 0.7 } }
sim:on_step(function(dt)
  local t = sim.time
  for body, info in pairs(bodies) do
    body:motor("j").target = params.depth * math.sin(3 * t + info.phase) ^ 2
    body:part("tip"):apply_force(rng:direction() * (2 + math.noise(t, info.phase)) ^ 2)
  end
end)
sim:every(0.25, function()
  for body in sim:bodies("b*") do body.root:apply_impulse(vec3(0, 0, rng:normal())) end
end)
)";

std::uint64_t hash_of(bool fresh, int ticks, const std::string& extra = "") {
  ScriptFixture fixture({}, fresh);
  EXPECT_EQ(fixture.play(kRepeatedScene + extra, ticks), "");
  EXPECT_TRUE(fixture.host.faults.empty()) << fixture.host.faults[0].text;
  return fixture.scene.state_hash(fixture.world.state_hash());
}

TEST(Determinism, TheSameSceneGivesTheSameHash) {
  const std::uint64_t first = hash_of(true, 240);
  EXPECT_EQ(hash_of(true, 240), first);
  EXPECT_NE(hash_of(true, 241), first);
}

TEST(Determinism, TheHashIncludesGeneratorAndParameters) {
  const std::uint64_t plain = hash_of(true, 10);
  EXPECT_NE(hash_of(true, 10, "\nmath.random()"), plain);
  EXPECT_NE(hash_of(true, 10, "\nsim:at(9 / 60, function() params.depth = 0.7000001 end)"), plain);
  EXPECT_EQ(hash_of(true, 10, "\nsim:at(9 / 60, function() params.depth = 0.7 end)"), plain);
}

// Runs a chunk in a plain state, compiled or interpreted.
std::string run_plain(const std::string& text, bool compiled) {
  lua_State* L = luaL_newstate();
  luaL_openlibs(L);
  luaJIT_setmode(L, 0, LUAJIT_MODE_ENGINE | (compiled ? LUAJIT_MODE_ON : LUAJIT_MODE_OFF));
  const bool ok = luaL_dostring(L, text.c_str()) == 0;
  const char* output = lua_tostring(L, -1);
  std::string result = output == nullptr ? "nothing" : output;
  EXPECT_TRUE(ok) << result;
  lua_close(L);
  return result;
}

TEST(Determinism, CompiledArithmeticMatchesTheInterpreter) {
  for (const char* expression : {"x ^ 2",
                                 "x ^ 3",
                                 "x ^ 0.5",
                                 "x ^ -1",
                                 "x ^ -2",
                                 "x ^ 7",
                                 "x ^ y",
                                 "2 ^ y",
                                 "x ^ k",
                                 "(x - 5) ^ k",
                                 "math.pow(x, 2)",
                                 "math.pow(x, y)",
                                 "math.sin(x)",
                                 "math.cos(y)",
                                 "math.tan(x)",
                                 "math.exp(y)",
                                 "math.log(x)",
                                 "math.log10(x)",
                                 "math.atan2(x, y)",
                                 "math.asin(y / 3)",
                                 "math.sinh(y)",
                                 "math.tanh(y)",
                                 "x % y",
                                 "-x % 3",
                                 "math.fmod(x, y)",
                                 "math.sqrt(x)",
                                 "math.floor(y)",
                                 "math.ldexp(x, 3)",
                                 "x / y",
                                 "math.deg(x)"}) {
    const std::string text = std::string(R"(
local out, s = {}, 7
local k = 2
local function random() s = s * 16807 % 2147483647 return s / 2147483647 end
local sum = 0
for i = 1, 20000 do
  local x, y = random() * 10 + 0.01, random() * 6 - 3
  local v = )") + expression +
                             R"(
  sum = (sum * 1.7 + v * 1048576) % 1048576
  if i % 500 == 0 then out[#out + 1] = string.format("%.17g", v) end
end
return string.format("%.17g ", sum) .. table.concat(out, " "))";
    EXPECT_EQ(run_plain(text, true), run_plain(text, false)) << expression;
  }
}

}  // namespace
}  // namespace limber::script

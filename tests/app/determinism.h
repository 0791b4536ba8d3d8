// A scene for proofs of determinism, and ways to run it that must not matter.
#pragma once

#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app_test {

/// Draws from math.random and rng, walks tables with pairs (things and functions as keys, too), lets bodies collide.
inline constexpr const char* kWildScene = R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local shape = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
local bodies = {}
for i = 1, 12 do
  local body = sim:add_body("box" .. i)
  body:add_part("box", shape, { position = vec3(math.random() - 0.5, rng:uniform(-0.5, 0.5), 0.3 * i) })
  bodies[body] = i
end
local names = { "c", "a", "b", x = 1, y = 2, [print] = 3 }
sim:every(0.1, function()
  for key, value in pairs(names) do
    if type(key) == "string" then sim:body("box" .. 1 + value):part("box"):apply_impulse(rng:direction() * 0.3) end
  end
  for body, i in pairs(bodies) do
    body:part("box"):apply_force(vec3(math.random(-3, 3), 0, 0.1 * i))
  end
end)
sim:at(1, function() sim:body("box3"):copy("twin", { position = vec3(0.1, 0, 3) }) end)
)";

/// Words in front of the program that must change nothing, as far as this machine allows them.
inline std::vector<std::vector<std::string>> surroundings() {
  std::vector<std::vector<std::string>> ways = {{}, {"env", "LIMBER_TEST_FILLER=" + std::string(5000, 'x')}};
  for (const std::vector<std::string>& way : {std::vector<std::string>{"taskset", "-c", "0"}, {"setarch", "-R"}}) {
    std::vector<std::string> probe = way;
    probe.emplace_back("true");
    if (Running(probe).finish().code == 0) ways.push_back(way);
  }
  return ways;
}

/// Ways to play that must change nothing: as fast as can be, in time with the clock, with streams.
inline std::vector<std::vector<std::string>> ways_to_play() {
  static const TakenPort sink(SOCK_DGRAM);
  const std::string streams = "127.0.0.1:" + sink.number() + ",rate=1000";
  return {{"--fast"},
          {"--osc-in", "off", "--osc-out", "off", "--query", "off", "--set", "/physics/sim/speed=100"},
          {"--fast", "--osc-in", "127.0.0.1:0", "--osc-out", streams},
          {"--osc-in", "127.0.0.1:0", "--osc-out", streams, "--set", "/physics/sim/speed=50"}};
}

/// "hash … tick …" of one run, or what went wrong.
inline std::string hash_of(const std::string& scene, const std::vector<std::string>& how,
                           const std::vector<std::string>& before, const std::string& ticks = "200") {
  std::vector<std::string> args = {scene, "--ticks", ticks, "--hash"};
  args.insert(args.end(), how.begin(), how.end());
  const Ran ran = Running(limber(args, before)).finish();
  const std::size_t at = ran.out.rfind("hash ");
  return ran.code == 0 && at != std::string::npos ? ran.out.substr(at) : ran.out + ran.err;
}

}  // namespace limber::app_test

// A scene for determinism tests, and ways to run it that must not change its result.
#pragma once

#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app::test {

/// Uses math.random and rng, iterates tables with pairs (objects and functions as keys, too), and lets bodies collide.
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

/// Command prefixes that must not change the result, as far as this machine supports them.
inline std::vector<std::vector<std::string>> environments() {
  std::vector<std::vector<std::string>> commands = {{}, {"env", "LIMBER_TEST_FILLER=" + std::string(5000, 'x')}};
  for (const std::vector<std::string>& command : {std::vector<std::string>{"taskset", "-c", "0"}, {"setarch", "-R"}}) {
    std::vector<std::string> probe = command;
    probe.emplace_back("true");
    if (Process(probe).finish().code == 0) commands.push_back(command);
  }
  return commands;
}

/// Options of `play` that must not change the result: full speed, real time, streams.
inline std::vector<std::vector<std::string>> play_options() {
  static const PortInUse sink(SOCK_DGRAM);
  const std::string streams = "127.0.0.1:" + sink.port() + ",rate=1000";
  return {{"--fast"},
          {"--osc-in", "off", "--osc-out", "off", "--query", "off", "--set", "/physics/sim/speed=100"},
          {"--fast", "--osc-in", "127.0.0.1:0", "--osc-out", streams},
          {"--osc-in", "127.0.0.1:0", "--osc-out", streams, "--set", "/physics/sim/speed=50"}};
}

/// Returns "hash … tick …" of one run, or its output if it failed.
inline std::string hash_of(const std::string& scene, const std::vector<std::string>& options,
                           const std::vector<std::string>& prefix, const std::string& ticks = "200") {
  std::vector<std::string> args = {scene, "--ticks", ticks, "--hash"};
  args.insert(args.end(), options.begin(), options.end());
  const RunResult result = Process(limber_command(args, prefix)).finish();
  const std::size_t at = result.out.rfind("hash ");
  return result.code == 0 && at != std::string::npos ? result.out.substr(at) : result.out + result.err;
}

}  // namespace limber::app::test

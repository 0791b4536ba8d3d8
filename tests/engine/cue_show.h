// CueShow: a show with cues, for tests.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "engine/taken.h"

namespace limber::engine::test {

// The wind pushes the ball; handlers show in which order messages arrive.
inline constexpr const char* kCueScene = R"(
params { { "wind", 0, min = 0, max = 10 } }
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.1)
sim:add_body("ball"):add_part("p", ball, { mass = 1 })
local function part() return sim:body("ball").parts[1] end
sim:on_step(function() part():apply_force(vec3(params.wind, 0, 0)) end)
state.order = 1
osc:on("/cue/go", function() state.order = state.order * 2; part():apply_impulse(vec3(0, state.order, 0)) end)
osc:on("/note", function(x) state.order = state.order + x; part():apply_impulse(vec3(0, 0, state.order)) end)
)";
inline constexpr const char* kCues = R"({
  "limber cues": 1,
  "cues": [
    { "name": "calm", "messages": [["/scene/wind", 1], ["/note", 3]] },
    { "name": "storm", "preset": "filed", "time": 1, "easing": "linear", "follow": 0.5 },
    { "name": "end", "messages": [["/physics/sim/gravity", 0, 0, -2]], "note": "the lights go out" }
  ]
})";

struct CueShow : testing::Test {
  CueShow() {
    folder.write("scripts/scene.lua", kCueScene);
    folder.write("scripts/scene.presets.json", preset_file_text("/scene", "\"wind\": 4"));
    write(kCues);
  }
  void write(const std::string& cues) const { folder.write("scripts/scene.cues.json", cues); }
  EngineOptions options() const { return fast_options(folder.path("scripts/scene.lua")); }
  /// Sends a message, and executes it in a tick.
  template <class... A>
  static void send(Show& show, std::string address, A&&... args) {
    show.send(std::move(address), std::forward<A>(args)...);
    show.ticks(1);
  }
  static double current(Show& show) { return show.read("/cue/current"); }
  static bool sent(Show& show, const std::string& text) {
    const std::vector<std::string> texts = show.sent_texts();
    return std::ranges::any_of(texts, [&](const std::string& line) { return line.find(text) != line.npos; });
  }

  static bool logged(std::uint64_t since, const std::string& text) {
    return std::ranges::any_of(log_since(since),
                               [&](const LogLine& line) { return line.text.find(text) != line.text.npos; });
  }

  ShowFolder folder;
};

}  // namespace limber::engine::test

// A soak test's show: a list of actions (floods, saves, stopped calls, timers, presets, rewinds, resets, panics,
// pauses) that is recorded, replayed and compared; a list that diverges is reduced to the necessary actions.
#pragma once

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "engine/taken.h"

namespace limber::engine::test {

struct SoakAction {
  int tick = 0;
  int kind = 0;
  double x = 0;  ///< 0 to 1.
};

inline std::string soak_scene() {
  return std::string(kTakeScene) + R"(
local cues = 0
osc:on("/cue", function(seconds)
  cues = cues + 1
  local cue, arm = cues, sim:body("arm1")
  state.last = cue
  sim:after(seconds, function()
    if arm.alive then arm.parts[3]:apply_impulse(vec3(0, 0.01 * cue, rng:uniform(0, 0.01))) end
    state.pushes = (state.pushes or 0) + cue
    if cue % 3 == 0 then sim:after(seconds, function() sim.gravity = vec3(0, 0, -cue) end) end
  end)
end)
osc:on("/beat", function(seconds)
  local beats, timer = 0, nil
  timer = sim:every(seconds, function()
    beats = beats + 1
    params.wind = (params.wind + 0.125) % 2
    if beats == 20 then timer:cancel() end
  end)
end)
osc:on("/far", function(seconds) sim:after(seconds, function() while true do end end) end)
osc:on("/error", function(x) sim.gravity = vec3(0, x, 0); error("no") end)
sim:after(1.5, function() sim:body("arm1").parts[2]:apply_impulse(vec3(0.01, 0, 0)) end)
)";
}

/// The actions of the soak test; each is a message, a console text or a save.
struct SoakKind {
  const char* name;
  int weight;
  std::function<void(Show&, const ShowFolder&, double)> act;
};

inline void save_tool(Show& show, const ShowFolder& folder, double x) {
  folder.write("scripts/lib/tool.lua", fmt::format("return {{ depth = {:.3f}, more = {} }}\n", 0.1 + 0.3 * x, x < 0.5));
  run_while_ticking(show, [&] { show.engine.reload(); });
}

inline const std::vector<SoakKind>& soak_kinds() {
  using S = Show;
  using F = ShowFolder;
  static const std::vector<SoakKind> kinds = {
      {"flood", 30,
       [](S& s, const F&, double x) {
         for (int i = 0; i < 40; i++) s.send("/push", 0.01 * (x - 0.5) * (i % 3));
       }},
      {"spring", 20, [](S& s, const F&, double x) { s.send("/physics/motor/angularspringstiffness", "arm1", 20 * x); }},
      {"spawn", 6, [](S& s, const F&, double x) { s.send("/spawn", fmt::format("extra{}", static_cast<int>(4 * x))); }},
      {"gone", 4, [](S& s, const F&, double x) { s.send("/gone", fmt::format("extra{}", static_cast<int>(4 * x))); }},
      {"store", 4,
       [](S& s, const F&, double x) { s.send("/preset/store", fmt::format("p{}", static_cast<int>(3 * x))); }},
      {"recall", 6,
       [](S& s, const F&, double x) { s.send("/preset/recall", fmt::format("p{}", static_cast<int>(3 * x)), 0.3); }},
      {"console", 6,
       [](S& s, const F&, double x) {
         evaluate(s, fmt::format("sim:body('arm1').parts[3]:apply_impulse(rng:direction() * {})", 0.01 * x));
       }},
      {"console params", 4, [](S& s, const F&, double x) { evaluate(s, fmt::format("params.wind = {}", 2 * x)); }},
      {"console error", 2, [](S& s, const F&, double) { evaluate(s, "sim.gravity.x = sim.nothing"); }},
      {"console endless", 4, [](S& s, const F&, double) { evaluate(s, "while true do end"); }},
      {"console timer", 3,
       [](S& s, const F&, double x) {
         evaluate(s, fmt::format("sim:after({}, function() sim.gravity = vec3(0, 0, -9) end)", 2 * x));
       }},
      {"console memory", 1,
       [](S& s, const F&, double) { evaluate(s, "local t = {} for i = 1, 1e7 do t[i] = { i } end"); }},
      {"hang", 3,
       [](S& s, const F&, double x) {
         s.send("/physics/behavior/parameter", "arm1", x < 0.5 ? "sway" : "again", "hang", 1);
       }},
      {"unhang", 5,
       [](S& s, const F&, double x) {
         const char* which = x < 0.5 ? "sway" : "again";
         s.send("/physics/behavior/parameter", "arm1", which, "hang", 0);
         s.send("/physics/behavior/parameter", "arm1", which, "active", 1);
       }},
      {"undo", 5, [](S& s, const F&, double x) { s.send(x < 0.6 ? "/edit/undo" : "/edit/redo"); }},
      {"rerun", 3, [](S& s, const F&, double x) { s.send("/scene/count", 1 + static_cast<int>(3 * x)); }},
      {"reset", 2, [](S& s, const F&, double) { s.send("/transport/reset"); }},
      {"step", 2, [](S& s, const F&, double x) { s.send("/transport/step", static_cast<int>(6 * x)); }},
      {"pause", 2, [](S& s, const F&, double) { s.send("/transport/pause"); }},
      {"play", 6, [](S& s, const F&, double) { s.send("/transport/play"); }},
      {"panic", 3, [](S& s, const F&, double) { s.send("/transport/panic"); }},
      {"rewind", 5, [](S& s, const F&, double x) { s.send("/transport/rewind", 2 * x * x); }},
      {"step back", 3, [](S& s, const F&, double x) { s.send("/transport/step", -1 - static_cast<int>(40 * x)); }},
      {"rewind in a call", 3,
       [](S& s, const F&, double x) {
         evaluate(s, "while true do end");
         s.send("/transport/rewind", x);
         s.send("/loop", 1);
         s.send("/push", 0.01);
       }},
      {"loop", 5, [](S& s, const F&, double x) { s.send("/loop", x); }},
      {"error", 4, [](S& s, const F&, double x) { s.send("/error", x); }},
      {"cue", 6, [](S& s, const F&, double x) { s.send("/cue", 1.5 * x); }},
      {"beat", 2, [](S& s, const F&, double x) { s.send("/beat", 0.05 + x); }},
      {"far", 2, [](S& s, const F&, double x) { s.send("/far", x); }},
      {"place", 2,
       [](S& s, const F&, double x) {
         s.send("/physics/body/arm1/behavior/again/place", 1 + static_cast<int>(3 * x));
       }},
      {"save", 4, save_tool},
      {"bad save", 1,
       [](S& s, const F& folder, double x) {
         folder.write("scripts/lib/tool.lua", "return {");
         run_while_ticking(s, [&] { s.engine.reload(); });
         save_tool(s, folder, x);
       }},
  };
  return kinds;
}

inline std::vector<SoakAction> soak_actions(int ticks, std::uint64_t seed, double per_tick = 1.2) {
  Random random(seed, "soak");
  int all = 0;
  for (const SoakKind& kind : soak_kinds()) all += kind.weight;
  std::vector<SoakAction> actions;
  for (int tick = 0; tick < ticks; tick++) {
    while (random.uniform() < per_tick / (1 + per_tick)) {
      int at = static_cast<int>(random.uniform() * all);
      int kind = 0;
      while (at >= soak_kinds()[static_cast<std::size_t>(kind)].weight)
        at -= soak_kinds()[static_cast<std::size_t>(kind++)].weight;
      actions.push_back({tick, kind, random.uniform()});
    }
  }
  return actions;
}

struct SoakResult {
  std::string fault;  ///< Empty: the replay reached the take's hash.
  std::uint64_t stopped = 0, reloads = 0;
};

/// Plays the actions, records them, replays the take and compares.
inline SoakResult soak(const std::vector<SoakAction>& actions, int ticks) {
  const ShowFolder folder;
  write_take_scene(folder);
  folder.write("scripts/scene.lua", soak_scene());
  const std::string take = folder.path("soak.take");
  EngineOptions options = take_options(folder);
  options.record = take;
  std::uint64_t hash = 0;
  {
    Show show(options);
    auto next = actions.begin();
    for (int tick = 0; tick < ticks; tick++) {
      for (; next != actions.end() && next->tick <= tick; ++next)
        soak_kinds()[static_cast<std::size_t>(next->kind)].act(show, folder, next->x);
      show.ticks(1);
      show.sent_texts();
    }
    show.engine.end_take();
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  const ReplayOutcome replayed = replay_take(take);
  if (!replayed.error.empty()) return {replayed.error};
  if (replayed.result.diverged_at.has_value()) return {text_of(replayed.result)};
  if (replayed.result.truncated) return {"the take was cut off"};
  return {replayed.hash == hash ? "" : "the hash at the end differs"};
}

inline std::string text_of(const std::vector<SoakAction>& actions) {
  std::string text;
  for (const SoakAction& a : actions)
    text += fmt::format("  {{{}, {}, {:.17g}}},  // {}\n", a.tick, a.kind, a.x,
                        soak_kinds()[static_cast<std::size_t>(a.kind)].name);
  return text;
}

/// Delta debugging (Zeller's ddmin): returns a list of actions that still fails and has no removable part.
inline std::vector<SoakAction> minimize(std::vector<SoakAction> actions,
                                        const std::function<bool(const std::vector<SoakAction>&)>& fails) {
  std::size_t parts = 2;
  while (actions.size() >= 2) {
    const std::size_t size = (actions.size() + parts - 1) / parts;
    bool smaller = false;
    for (std::size_t at = 0; at < actions.size() && !smaller; at += size) {
      std::vector<SoakAction> rest(actions.begin(), actions.begin() + static_cast<std::ptrdiff_t>(at));
      rest.insert(rest.end(), actions.begin() + static_cast<std::ptrdiff_t>(std::min(at + size, actions.size())),
                  actions.end());
      if (rest.empty() || !fails(rest)) continue;
      actions = std::move(rest);
      parts = std::max<std::size_t>(parts - 1, 2);
      smaller = true;
    }
    if (smaller) continue;
    if (size == 1) break;
    parts = std::min(2 * parts, actions.size());
  }
  return actions;
}

/// Runs the soak test with a random seed; a failing list is reduced and printed.
inline void expect_soaks(int ticks, std::uint64_t seed) {
  log_to_stderr(false);
  const std::vector<SoakAction> actions = soak_actions(ticks, seed);
  const std::string fault = soak(actions, ticks).fault;
  if (fault.empty()) return;
  fmt::print("seed {}, {} actions: {}\n", seed, actions.size(), fault);  // reducing takes a while
  std::fflush(stdout);
  const auto fails = [&](const std::vector<SoakAction>& some) { return !soak(some, ticks).fault.empty(); };
  const std::vector<SoakAction> reduced = minimize(actions, fails);
  ADD_FAILURE() << "seed " << seed << ", " << ticks << " ticks: " << fault << "\nthe fewest actions that fail:\n"
                << text_of(reduced) << soak(reduced, ticks).fault;
}

}  // namespace limber::engine::test

// Lists the benchmark scenes and prints their results.
#include "app/commands/bench.h"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "app/commands/bench_arms.h"
#include "app/commands/bench_flock.h"
#include "app/commands/bench_history.h"
#include "app/commands/bench_lua.h"
#include "app/commands/bench_osc.h"
#include "app/commands/bench_panel.h"
#include "app/commands/bench_picture.h"
#include "app/commands/bench_preset.h"
#include "app/commands/bench_query.h"
#include "app/commands/bench_reload.h"
#include "app/commands/bench_solver.h"
#include "app/commands/bench_spawn.h"
#include "app/commands/bench_take.h"
#include "app/commands/bench_threads.h"
#include "app/exit_code.h"
#include "base/build_info.h"
#include "base/log/output.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

// The default number of ticks is a compromise between an undisturbed minimum and the duration of the benchmark.
template <int Arms, int Ticks>
Json run_arms(const BenchOptions& options) {
  return bench_arms(bench_arm_scene(Arms), std::min(30, Ticks), options.ticks > 0 ? options.ticks : Ticks,
                    options.compare_raw);
}

template <bool Direct>
Json run_arm_quality(const BenchOptions& options) {
  ArmScene scene = bench_arm_scene(1);
  scene.step = 1.0 / 60;
  scene.substeps = 1;
  scene.hanging = true;
  scene.direct = Direct;
  return bench_arms(scene, 60, options.ticks > 0 ? options.ticks : 360, options.compare_raw);
}

template <int Bodies>
Json run_flock(const BenchOptions& options) {
  return bench_flock(Bodies, options);
}

template <int Arms, int Ticks>
Json run_direct_arms(const BenchOptions& options) {
  return bench_arms(direct_arm_scene(Arms), std::min(30, Ticks), options.ticks > 0 ? options.ticks : Ticks,
                    options.compare_raw);
}

Json run_solver(const BenchOptions& options) { return bench_solver(options.ticks); }
Json run_swarm(const BenchOptions& options) { return bench_swarm(options.ticks); }
Json run_pile(const BenchOptions& options) { return bench_pile(options.ticks); }

std::string cpu_name() {
  const std::string name = system::processor_name();
  return name.empty() ? "unknown" : printable(name);
}

Json machine() {
  return {{"limber", std::string(version())},
          {"commit", std::string(commit())},
          {"cpu", cpu_name()},
          {"cores", std::thread::hardware_concurrency()}};
}

std::string words(std::string_view key) {
  std::string text(key);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string value_text(const Json& value) {
  return value.is_string() ? value.get<std::string>()
                           : (value.is_number() ? number_text(value.get<double>()) : value.dump());
}

void add_text(const Json& figures, const std::string& before, std::string& out) {
  for (const auto& [key, value] : figures.items()) {
    const std::string name = before + words(key);
    const bool deep =
        value.is_object() && std::any_of(value.begin(), value.end(), [](const Json& v) { return v.is_structured(); });
    if (deep) {
      add_text(value, name + " ", out);
    } else if (value.is_object()) {
      out += fmt::format("  {:<30}", name);
      for (const auto& [each, number] : value.items()) out += fmt::format("  {} {}", words(each), value_text(number));
      out += '\n';
    } else {
      out += fmt::format("  {:<30}  {}\n", name, value_text(value));
    }
  }
}

const BenchScene* find_scene_named(std::string_view name) {
  const auto found = std::ranges::find_if(bench_scenes(), [&](const BenchScene& s) { return same_name(s.name, name); });
  return found == bench_scenes().end() ? nullptr : &*found;
}

}  // namespace

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> scenes = {
      {"arms-1", "one arm of 17 parts with a servo per joint, gravity, floor", &run_arms<1, 1200>},
      {"arms-16", "16 such arms", &run_arms<16, 240>},
      {"arms-100", "100 such arms", &run_arms<100, 80>},
      {"arms-1000", "1000 such arms", &run_arms<1000, 16>},
      {"arm-quality", "one hanging arm, one internal step of 1/60 s: joint gaps and servo errors",
       &run_arm_quality<false>},
      {"arm-direct", "the same with the direct solver", &run_arm_quality<true>},
      {"arms-100-direct", "100 arms, direct solver, one internal step of 1/60 s", &run_direct_arms<100, 80>},
      {"arms-1000-direct", "1000 arms, direct solver, one internal step of 1/60 s", &run_direct_arms<1000, 16>},
      {"solver", "arms, trees, legs and random trees: stock Bullet against the direct solver, 1/60 s", &run_solver},
      {"swarm-300", "a clump of 300 six-part creatures: stock Bullet against Limber", &run_swarm},
      {"pile-2000", "a pile of 2000 boxes: stock Bullet against Limber", &run_pile},
      {"threads", "100 and 1000 arms with two threads against one", &bench_threads},
      {"flock-1k", "1000 bodies with 30 neighbors each: cohesion and alignment", &run_flock<1000>},
      {"flock-10k", "10 000 such bodies", &run_flock<10000>},
      {"flock-100k", "100 000 such bodies", &run_flock<100000>},
      {"lua-twin", "each built-in behavior against its equivalent in Lua, 10 000 parts each", &bench_lua_twin},
      {"lua-garbage", "Lua behaviors that produce garbage: time of garbage collection", &bench_lua_garbage},
      {"lua-many", "1000 instances of a small Lua behavior", &bench_lua_many},
      {"spawn", "import urdf/arm17.urdf and create 1000 copies", &bench_spawn},
      {"reload", "saving a scene while it plays: delay until the new version runs, and effect on ticks", &bench_reload},
      {"preset", "presets of all properties of 1000 arms: store, recall, morph", &bench_preset},
      {"take", "16 arms and 1000 messages per second: cost of recording a take, and its replay", &bench_take},
      {"history", "1, 100 and 1000 arms: checkpoints and rewind", &bench_history},
      {"osc-in", "messages per second from a socket into properties; a burst of 10 000", &bench_osc_in},
      {"osc-latency", "response time: /ping, and setting a value", &bench_osc_latency},
      {"osc-out", "frames of 1000 bodies in three streams", &bench_osc_out},
      {"panel", "a frame of the panel with 1000 arms, without drawing", &bench_panel},
      {"picture", "frames per second without a window: 16 arms small, 1000 arms large", &bench_picture},
      {"query", "16 arms with and without 100 WebSocket clients that listen to 50 values each", &bench_query},
  };
  return scenes;
}

std::string bench_scene_list() {
  std::string list;
  for (const BenchScene& scene : bench_scenes()) list += (list.empty() ? "" : ",") + std::string(scene.name);
  return list;
}

std::string bench_text(const nlohmann::ordered_json& figures) {
  std::string out;
  add_text(figures, "", out);
  return out;
}

int bench_command(const BenchOptions& options) {
  std::vector<const BenchScene*> selected;
  for (const std::string& name : options.scenes) {
    selected.push_back(find_scene_named(name));
    if (selected.back() != nullptr) continue;
    std::vector<std::string_view> names;
    for (const BenchScene& scene : bench_scenes()) names.push_back(scene.name);
    return fail(kUsageError, fmt::format("unknown benchmark '{}'{}", name, name_hint(name, names)));
  }
  if (selected.empty()) {
    for (const BenchScene& scene : bench_scenes()) selected.push_back(&scene);
  }
  Json all = machine();
  if (!options.json) print_result("{}", bench_text(all));
  all["scenes"] = Json::array();
  for (const BenchScene* scene : selected) {
    if (!options.json && !print_result("{}: {}\n", scene->name, scene->doc)) break;
    Json figures = {{"scene", std::string(scene->name)}};
    figures.update(scene->run(options));
    if (!options.json) {
      figures.erase("scene");
      print_result("{}", bench_text(figures));
    } else {
      all["scenes"].push_back(std::move(figures));
    }
  }
  if (options.json) print_result("{}\n", all.dump(2));
  return kSuccess;
}

}  // namespace limber

// Lists the measurements, runs them and prints their results.
#include "bench/measure/measures.h"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/build_info.h"
#include "base/log/output.h"
#include "base/system/process.h"
#include "base/text.h"
#include "bench/measure/arms.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

// The default number of ticks is a compromise between an undisturbed minimum and the duration of the benchmark.
template <int Arms, int Ticks>
Json run_arms(const MeasureOptions& options) {
  return measure_arms(arm_scene(Arms), std::min(30, Ticks), options.ticks > 0 ? options.ticks : Ticks,
                      options.compare_raw);
}

template <bool Direct>
Json run_arm_quality(const MeasureOptions& options) {
  ArmScene scene = arm_scene(1);
  scene.step = 1.0 / 60;
  scene.substeps = 1;
  scene.hanging = true;
  scene.direct = Direct;
  return measure_arms(scene, 60, options.ticks > 0 ? options.ticks : 360, options.compare_raw);
}

template <int Bodies>
Json run_flock(const MeasureOptions& options) {
  return measure_flock(Bodies, options);
}

template <int Arms, int Ticks>
Json run_direct_arms(const MeasureOptions& options) {
  return measure_arms(direct_arm_scene(Arms), std::min(30, Ticks), options.ticks > 0 ? options.ticks : Ticks,
                      options.compare_raw);
}

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

const Measure* find_measure(std::string_view name) {
  const auto found = std::ranges::find_if(measures(), [&](const Measure& s) { return same_name(s.name, name); });
  return found == measures().end() ? nullptr : &*found;
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all = {
      {"arms-1", "one arm of 17 parts with a servo per joint, gravity, floor", &run_arms<1, 1200>},
      {"arms-16", "16 such arms", &run_arms<16, 240>},
      {"arms-100", "100 such arms", &run_arms<100, 80>},
      {"arms-1000", "1000 such arms", &run_arms<1000, 16>},
      {"arm-quality", "one hanging arm, one substep of 1/60 s: joint gaps and servo errors", &run_arm_quality<false>},
      {"arm-direct", "the same with the direct solver", &run_arm_quality<true>},
      {"arms-100-direct", "100 arms, direct solver, one substep of 1/60 s", &run_direct_arms<100, 80>},
      {"arms-1000-direct", "1000 arms, direct solver, one substep of 1/60 s", &run_direct_arms<1000, 16>},
      {"solver", "arms, trees, legs and random trees: stock Bullet against the direct solver, 1/60 s", &measure_solver},
      {"swarm-300", "a clump of 300 six-part creatures: stock Bullet against Limber", &measure_swarm},
      {"pile-2000", "a pile of 2000 boxes: stock Bullet against Limber", &measure_pile},
      {"terrain", "100 quadrupeds on 512 × 512 heights against a plane", &measure_terrain},
      {"threads", "100 and 1000 arms with two threads against one", &measure_threads},
      {"flock-1k", "1000 bodies with 30 neighbors each: cohesion and alignment", &run_flock<1000>},
      {"flock-10k", "10 000 such bodies", &run_flock<10000>},
      {"flock-100k", "100 000 such bodies", &run_flock<100000>},
      {"lua-twin", "each built-in behavior against its equivalent in Lua, 10 000 parts each", &measure_lua_twin},
      {"lua-garbage", "Lua behaviors that produce garbage: time of garbage collection", &measure_lua_garbage},
      {"lua-many", "1000 instances of a small Lua behavior", &measure_lua_many},
      {"spawn", "import urdf/arm17.urdf and create 1000 copies", &measure_spawn},
      {"reload", "saving a scene while it plays: delay until the new version runs, and effect on ticks",
       &measure_reload},
      {"preset", "presets of all properties of 1000 arms: store, recall, morph", &measure_preset},
      {"policy", "an evaluation of a network of 48-256-256-12, and of a GRU", &measure_policy},
      {"take", "16 arms and 1000 messages per second: cost of recording a take, and its replay", &measure_take},
      {"history", "1, 100 and 1000 arms: checkpoints and rewind", &measure_history},
      {"osc-in", "messages per second from a socket into properties; a burst of 10 000", &measure_osc_in},
      {"osc-latency", "response time: /ping, and setting a value", &measure_osc_latency},
      {"osc-out", "frames of 1000 bodies in three streams", &measure_osc_out},
      {"panel", "a frame of the panel with 1000 arms, without drawing", &measure_panel},
      {"picture", "frames per second without a window: 16 arms small, 1000 arms large", &measure_picture},
      {"query", "16 arms with and without 100 WebSocket clients that listen to 50 values each", &measure_query},
  };
  return all;
}

std::string text_of(const nlohmann::ordered_json& figures) {
  std::string out;
  add_text(figures, "", out);
  return out;
}

int run_measures(const MeasureOptions& options) {
  std::vector<const Measure*> selected;
  for (const std::string& name : options.names) {
    selected.push_back(find_measure(name));
    if (selected.back() != nullptr) continue;
    std::vector<std::string_view> names;
    for (const Measure& measure : measures()) names.push_back(measure.name);
    return app::fail(app::kUsageError, fmt::format("unknown measurement '{}'{}", name, name_hint(name, names)));
  }
  if (selected.empty()) {
    for (const Measure& measure : measures()) selected.push_back(&measure);
  }
  Json all = machine();
  if (!options.json) print_result("{}", text_of(all));
  all["scenes"] = Json::array();
  for (const Measure* measure : selected) {
    if (!options.json && !print_result("{}: {}\n", measure->name, measure->doc)) break;
    Json figures = {{"scene", std::string(measure->name)}};
    figures.update(measure->run(options));
    if (!options.json) {
      figures.erase("scene");
      print_result("{}", text_of(figures));
    } else {
      all["scenes"].push_back(std::move(figures));
    }
  }
  if (options.json) print_result("{}\n", all.dump(2));
  return app::kSuccess;
}

}  // namespace limber

// Plays scenes from a temporary folder and reads the time of each behavior from its readout.
#include "bench/measure/measures.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "app/paths.h"
#include "base/log/log.h"
#include "base/system/process.h"
#include "bench/measure/times.h"
#include "engine/engine.h"
#include "sim/behavior/behavior_list.h"
#include "support/world_objects.h"

namespace limber {

namespace {

using Json = nlohmann::ordered_json;

// a show in a temporary folder, deleted by the destructor
class BenchShow {
 public:
  BenchShow(const std::string& scene, const std::string& behavior) {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("limber_bench_{}", system::process_id());
    std::filesystem::create_directories(folder_ / "scripts");
    std::filesystem::create_directories(folder_ / "behaviors_lua");
    std::ofstream(folder_ / "scripts" / "scene.lua") << scene;
    std::ofstream(folder_ / "behaviors_lua" / "small.lua") << behavior;
    engine::EngineOptions options;
    options.scene = (folder_ / "scripts" / "scene.lua").string();
    options.scene_options.data_dir = app::data_dir();
    options.scene_options.limits.run_ms *= 10;
    options.scene_options.limits.call_ms *= 10;
    engine_ = std::make_unique<engine::Engine>(link_, options);
    started_ = engine_->start();
  }
  ~BenchShow() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  BenchShow(const BenchShow&) = delete;
  BenchShow& operator=(const BenchShow&) = delete;

  const Result<void>& started() const { return started_; }
  engine::Engine& engine() { return *engine_; }

 private:
  std::filesystem::path folder_;
  engine::EngineLink link_;
  std::unique_ptr<engine::Engine> engine_;
  Result<void> started_;
};

// defines cloud(): `count` parts in a grid; `in_one`: as one body, else one body per part
constexpr const char* kClouds = R"(
sim.gravity, sim.substeps, sim.solver_iterations = vec3(), 1, 1
local ball = sim:add_sphere_shape("ball", 0.1)
local function cloud(name, count, in_one, at)
  local side = math.ceil(count ^ (1 / 3))
  local body = in_one and sim:add_body(name)
  for i = 0, count - 1 do
    local place = at + vec3(i % side, math.floor(i / side) % side, math.floor(i / side ^ 2))
    local of = body or sim:add_body(name .. i)
    of:add_part(in_one and "p" .. i or "ball", ball, { mass = 1, position = place })
  end
  return body
end
)";

// defines rack(): `count` parts in a grid, with a motor on each joint
constexpr const char* kMotors = R"(
sim.gravity, sim.substeps, sim.solver_iterations = vec3(), 1, 1
local ball = sim:add_sphere_shape("ball", 0.1)
local function rack(name, count, at)
  local body = sim:add_body(name)
  local side = math.ceil(math.sqrt(count))
  local base = body:add_part("base", ball, { mass = 0, position = at + vec3(0, 0, 2) })
  for i = 0, count - 1 do
    local place = at + vec3(i % side, math.floor(i / side), 0)
    local part = body:add_part("p" .. i, ball, { mass = 1, position = place })
    body:add_motor(body:add_joint("j" .. i, base, part, { position = place }))
  end
  return body
end
)";

struct Twin {
  std::string_view type;
  std::string_view opts;  // as Lua
  bool group = false;
  bool motors = false;
};
constexpr Twin kTwins[] = {
    {"force", "amp = 0.01"},
    {"torque", "torque = vec3(0, 0, 0.001)"},
    {"random_force", "max_amp = 0.01, rand_interval = 200"},
    {"random_torque", "scale = 0.001, rand_interval = 200"},
    {"speed", "amount = 0.01"},
    {"target_attraction", "target_pos = vec3(10, 10, 10), max_dist = 1000, max_amp = 0.01"},
    {"volume", "max_dist = 3, max_amp = 0.01"},
    {"rotation_target", "target = vec3(0, 0, 0.5)", false, true},
    {"random_rotation_target", "max_target = vec3(0, 0, 0.5), rand_interval = 200", false, true},
    {"cohesion", "max_dist = 2, amount = 0.001", true},
    {"alignment", "max_dist = 2, amount = 0.001", true},
    {"separation", "max_dist = 2, amount = 0.001", true},
};

std::string twin_scene(const Twin& twin, int parts) {
  const auto line = [&](const char* body, const std::string& type) {
    if (twin.group) {
      return fmt::format(
          "cloud('{0}', {1}, false, vec3({3}, 0, 0)) sim:add_group_behavior('{2}', '{0}', {{ bodies = "
          "'{0}*', {4} }})\n",
          body, parts, type, body[0] == 'c' ? 0 : 1000, twin.opts);
    }
    return fmt::format("{5}('{0}', {1}, {6}vec3({3}, 0, 0)):add_behavior('{2}', 'it', {{ {4} }})\n", body, parts, type,
                       body[0] == 'c' ? 0 : 1000, twin.opts, twin.motors ? "rack" : "cloud",
                       twin.motors ? "" : "true, ");
  };
  return std::string(twin.motors ? kMotors : kClouds) + line("cpp", std::string(twin.type)) +
         line("lua", fmt::format("lua_{}", twin.type));
}

// time of the last tick in microseconds
double time_of(const sim::World& world, const Twin& twin, const std::string& body) {
  const Store& store = world.store();
  const NodeId id =
      twin.group ? world.behaviors().find_group(body)->id() : world.find_body(body)->behaviors().find("it")->id();
  double time = 0;
  store.get(id, store.table(id).at("time"), &time);
  return time;
}

Json measure(const Twin& twin, int parts, int ticks) {
  BenchShow show(twin_scene(twin, parts), "");
  if (!show.started()) return {{"error", show.started().error()}};
  TimeSamples built_in, lua;
  sim::World& world = show.engine().world();
  for (int i = -10; i < ticks; i++) {
    show.engine().tick();
    if (i < 0) continue;
    built_in.add(1e-6 * time_of(world, twin, "cpp"));
    lua.add(1e-6 * time_of(world, twin, "lua"));
  }
  return {{"cpp_ns_a_part", rounded(1e9 * built_in.quantile(0.5) / parts, 1)},
          {"lua_ns_a_part", rounded(1e9 * lua.quantile(0.5) / parts, 1)},
          {"ratio_of_medians", rounded(lua.quantile(0.5) / built_in.quantile(0.5), 2)},
          {"ratio_of_minima", rounded(lua.quantile(0) / built_in.quantile(0), 2)},
          {"faults", show.engine().faults()}};
}

// `instances` one-part bodies, each with the behavior `small`
std::string many_scene(int instances) {
  return std::string(kClouds) + fmt::format(
                                    "cloud('b', {}, false, vec3())\n"
                                    "for _, body in ipairs(sim.bodies) do body:add_behavior('small', 'it') end\n",
                                    instances);
}

// time of garbage collection in the ticks of a scene with `instances` behaviors
Json measure_garbage(const char* behavior, int instances, int ticks) {
  BenchShow show("sim.history = 0\n" + many_scene(instances), behavior);
  if (!show.started()) return {{"error", show.started().error()}};
  TimeSamples slices;
  for (int i = 0; i < ticks; i++) {
    show.engine().tick();
    // shorter times are only checks of the memory in use
    if (const double seconds = show.engine().times().gc; seconds > 20e-6) slices.add(seconds);
  }
  if (slices.empty()) return {{"slices", 0}};
  return {{"slices", slices.count()},
          {"median_us", TimeSamples::in_microseconds(slices.quantile(0.5))},
          {"longest_us", TimeSamples::in_microseconds(slices.quantile(1))},
          {"faults", show.engine().faults()}};
}

}  // namespace

nlohmann::ordered_json measure_lua_twin(const MeasureOptions& options) {
  constexpr int kParts = 10000;
  const int ticks = options.ticks > 0 ? options.ticks : 60;
  Json figures = {{"parts", kParts}, {"ticks", ticks}};
  for (const Twin& twin : kTwins) figures[std::string(twin.type)] = measure(twin, kParts, ticks);
  return figures;
}

nlohmann::ordered_json measure_lua_garbage(const MeasureOptions& options) {
  const int ticks = options.ticks > 0 ? options.ticks : 2000;
  // a table, a vector and a string per tick, which replace those of the last tick
  constexpr const char* kLast =
      "return behavior { step = function(self)\n"
      "self.state.last = { at = self.parts[1].center, name = 'at ' .. sim.tick } end }\n";
  // the same, replacing those of a second ago in a long table, which LuaJIT traverses again atomically if it changes
  constexpr const char* kPast =
      "return behavior { start = function(self) self.state.past, self.state.at = {}, 0 end,\n"
      "step = function(self) self.state.at = self.state.at % 60 + 1\n"
      "self.state.past[self.state.at] = { at = self.parts[1].center, name = 'at ' .. sim.tick } end }\n";
  return {{"ticks", ticks},
          {"1000 instances", measure_garbage(kLast, 1000, ticks)},
          {"100 with a past of a second", measure_garbage(kPast, 100, ticks)},
          {"1000 with such a past", measure_garbage(kPast, 1000, ticks)}};
}

nlohmann::ordered_json measure_lua_many(const MeasureOptions& options) {
  constexpr int kInstances = 1000;
  const int ticks = options.ticks > 0 ? options.ticks : 200;
  const std::string small =
      "return behavior { params = { { 'lift', 0.01, unit = 'N' } },\n"
      "step = function(self) self.parts[1]:apply_force(vec3(0, 0, self.lift)) end }\n";
  BenchShow show(many_scene(kInstances), small);
  if (!show.started()) return {{"error", show.started().error()}};
  TimeSamples behaviors;
  for (int i = -20; i < ticks; i++) {
    show.engine().tick();
    if (i >= 0) behaviors.add(show.engine().times().behaviors);
  }
  return {{"instances", kInstances},
          {"ticks", ticks},
          {"behaviors_us", behaviors.microseconds()},
          {"ns_an_instance", rounded(1e9 * behaviors.quantile(0.5) / kInstances, 1)},
          {"faults", show.engine().faults()}};
}

}  // namespace limber

// What tests of behaviours in Lua share: a stage with a ball, a file of behaviors_lua/, a behaviour of it.
#pragma once

#include <string>

#include "script/lua_behavior.h"
#include "sim/behavior_list.h"
#include "stage.h"

namespace limber {

inline constexpr const char* kBall = R"(
sim.gravity = vec3()
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 2 })
)";

inline SceneOptions with_data(const std::filesystem::path& folder) {
  SceneOptions options;
  options.data_dir = folder.string();
  return options;
}

/// A ball with the behaviour "it" of the type "test", whose file has this text; `opts` as in Lua.
class BehaviorStage : public Stage {
 public:
  using Stage::Stage;
  std::string play_one(const std::string& file, int ticks = 0, const std::string& opts = "{}") {
    write("behaviors_lua/test.lua", file);
    return play(std::string(kBall) + "ball:add_behavior('test', 'it', " + opts + ")", ticks);
  }
  Behavior& it() const { return *world.find_body("ball")->find_behavior("it"); }
  const Row& row(std::string_view name) const { return it().type().table->at(name); }
  double value(std::string_view name) const { return store.values(it().id(), row(name))[0]; }
  void set(std::string_view name, double v) const { (void)store.set(it().id(), name, {&v, 1}); }
};

/// A behaviour whose step is this text; parameters `speed` (1, 0 .. 10) and `way` (a vec3).
inline std::string stepping(const std::string& step) {
  return "return behavior { params = { { 'speed', 1, min = 0, max = 10 }, { 'way', vec3(1, 0, 0) } },\n"
         "step = function(self, dt) " +
         step + " end }";
}

/// What print writes in the first step of a behaviour, or the first line of what goes wrong.
inline std::string step_says(const std::string& step, const std::string& opts = "{}") {
  BehaviorStage stage;
  const std::string fault = stage.play_one(stepping(step), 1, opts);
  if (!fault.empty()) return first_line(fault);
  if (!stage.it().error().empty()) return first_line(stage.it().error());
  return stage.host.printed.empty() ? "nothing printed" : stage.host.printed.back();
}

/// The first line of the error of a scene that names a type with this file, or "no error".
inline std::string load_error(const std::string& file) {
  BehaviorStage stage;
  const std::string fault = stage.play_one(file);
  return fault.empty() ? "no error" : first_line(fault);
}

}  // namespace limber

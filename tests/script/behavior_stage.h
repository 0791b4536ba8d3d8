// BehaviorFixture, for tests of behaviors in Lua: a ball with a behavior from a file of behaviors_lua/.
#pragma once

#include <string>

#include "script/behaviors/lua_behavior.h"
#include "sim/behavior/behavior_list.h"
#include "stage.h"

namespace limber::script {

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

/// A ball with the behavior "it" of the type "test" with this file text; `opts` as in Lua.
class BehaviorFixture : public ScriptFixture {
 public:
  using ScriptFixture::ScriptFixture;
  std::string play_one(const std::string& file, int ticks = 0, const std::string& opts = "{}") {
    write("behaviors_lua/test.lua", file);
    return play(std::string(kBall) + "ball:add_behavior('test', 'it', " + opts + ")", ticks);
  }
  sim::Behavior& it() const { return *world.find_body("ball")->behaviors().find("it"); }
  const Property& property_at(std::string_view name) const { return it().type().table->at(name); }
  double value(std::string_view name) const { return store.values(it().id(), property_at(name))[0]; }
  void set(std::string_view name, double v) const { (void)store.set(it().id(), name, {&v, 1}); }
};

/// A behavior with this text as its step; parameters `speed` (1, 0 .. 10) and `way` (a vec3).
inline std::string behavior_with_step(const std::string& step) {
  return "return behavior { params = { { 'speed', 1, min = 0, max = 10 }, { 'way', vec3(1, 0, 0) } },\n"
         "step = function(self, dt) " +
         step + " end }";
}

/// Returns the output of the first step of a behavior, or the first line of its error.
inline std::string step_output(const std::string& step, const std::string& opts = "{}") {
  BehaviorFixture fixture;
  const std::string fault = fixture.play_one(behavior_with_step(step), 1, opts);
  if (!fault.empty()) return first_line(fault);
  if (!fixture.it().error().empty()) return first_line(fixture.it().error());
  return fixture.host.printed.empty() ? "nothing printed" : fixture.host.printed.back();
}

/// Returns the first line of the error of a scene that uses a type with this file, or "no error".
inline std::string load_error(const std::string& file) {
  BehaviorFixture fixture;
  const std::string fault = fixture.play_one(file);
  return fault.empty() ? "no error" : first_line(fault);
}

}  // namespace limber::script

// A fault of any kind that repeats every tick gets ten lines of the log on standard error; the panel gets all lines.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/log/log.h"
#include "base/log/log_throttle.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

struct RepeatedFault {
  const char* name;
  const char* scene;
  const char* needle;        // in each line of the fault
  const char* message = "";  // sent before each tick
};

// faults with a text that differs from tick to tick, if possible
constexpr RepeatedFault kRepeatedFaults[] = {
    {"on_step", "sim:on_step(function() error('fails at ' .. sim.tick) end)", "fails at"},
    {"every", "sim:every(0.0001, function() error('fails at ' .. sim.tick) end)", "fails at"},
    {"after", "local function again() sim:after(0, again) error('fails at ' .. sim.tick) end sim:after(0, again)",
     "fails at"},
    {"osc:on", "osc:on('/go', function() error('fails at ' .. sim.tick) end)", "fails at", "/go"},
    {"after, a new text each time",
     "local function fails() error(rng:uniform() .. ('q'):rep(sim.tick)) end "
     "sim:on_step(function() sim:after(0, fails) end)",
     "qq"},
    {"on_contact",
     R"(sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
        local ball = sim:add_body("ball"):add_part("p", sim:add_sphere_shape("ball", 0.1))
        ball.report_contacts = true
        sim:on_step(function() ball.position = vec3(0, 0, sim.tick % 2 == 0 and 0.05 or 1) end)
        sim:on_contact(function() error('fails at ' .. sim.tick) end))",
     "fails at"},
    {"warn", "sim:on_step(function() warn('careful: ' .. sim.tick .. ' is late') end)", "careful"},
    {"a value that is not allowed", "sim:on_step(function() pcall(function() sim.gravity = 1 end) sim.tick = 3 end)",
     "tick"},
    {"a part out of control",
     R"(local body = sim:add_body("ball")
        local part = body:add_part("p", sim:add_sphere_shape("ball", 0.1))
        sim:on_step(function() body.enabled = true part.position = vec3(1e7 + sim.tick, 0, 0) end))",
     " again; the body"},
    {"a reset of a scene with an error", "", "reset:", "/transport/reset"},
};

TEST(LogLimit, AppliesToEachKindOfRepeatedFault) {
  std::string text_before;
  for (const RepeatedFault& kind : kRepeatedFaults) {
    SCOPED_TRACE(kind.name);
    text_before += '\n';  // each is at another line
    const SceneFile scene(*kind.scene == '\0' ? "" : text_before + kind.scene);
    Show show(scene.path());
    if (*kind.scene == '\0') scene.write("this is no Lua");
    const std::uint64_t before = log_newest();
    log_to_stderr(true);  // other tests silence it
    log_forget_sources();
    testing::internal::CaptureStderr();
    for (int i = 0; i < 60; i++) {
      if (*kind.message != '\0') show.send(kind.message);
      show.ticks(1);
    }
    const std::string text = testing::internal::GetCapturedStderr();
    const std::vector<std::string_view> lines = split(text, '\n');
    const auto count = std::ranges::count_if(lines, [&](std::string_view line) {
      return line.starts_with("limber: ") && line.find(kind.needle) != line.npos;
    });
    EXPECT_GE(count, 1) << text;
    EXPECT_LE(count, LogThrottle::kBurst) << text;
    EXPECT_LE(text.size(), 30000U) << "nor may other lines about it fill the disk";
    EXPECT_GE(log_newest() - before, static_cast<std::uint64_t>(count)) << "the panel has them all";
  }
}

}  // namespace
}  // namespace limber::engine::test

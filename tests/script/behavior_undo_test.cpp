// Rollback of behaviors that a failing script call removed, reset or reactivated: they continue bit for bit, with
// random draws, intervals and state.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "behavior_stage.h"

namespace limber::script {
namespace {

constexpr double kUndoCallMs = 5 * kBudgetScale;

SceneOptions undo_limits() {
  SceneOptions options;
  options.limits.call_ms = kUndoCallMs;
  options.limits.memory = std::size_t{16} << 20u;
  return options;
}

// a behavior with random draws, an interval and state; a group that uses its neighbors
constexpr const char* kDrawing = R"(
return behavior {
  params = { { "pause", 40, min = 0, max = 1000, unit = "ms" } },
  start = function(self) self.state.n, self.state.push = 0, vec3() end,
  step = function(self)
    if self:due("pause") then
      self.state.n, self.state.push = self.state.n + 1, self.rng:direction() * (1 + math.random())
      print(self.body.name, sim.tick, self.state.n)
    end
    for _, part in ipairs(self.parts) do part:apply_force(self.state.push) end
  end,
}
)";
constexpr const char* kNear = R"(
return behavior {
  group = true,
  step = function(self)
    for _, part in ipairs(self.parts) do
      for _, offset in self:neighbors(part, 10) do part:apply_force(offset * self.rng:uniform()) end
    end
  end,
}
)";
constexpr const char* kUndoScene = R"(
sim.gravity = vec3()
local shape = sim:add_sphere_shape("ball", 0.1)
a, b = sim:add_body("a"), sim:add_body("b")
for i, body in ipairs { a, b } do
  body:add_part("ball", shape, { position = vec3(2 * i, 0, 0) })
  body:add_behavior("random_force", "wind", { rand_interval = 50 })
  body:add_behavior("drawing", "drawing")
end
sim:add_group_behavior("near", "near")
sim:add_group_behavior("cohesion", "cohesion")
)";

struct RunResult {
  std::uint64_t hash = 0;
  std::vector<std::string> printed, order;
  bool operator==(const RunResult&) const = default;
};

// the scene with additional code, and a behavior "guest" of body a with this step
RunResult play(const std::string& more, const std::string& guest, std::size_t faults) {
  ScriptFixture fixture(undo_limits());
  std::size_t fault_count = 0;
  fixture.world.behaviors().on_fault([&](const sim::Behavior&) { fault_count++; });
  fixture.write("behaviors_lua/drawing.lua", kDrawing);
  fixture.write("behaviors_lua/near.lua", kNear);
  fixture.write("behaviors_lua/guest.lua", "return behavior { step = function(self)\n" + guest + "\nend }");
  EXPECT_EQ(fixture.play(kUndoScene + std::string("a:add_behavior('guest', 'guest')\n") + more, 40), "");
  EXPECT_EQ(fixture.host.faults.size() + fault_count, faults) << more << guest;
  RunResult result{fixture.scene.state_hash(fixture.world.state_hash()), fixture.host.printed,
                   fixture.world.behaviors().order().keys()};
  fixture.world.behaviors().on_fault({});
  return result;
}

const char* const kEnds[] = {"error('x')", "while true do end", "local t = {} for i = 1, 1e9 do t[i] = { i } end"};

const char* const kActions[] = {
    "sim:body('a'):behavior('wind'):remove()",
    "sim:body('a'):behavior('drawing'):remove()",
    "sim:body('b'):behavior('near'):remove()",
    "for _, each in ipairs(sim:body('a').behaviors) do each:remove() end",
    "sim:group_behavior('near'):remove() sim:group_behavior('cohesion'):remove()",
    "sim:body('a'):behavior('drawing'):remove() sim:body('a'):remove() sim:group_behavior('near'):remove()",
    "sim:body('b'):remove() sim:group_behavior('cohesion'):remove()",
    "sim:body('a'):reset() sim:body('b'):behavior('drawing').active = false",
    "sim:body('a'):behavior('drawing').pause = 0 sim:body('a'):behavior('drawing'):remove()",
};

TEST(BehaviorsUndone, AFailedCallbackRemovesNothing) {
  const RunResult alone = play("", "", 0);
  EXPECT_EQ(alone.printed.size(), 34u) << "40 ticks of 1/60 s have 17 intervals of 40 ms";
  for (const char* action : kActions) {
    for (const char* end : kEnds) {
      EXPECT_EQ(play(fmt::format("sim:at(0.2, function() {} {} end)", action, end), "", 1), alone)
          << action << " " << end;
    }
    EXPECT_NE(play(fmt::format("sim:at(0.2, function() {} end)", action), "", 0), alone) << action;
  }
  // objects that it created or looked up are rolled back
  EXPECT_EQ(play("sim:at(0.2, function() a:add_part('more', shape) local n = #a:behavior('drawing').parts "
                 "if n == 2 then error('x') end end)",
                 "", 1),
            alone);
  // the same if they were created first
  EXPECT_EQ(play("sim:at(0.2, function() a:copy('c'):behavior('drawing'):remove() a:behavior('wind'):remove() "
                 "a:add_behavior('force', 'wind'):remove() error('x') end)",
                 "", 1),
            alone);
}

TEST(BehaviorsUndone, AFailedBehaviorRemovesNothing) {
  // Reference: a behavior that only fails; suspended, it is part of the hash.
  const RunResult suspended = play("", "if sim.tick == 12 then error('x') end", 1);
  for (const char* action : kActions) {
    for (const char* end : kEnds) {
      EXPECT_EQ(play("", fmt::format("if sim.tick == 12 then {} {} end", action, end), 1), suspended)
          << action << " " << end;
    }
  }
  EXPECT_EQ(play("", "if sim.tick == 12 then self.rng:uniform() math.random() error('x') end", 1), suspended);
  // without an error all are removed, including itself
  EXPECT_NE(play("", fmt::format("if sim.tick == 12 then {} end", kActions[3]), 0), suspended);
}

TEST(BehaviorsUndone, AnIntervalOfAFailedStepRepeats) {
  BehaviorFixture fixture;
  ASSERT_EQ(fixture.play_one("return behavior { params = { { 'pause', 1000 }, { 'bad', true } },\n"
                             "step = function(self) if self:due('pause') then\n"
                             "  if self.bad then error('x') end print('beat') end end }",
                             3),
            "");
  ASSERT_NE(fixture.it().error(), "");
  fixture.set("bad", 0);
  fixture.set("active", 1);
  fixture.tick(3);
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"beat"}));
}

TEST(BehaviorsUndone, AFailedReactivationKeepsTheError) {
  BehaviorFixture fixture;
  fixture.write("behaviors_lua/test.lua", "return behavior { step = function() error('ill') end }");
  ASSERT_EQ(fixture.play(std::string(kBall) + R"(
ball:add_behavior('test', 'it')
sim:at(0.1, function() ball:behavior('it').active = true error('x') end)
)",
                         10),
            "");
  EXPECT_EQ(first_line(fixture.it().error()), "behaviors_lua/test.lua:1: ill");
}

}  // namespace
}  // namespace limber::script

// Behaviours that a failing call of a script removed, reset or switched on again: they play on, bit for bit, with their
// draws, beats and state.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "behavior_stage.h"

namespace limber {
namespace {

constexpr double kUndoQuick = 5 * kBudgetScale;

SceneOptions undo_quick() {
  SceneOptions options;
  options.limits.call_ms = kUndoQuick;
  options.limits.memory = std::size_t{16} << 20u;
  return options;
}

// a behaviour that draws, keeps a beat and remembers; a group that looks at its neighbours
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

struct Left {
  std::uint64_t hash = 0;
  std::vector<std::string> printed, order;
  bool operator==(const Left&) const = default;
};

// the scene with more in it, and a behaviour "guest" of the body a with this step
Left play(const std::string& more, const std::string& guest, std::size_t faults) {
  Stage stage(undo_quick());
  std::size_t said = 0;
  stage.world.behaviors().on_fault([&](const Behavior&) { said++; });
  stage.write("behaviors_lua/drawing.lua", kDrawing);
  stage.write("behaviors_lua/near.lua", kNear);
  stage.write("behaviors_lua/guest.lua", "return behavior { step = function(self)\n" + guest + "\nend }");
  EXPECT_EQ(stage.play(kUndoScene + std::string("a:add_behavior('guest', 'guest')\n") + more, 40), "");
  EXPECT_EQ(stage.host.faults.size() + said, faults) << more << guest;
  Left left{stage.scene.state_hash(stage.world.state_hash()), stage.host.printed, stage.world.behaviors().order()};
  stage.world.behaviors().on_fault({});
  return left;
}

const char* const kEnds[] = {"error('x')", "while true do end", "local t = {} for i = 1, 1e9 do t[i] = { i } end"};

const char* const kDeeds[] = {
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

TEST(BehaviorsUndone, ACallbackThatFailsHasRemovedNothing) {
  const Left alone = play("", "", 0);
  EXPECT_EQ(alone.printed.size(), 34u) << "40 ticks of 1/60 s have 17 beats of 40 ms";
  for (const char* deed : kDeeds) {
    for (const char* end : kEnds) {
      EXPECT_EQ(play(fmt::format("sim:at(0.2, function() {} {} end)", deed, end), "", 1), alone) << deed << " " << end;
    }
    EXPECT_NE(play(fmt::format("sim:at(0.2, function() {} end)", deed), "", 0), alone) << deed;
  }
  // what it made, and what found it, is forgotten
  EXPECT_EQ(play("sim:at(0.2, function() a:add_part('more', shape) local n = #a:behavior('drawing').parts "
                 "if n == 2 then error('x') end end)",
                 "", 1),
            alone);
  // nor has one that made them first
  EXPECT_EQ(play("sim:at(0.2, function() a:copy('c'):behavior('drawing'):remove() a:behavior('wind'):remove() "
                 "a:add_behavior('force', 'wind'):remove() error('x') end)",
                 "", 1),
            alone);
}

TEST(BehaviorsUndone, ABehaviourThatFailsHasRemovedNothing) {
  // one that does nothing but fail is the measure: suspended, it is part of the hash
  const Left suspended = play("", "if sim.tick == 12 then error('x') end", 1);
  for (const char* deed : kDeeds) {
    for (const char* end : kEnds) {
      EXPECT_EQ(play("", fmt::format("if sim.tick == 12 then {} {} end", deed, end), 1), suspended)
          << deed << " " << end;
    }
  }
  EXPECT_EQ(play("", "if sim.tick == 12 then self.rng:uniform() math.random() error('x') end", 1), suspended);
  // without a fault they go, itself too
  EXPECT_NE(play("", fmt::format("if sim.tick == 12 then {} end", kDeeds[3]), 0), suspended);
}

TEST(BehaviorsUndone, ABeatThatFailedComesAgain) {
  BehaviorStage stage;
  ASSERT_EQ(stage.play_one("return behavior { params = { { 'pause', 1000 }, { 'bad', true } },\n"
                           "step = function(self) if self:due('pause') then\n"
                           "  if self.bad then error('x') end print('beat') end end }",
                           3),
            "");
  ASSERT_NE(stage.it().error(), "");
  stage.set("bad", 0);
  stage.set("active", 1);
  stage.tick(3);
  EXPECT_EQ(stage.host.printed, (std::vector<std::string>{"beat"}));
}

TEST(BehaviorsUndone, AnErrorStaysWhenTheOneWhoWantedToMendItFails) {
  BehaviorStage stage;
  stage.write("behaviors_lua/test.lua", "return behavior { step = function() error('ill') end }");
  ASSERT_EQ(stage.play(std::string(kBall) + R"(
ball:add_behavior('test', 'it')
sim:at(0.1, function() ball:behavior('it').active = true error('x') end)
)",
                       10),
            "");
  EXPECT_EQ(first_line(stage.it().error()), "behaviors_lua/test.lua:1: ill");
}

}  // namespace
}  // namespace limber

// Hostile behaviors: only the failing behavior is suspended, its changes are rolled back, and its neighbors move as if
// it had been switched off in that tick.
#include <gtest/gtest.h>

#include <string_view>

#include "behavior_stage.h"

namespace limber::script {
namespace {

constexpr std::string_view kTimeLimit = " ms of computing; check for an infinite loop";

struct HostileCase {
  const char* name;
  const char* step;                // runs at tick 30; before, it pushes its own body
  std::string_view expected_text;  // part of the error text
  int line = 4;
};

std::ostream& operator<<(std::ostream& out, const HostileCase& hostile) { return out << hostile.name; }

// Some releases of LuaJIT call no message handler when the stack of compiled code overflows. Then the place is the
// start of the called function.
constexpr int kAnyLine = 0;

constexpr HostileCase kHostile[] = {
    {"Errs", "local x = nil + 1", "attempt to perform arithmetic on a nil value"},
    {"ThrowsATable", "error({})", "an error that is not text but a table"},
    {"LoopsForEver", "while true do end", kTimeLimit},
    {"LoopsOverParts", "while true do for _, part in ipairs(self.parts) do part:apply_force(vec3(1, 0, 0)) end end",
     kTimeLimit},
    {"CatchesItsStop", "pcall(function() while true do end end) while true do pcall(error) end", kTimeLimit},
    {"EatsMemory", "local t = {} while true do t[#t + 1] = ('x'):rep(1000) .. #t end", "stopped"},
    {"RecursesForEver", "local function f() return 1 + f() end f()", "stack overflow", kAnyLine},
    {"WritesOthers",
     "local other = sim:body('healthy') other.position = vec3(9, 9, 9) other.root.mass = 50 "
     "other.root:apply_force(vec3(100, 0, 0)) other.root:apply_impulse(vec3(5, 0, 0)) "
     "other:behavior('it').max_amp = 7 sim.gravity = vec3(0, 0, 5) error('done')",
     "done"},
    {"KicksTheOneBefore", "sim:body('before').root:apply_impulse(vec3(5, 0, 0)) error('done')", "done"},
    {"ResetsOthers", "sim:body('healthy'):reset() sim:reset() error('done')", "done"},
    {"RemovesOthers", "sim:body('healthy'):remove() error('done')", "done"},
    {"RemovesOthersBehaviors", "sim:body('healthy'):behavior('it'):remove() error('done')", "done"},
    {"RemovesItsGroup", "sim:group_behavior('bad'):remove() error('done')", "done"},
    {"RemovesAllThatItCan",
     "for _, body in ipairs(sim.bodies) do for _, b in ipairs(body.behaviors) do b:remove() end body:remove() end "
     "error('done')",
     "done"},
    {"RemovesItself", "self.body:behavior(self.name):remove() error('done')", "done"},
    {"RemovesItsBody", "self.body:remove() error('done')", "done"},
    {"SwitchesItselfOff", "self.active = false error('done')", "done"},
    {"WritesNaN", "self.parts[1]:apply_force(vec3(0 / 0, 0, 0))", "takes finite numbers, not nan"},
    {"MakesThings", "sim:add_body('more')", "creates or registers something"},
    {"SpoilsLists", "local _, list = ipairs(self.parts) list[1] = 3", "is read-only"},
    {"SpoilsNeighbors", "local f, walk = self:neighbors(self.parts[1], 5) walk.at = 7", "has no member named"},
    {"ReusesAnIterator",
     "local f, walk = self:neighbors(self.parts[1], 5) for i = 1, 100 do f(walk) end "
     "for i = 1, 17 do self:neighbors(self.parts[1], 5) end f(walk)",
     "nested more than 16 deep"},
    {"SpoilsItsSelf", "self.slot_ = 3", "this member is read-only"},
    {"ForgesASelf", "self.due({ slot_ = 1e9, generation_ = 1 }, 'push')", "due is a method of a behavior"},
    {"DrawsFromItsFile", "for i = 1, 5 do math.random() end error('done')", "done"},
    {"AsksForTooManyDraws", "while true do self.rng:uniform() end", kTimeLimit},
};

// Only endless loops reach the time limit, also on a slow machine.
SceneOptions limits_of(const HostileCase& hostile) {
  SceneOptions options;
  options.limits.call_ms = hostile.expected_text == kTimeLimit ? 4 * kBudgetScale : 10000;
  options.limits.memory = std::size_t{24} << 20u;
  return options;
}

// A group on three bodies, the middle one hostile, next to a healthy body that is moved by a built-in behavior.
std::string scene() {
  return R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for i, name in ipairs { "healthy", "before", "bad", "behind" } do
  sim:add_body(name):add_part("ball", ball, { position = vec3(2 * i, 0, 1) })
end
sim.gravity = vec3()
sim:body("healthy"):add_behavior("random_force", "it", { rand_interval = 50 })
sim:add_group_behavior("test", "bad", { bodies = { "before", "bad", "behind" } })
for _, name in ipairs { "before", "behind" } do sim:body(name):behavior("bad").hostile = false end
)";
}

std::string file(const HostileCase& hostile) {
  return "return behavior { group = true, params = { { 'push', 1, unit = 'ms' }, { 'hostile', true } }, step = "
         "function(self)\n"
         "if self.hostile and sim.tick >= 30 then\n"
         "  self.parts[1]:apply_force(vec3(7, 0, 0))\n" +
         std::string(hostile.step) +
         "\nend\n"
         "self.parts[1]:apply_force(self.rng:direction() * (1 + math.random()))\n"
         "end }";
}

std::uint64_t hash_of(const ScriptFixture& fixture, const char* body) {
  return sim::body_hash(*fixture.world.find_body(body), hash_bytes("test"));
}

class HostileBehaviors : public ::testing::TestWithParam<HostileCase> {};

TEST_P(HostileBehaviors, AreSuspendedAloneAndLeaveNoTrace) {
  const HostileCase& hostile = GetParam();
  const SceneOptions options = limits_of(hostile);
  std::vector<std::uint64_t> hashes;
  for (const bool acts : {true, false}) {
    BehaviorFixture fixture(options, true);
    fixture.write("behaviors_lua/test.lua", file(hostile));
    ASSERT_EQ(fixture.play(scene(), 30), "");
    sim::Behavior& bad = *fixture.world.find_body("bad")->behaviors().find("bad");
    EXPECT_EQ(bad.error(), "");
    if (!acts) {
      const double off = 0;
      ASSERT_TRUE(fixture.store.set(bad.id(), "active", {&off, 1}).ok());
    }
    fixture.tick(30);
    if (acts) {
      EXPECT_NE(bad.error().find(hostile.expected_text), std::string::npos) << bad.error();
      EXPECT_EQ(bad.fault().file, "behaviors_lua/test.lua");
      EXPECT_GT(bad.fault().line, 0);
      if (hostile.line != kAnyLine) {
        EXPECT_EQ(bad.fault().line, hostile.line);
      }
      EXPECT_TRUE(bad.active());
      EXPECT_EQ(fixture.host.resets, 0);
    }
    for (const char* other : {"before", "behind"}) {
      EXPECT_EQ(fixture.world.find_body(other)->behaviors().find("bad")->error(), "");
    }
    hashes.push_back(hash_of(fixture, "healthy"));
    hashes.push_back(hash_bytes("before", hash_of(fixture, "before") ^ hash_of(fixture, "behind")));
    const auto& words = bad.random().state();
    hashes.push_back(hash_bytes({reinterpret_cast<const char*>(words.data()), sizeof words}));
    const sim::Part& part = *fixture.world.find_body("bad")->root();
    hashes.push_back(hash_bytes({reinterpret_cast<const char*>(fixture.store.transient_block(part.id())),
                                 sim::Part::table().transient_width() * sizeof(double)}));
  }
  EXPECT_EQ(hashes[0], hashes[4]) << "the healthy body";
  EXPECT_EQ(hashes[1], hashes[5]) << "the other members";
  EXPECT_EQ(hashes[2], hashes[6]) << "its own draws";
  EXPECT_EQ(hashes[3], hashes[7]) << "its own part";
}

INSTANTIATE_TEST_SUITE_P(, HostileBehaviors, ::testing::ValuesIn(kHostile),
                         [](const auto& info) { return std::string(info.param.name); });

// its file is edited and loaded by a detached scene
void fix_file(BehaviorFixture& fixture, ScriptHost& host, std::unique_ptr<Scene>& detached_scene,
              const std::string& text) {
  fixture.write("behaviors_lua/test.lua", text);
  fixture.write("scripts/next.lua", "sim:add_group_behavior('test', 'next', { bodies = 'none*' })");
  detached_scene = std::make_unique<Scene>(fixture.world, host, SceneOptions{});
  const Result<void> result = detached_scene->run((fixture.folder / "scripts" / "next.lua").string());
  ASSERT_TRUE(result.ok()) << result.error();
  fixture.world.behaviors().remove(*fixture.world.behaviors().find_group("next"));
  fixture.world.behaviors().replace_instances("test");
}

TEST_P(HostileBehaviors, ContinueAfterTheFileIsFixed) {
  const HostileCase& hostile = GetParam();
  const SceneOptions options = limits_of(hostile);
  BehaviorFixture fixture(options, true);
  fixture.write("behaviors_lua/test.lua", file(hostile));
  ASSERT_EQ(fixture.play(scene(), 32), "");
  const auto bad = [&]() -> const sim::Behavior& { return *fixture.world.find_body("bad")->behaviors().find("bad"); };
  ASSERT_NE(bad().error(), "");
  RecordingHost host;
  std::unique_ptr<Scene> detached_scene;
  fix_file(fixture, host, detached_scene,
           "return behavior { group = true, params = { { 'push', 1, unit = 'ms' }, { 'hostile', true } },\n"
           "step = function(self) if self.hostile then print(self.body.name) end end }");
  fixture.tick(2);
  EXPECT_EQ(bad().error(), "");
  EXPECT_EQ(host.printed, (std::vector<std::string>{"bad", "bad"}));
}

TEST(HostileBehaviorsInMigrate, AreSuspendedAloneAndRetainTheirState) {
  SceneOptions options;
  options.limits.call_ms = 4 * kBudgetScale;
  const std::string good =
      "return behavior { group = true, params = { { 'push', 1, unit = 'ms' }, { 'hostile', true } },\n"
      "start = function(self) self.state.n = 0 end,\n"
      "step = function(self) self.state.n = self.state.n + 1 if self.hostile then print(self.state.n) end end,\n";
  for (const std::string migrate :
       {"while true do end", "error('no')", "local t = {} while true do t[#t + 1] = #t .. '' end"}) {
    SCOPED_TRACE(migrate);
    BehaviorFixture fixture(options, true);
    fixture.write("behaviors_lua/test.lua", good + "}");
    ASSERT_EQ(fixture.play(scene(), 3), "");
    RecordingHost host, later_host;
    std::unique_ptr<Scene> detached_scene, later_scene;
    fix_file(fixture, host, detached_scene,
             good + "migrate = function(self, old)\n  if self.hostile then " + migrate + " end\nreturn old end }");
    fixture.tick(2);
    const sim::Behavior* bad = fixture.world.find_body("bad")->behaviors().find("bad");
    EXPECT_EQ(bad->fault().line, 5) << bad->error();
    EXPECT_EQ(bad->fault().file, "behaviors_lua/test.lua");
    EXPECT_EQ(fixture.world.find_body("behind")->behaviors().find("bad")->error(), "");
    EXPECT_EQ(host.printed, std::vector<std::string>{});
    fix_file(fixture, later_host, later_scene, good + "}");
    fixture.tick();
    EXPECT_EQ(later_host.printed, std::vector<std::string>{"4"}) << "continues with its previous state";
  }
}

TEST(HostileBehaviorsInStart, AreSuspendedAloneToo) {
  SceneOptions options;
  options.limits.call_ms = 4 * kBudgetScale;
  BehaviorFixture fixture(options);
  fixture.write("behaviors_lua/test.lua",
                "return behavior { start = function(self)\n"
                "  self.parts[1]:apply_force(vec3(0, 50, 0))\n"
                "  while true do end\n"
                "end, step = function() print('step') end }");
  fixture.write("behaviors_lua/good.lua",
                "return behavior { step = function(self) self.parts[1]:apply_force(vec3(1, 0, 0)) end }");
  ASSERT_EQ(fixture.play(std::string(kBall) + "ball:add_behavior('test', 'it') ball:add_behavior('good', 'good')", 5),
            "");
  EXPECT_EQ(fixture.it().fault().line, 3);
  EXPECT_TRUE(fixture.host.printed.empty());
  const Vec3 velocity = fixture.world.find_body("ball")->root()->linear_velocity();
  EXPECT_NEAR(velocity.x, 5.0 / 60 / 2, 1e-6);
  EXPECT_EQ(velocity.y, 0);
}

TEST(HostileBehaviorsAtLoad, RejectTheScene) {
  SceneOptions options;
  options.limits.run_ms = 30 * kBudgetScale;
  BehaviorFixture fixture(options);
  const std::string fault = fixture.play_one("while true do end");
  EXPECT_EQ(fault.find("behaviors_lua/test.lua:1: stopped after 0."), 0u) << fault;
}

}  // namespace
}  // namespace limber::script

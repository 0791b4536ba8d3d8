// A behavior's state as text, passed from one Lua state to another.
#include <gtest/gtest.h>

#include "behavior_stage.h"

namespace limber::script {
namespace {

// the state, as text or the error, of a behavior with this text as its start
std::string state_of(const std::string& start) {
  BehaviorFixture fixture;
  EXPECT_EQ(fixture.play_one("return behavior { start = function(self) local s = self.state " + start +
                                 " end, step = function() end }",
                             1),
            "");
  EXPECT_EQ(fixture.it().error(), "");
  const Result<std::string> state = static_cast<LuaBehavior&>(fixture.it()).state();
  return state ? *state : state.error();
}

constexpr const char* kOnly = "; state can have numbers, text, true and false, vec3, quat, timers, and tables of them";

TEST(PlainData, OtherValuesAreReportedWithTheirKey) {
  EXPECT_EQ(state_of("s.f = print"), std::string("state.f is a function") + kOnly);
  EXPECT_EQ(state_of("s.list = { 1, { part = self.parts[1] } }"),
            std::string("state.list[2].part is part 'ball/ball'") + kOnly);
  EXPECT_EQ(state_of("s['two words'] = { [0.5] = coroutine.create(print) }"),
            std::string("state['two words'][0.5] is a thread") + kOnly);
  EXPECT_EQ(state_of("s.t = { [print] = 1 }"), std::string("state.t has a key that is a function") + kOnly);
  EXPECT_EQ(state_of("s.me = s"), std::string("state.me is a table that contains itself") + kOnly);
  EXPECT_EQ(state_of("s.object = setmetatable({}, {})"),
            std::string("state.object is a table with a metatable") + kOnly);
  EXPECT_EQ(state_of("for i = 1, 120 do s.t = {} s = s.t end").substr(0, 7), "state.t");
}

TEST(PlainData, SurvivesARoundTrip) {
  // a second scene on the same world reloads the type: its instance has the state of the first
  BehaviorFixture first;
  const std::string file =
      "return behavior { start = function(self)\n"
      "  local s = self.state\n"
      "  s.numbers = { 1, -0.1, 1e300, 2^53 + 2, 1/0, -1/0, [0.5] = 7, [-3] = 8 }\n"
      "  s.texts = { 'a\\0b', '', '12;', ('x'):rep(1000), [true] = 'yes', [false] = 'no' }\n"
      "  s.v, s.q, s.nan = vec3(1, 2, 3.5), quat(0, 0, 0.6, 0.8), 0/0\n"
      "  s.deep = { { { {} } } }\n"
      "end, step = function(self)\n"
      "  local s = self.state\n"
      "  local n, t = s.numbers, s.texts\n"
      "  print(#n, n[1], n[2] == -0.1, n[3] == 1e300, n[4] == 2^53 + 2, n[5], n[6], n[0.5], n[-3])\n"
      "  print(#t, t[1] == 'a\\0b', t[2] == '', t[3], #t[4], t[true], t[false], s.v, s.q, s.nan, #s.deep[1][1][1])\n"
      "end }";
  ASSERT_EQ(first.play_one(file, 1), "");
  const std::vector<std::string> before = first.host.printed;
  RecordingHost host;
  Scene second(first.world, host, {});
  first.write("scripts/second.lua", "sim:add_body('x'):add_behavior('test', 'it')");
  ASSERT_TRUE(second.run((first.folder / "scripts" / "second.lua").string()).ok());
  first.world.behaviors().replace_instances("test");
  first.tick();
  EXPECT_EQ(host.printed.front(), before[0]);
  EXPECT_EQ(host.printed.at(1), before[1]);
}

}  // namespace
}  // namespace limber::script

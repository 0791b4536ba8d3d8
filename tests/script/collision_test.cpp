// Excluded pairs and collision groups in scripts.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "stage.h"

namespace limber::script {
namespace {

constexpr const char* kPair = R"(
sim.collision_groups = { "robot", "floor", "ghost" }
local ball = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("body")
local a = body:add_part("a", ball)
local b = body:add_part("b", ball, { position = { 0, 0, 0.19 } })
local c = body:add_part("c", ball, { position = { 0, 0, 2 } })
local function pairs_of(x)
  local out = {}
  for _, p in ipairs(x.excluded_pairs) do out[#out + 1] = p[1].name .. p[2].name end
  return table.concat(out, " ")
end
)";

std::string pair_value(const std::string& expression) { return value_of(expression, kPair); }
std::string pair_failure(const std::string& text) { return error_of(std::string(kPair) + "\n" + text); }

TEST(ExcludedPairs, AreListedAndEdited) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kPair) + R"(
body:exclude_pair("b", c)
print("top", pairs_of(body))
sim:after(0.05, function()
  print("first", pairs_of(body), body.excluded_pairs[1][1] == a)
  body:include_pair(a, "b")
  print("included", pairs_of(body))
  print("copy", pairs_of(body:copy("copy", { position = vec3(5, 0, 0) })))
end)
sim:after(0.1, function()
  body:exclude_pair("c", "a")
  error("stop")
end)
sim:after(0.15, function() print("undone", pairs_of(body)) end)
)",
                         12),
            "");
  EXPECT_EQ(fixture.host.printed,
            (std::vector<std::string>{"top\tbc", "first\tab bc\ttrue", "included\tbc", "copy\tbc", "undone\tbc"}));
}

TEST(ExcludedPairs, WrongPartsAreErrors) {
  EXPECT_NE(pair_failure("body:exclude_pair(a, a)").find("two different parts"), std::string::npos);
  EXPECT_NE(pair_failure("body:exclude_pair(a, 'd')").find("no part 'd'"), std::string::npos);
  EXPECT_NE(pair_failure("body.excluded_pairs = {}").find("can be read, not set"), std::string::npos);
}

TEST(ExcludedPairs, IncludingAJointedPairIsReported) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run(std::string(kPair) + "body:add_joint('j', a, b)\nbody:include_pair(a, b)"), "");
  const std::vector<std::string> logged = fixture.logged();
  ASSERT_FALSE(logged.empty());
  EXPECT_NE(logged.back().find("no effect while joint 'j' connects the two"), std::string::npos);
}

TEST(CollisionGroups, TakeNamesAndNumbers) {
  EXPECT_EQ(pair_value("a.collision_group, a.collision_mask, table.concat(sim.collision_groups, ' ')"),
            "1\t65535\trobot floor ghost");
  const auto after = [](const std::string& line) {
    return value_of("a.collision_group, a.collision_mask", std::string(kPair) + line + "\n");
  };
  EXPECT_EQ(after("a.collision_group, a.collision_mask = 'floor', { 'robot', 'ghost' }"), "2\t5");
  EXPECT_EQ(after("a.collision_group, a.collision_mask = 256, {}"), "256\t0");
  EXPECT_EQ(value_of("body:add_part('d', ball, { collision_group = 'ghost' }).collision_group", kPair), "4");
}

TEST(CollisionGroups, WrongNamesAreErrors) {
  EXPECT_NE(pair_failure("a.collision_group = 'flor'").find("has no 'flor'; did you mean 'floor'?"), std::string::npos);
  EXPECT_NE(pair_failure("a.collision_mask = true").find("takes a number, a name of sim.collision_groups"),
            std::string::npos);
  EXPECT_NE(pair_failure("sim.collision_groups = { 'a', 'a' }").find("duplicate name 'a'"), std::string::npos);
  std::string many = "sim.collision_groups = { ";
  for (int i = 0; i < 17; i++) many += "'g" + std::to_string(i) + "', ";
  EXPECT_NE(pair_failure(many + "}").find("at most 16 names"), std::string::npos);
  EXPECT_NE(error_of("sim:add_body('b'):add_part('p', sim:add_sphere_shape('s', 1)).collision_group = 'x'")
                .find("name the groups first"),
            std::string::npos);
}

TEST(SelfCollide, IsAPropertyOfALoadedBody) {
  ScriptFixture fixture;
  fixture.write("urdf/two.urdf", R"(<robot name="two"><link name="a"/>
<link name="b"><visual><geometry><sphere radius="1"/></geometry></visual></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<gazebo reference="b"><selfCollide>false</selfCollide></gazebo></robot>)");
  ASSERT_EQ(fixture.run("local two = sim:load_urdf('urdf/two.urdf')\n"
                        "print(two:part('a').self_collision, two:part('b').self_collision)"),
            "");
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"true\tfalse"}));
}

}  // namespace
}  // namespace limber::script

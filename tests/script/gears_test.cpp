// sim:add_gear and URDF mimic joints in scripts: names, lists, properties, errors, motors of followers.
#include <gtest/gtest.h>

#include "stage.h"

namespace limber::script {
namespace {

constexpr const char* kGearTrain = R"(
sim.gravity = vec3()
local arm = sim:add_box_shape("arm", vec3(0.05, 0.4, 0.05))
local function train(name)
  local body = sim:add_body(name)
  body:add_part("frame", sim:add_box_shape(name, vec3(1, 0.05, 0.05)), { mass = 0 })
  for i, x in ipairs { -0.4, 0.4 } do
    body:add_part("arm" .. i, arm, { position = vec3(x, 0, 0.1) })
    body:add_motor(body:add_joint("j" .. i, "frame", "arm" .. i, { axis = vec3(0, 0, 1) }), { mode = "off" })
  end
  body.position = vec3(#sim.bodies * 3, 0, 0)
  return body
end
local left, right = train("left"), train("right")
)";

std::string gear_value(const std::string& lines, const std::string& expression) {
  ScriptFixture fixture;
  const std::string fault = fixture.run(kGearTrain + lines + "\nprint(" + expression + ")");
  return fault.empty() ? fixture.host.printed.back() : first_line(fault);
}

TEST(Gears, AreNamedByTheirJointsByDefault) {
  EXPECT_EQ(gear_value("local g = sim:add_gear(left:joint('j1'), left:joint('j2'), 2)\n"
                       "local h = sim:add_gear(right:joint('j1'), right:joint('j2'), 2)\n"
                       "local k = sim:add_gear(left:joint('j1'), right:joint('j1'), 1, { name = 'bridge' })",
                       "g, h, k, #sim.gears, sim.gears[1] == g, sim:gear('bridge') == k"),
            "gear 'j1_j2'\tgear 'j1_j2_2'\tgear 'bridge'\t3\ttrue\ttrue");
}

TEST(Gears, HaveJointsAndProperties) {
  EXPECT_EQ(
      gear_value("local g = sim:add_gear(left:joint('j1'), right:joint('j2'), -3, { offset = 0.5, max_force = 4 })",
                 "g.joint_a, g.joint_b, g.ratio, g.offset, g.max_force, g.enabled, g.alive"),
      "joint 'left/j1'\tjoint 'right/j2'\t-3\t0.5\t4\ttrue\ttrue");
}

TEST(Gears, RejectInvalidArguments) {
  const auto fault = [&](const std::string& call) { return gear_value(call, "''"); };
  EXPECT_NE(fault("sim:add_gear('j1', left:joint('j2'), 1)").find("add_gear: joint_a is a joint"), std::string::npos);
  EXPECT_NE(fault("sim:add_gear(left:joint('j1'), left:joint('j2'))").find("add_gear: the ratio"), std::string::npos);
  EXPECT_NE(fault("sim:add_gear(left:joint('j1'), left:joint('j2'), 0)").find("not 0"), std::string::npos);
  EXPECT_NE(fault("sim:add_gear(left:joint('j1'), left:joint('j1'), 1)").find("two different joints"),
            std::string::npos);
  EXPECT_NE(fault("sim:add_gear(left:joint('j1'), left:joint('j2'), 1, { ofset = 1 })").find("did you mean 'offset'"),
            std::string::npos);
  EXPECT_NE(fault("sim:gear('x')").find("there is no gear 'x'"), std::string::npos);
}

TEST(Gears, CoupleMoveAndAreRemoved) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kGearTrain) + R"(
local g = sim:add_gear(left:joint("j1"), right:joint("j2"), -2)
left:motor("j1").mode = "servo"
left:motor("j1").target = 0.3
sim:at(1, function()
  print(string.format("%.3f %.3f", left:joint("j1").value, right:joint("j2").value))
  g:remove()
  print(g.alive, #sim.gears)
end)
)",
                         70),
            "");
  ASSERT_EQ(fixture.host.printed.size(), 2u);
  EXPECT_EQ(fixture.host.printed[0], "0.300 -0.600");
  EXPECT_EQ(fixture.host.printed[1], "false\t0");
}

TEST(Gears, AreRestoredAfterAFailedCallback) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kGearTrain) + R"(
local g = sim:add_gear(left:joint("j1"), right:joint("j2"), -2)
sim:at(0.1, function()
  g.ratio = 5
  sim:add_gear(left:joint("j2"), right:joint("j1"), 1)
  g:remove()
  error("no")
end)
sim:at(0.2, function() print(g.alive, g.ratio, #sim.gears) end)
)",
                         20),
            "");
  EXPECT_EQ(fixture.host.printed.back(), "true\t-2\t1");
}

TEST(MimicGear, AFollowerHasNoServoAndEffortsAddUp) {
  ScriptFixture fixture;
  fixture.write("urdf/jaw.urdf", R"(<?xml version="1.0"?>
<robot name="jaw">
  <link name="post"/>
  <link name="jaw"><inertial><mass value="0.3"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
  <link name="jaw2"><inertial><mass value="0.3"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial></link>
  <joint name="lead" type="revolute"><origin xyz="0 0.1 1"/><parent link="post"/><child link="jaw"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="2" velocity="5"/></joint>
  <joint name="follow" type="revolute"><origin xyz="0 -0.1 1"/><parent link="post"/><child link="jaw2"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="2" velocity="5"/><mimic joint="lead" multiplier="-1"/></joint>
</robot>)");
  ASSERT_EQ(fixture.play(R"(
sim.gravity = vec3()
local jaw = sim:load_urdf("urdf/jaw.urdf")
print(jaw:motor("lead").mode, jaw:motor("follow").mode)
local a, b = jaw:part("jaw"), jaw:part("jaw2")
local load = 0.9
sim:on_step(function()
  a:apply_torque(vec3(0, 0, load))
  b:apply_torque(vec3(0, 0, -load))
end)
sim:at(0.5, function() print(math.abs(jaw:joint("lead").value) < 0.01) load = 1.5 end)
sim:at(1, function()
  print(math.abs(jaw:joint("lead").value) < 0.01, math.abs(jaw:joint("lead").value + jaw:joint("follow").value) < 1e-4)
  jaw:motor("follow").mode = "servo"
end)
sim:at(2, function() print(math.abs(jaw:joint("lead").value) < 0.01) end)
)",
                         130),
            "");
  ASSERT_EQ(fixture.host.printed.size(), 4u);
  EXPECT_EQ(fixture.host.printed[0], "servo\toff");
  EXPECT_EQ(fixture.host.printed[1], "true");         // 1.8 N·m of the leader's 2
  EXPECT_EQ(fixture.host.printed[2], "false\ttrue");  // 3 N·m is too much
  EXPECT_EQ(fixture.host.printed[3], "true");         // but not for both motors
}

}  // namespace
}  // namespace limber::script

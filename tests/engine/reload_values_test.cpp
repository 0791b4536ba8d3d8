// The rule for values in a reload: changed values are applied, values set as before keep their overrides, values that
// are no longer set return to their default.
#include "engine/edited.h"
#include "sim/bullet/bullet.h"

namespace limber::engine::test {
namespace {

constexpr const char* kArm = R"(
--WORLD
local ball = sim:add_sphere_shape("ball", 0.05)
local arm = sim:add_body("arm")
arm:add_part("base", ball, { mass = 0, position = vec3(0, 0, 1) })
local tip = arm:add_part("tip", ball, { mass = 0.5, position = vec3(0, 0, 1.5) })
local elbow = arm:add_joint("elbow", "base", "tip", { position = vec3(0, 0, 1), axis = vec3(0, 1, 0) })
local motor = arm:add_motor("elbow")
--LINE
)";

std::string arm_with(const std::string& line) {
  std::string text = kArm;
  return text.replace(text.find("--LINE"), 6, line);
}

struct ValueCase {
  const char* name;
  const char* before;
  const char* after;
  double value;
};

TEST(ReloadValues, TheRuleHoldsForAnyOrderOfWrites) {
  // friction is 0.5 by default; a controller sets 0.9 between the two runs
  constexpr ValueCase kCases[] = {
      {"set to another value", "tip.friction = 0.2", "tip.friction = 0.3", 0.3},
      {"set as before", "tip.friction = 0.2", "tip.friction = 0.2", 0.9},
      {"set as before, by other code", "tip.friction = 0.2", "for _, p in ipairs { tip } do p.friction = 1 / 5 end",
       0.9},
      {"only the last assignment counts", "tip.friction = 0.2", "tip.friction = 0.7 tip.friction = 0.2", 0.9},
      {"never set", "", "-- a comment", 0.9},
      {"no longer set", "tip.friction = 0.2", "", 0.5},
      {"no longer set, was the default", "tip.friction = 0.5", "", 0.5},
      {"set for the first time", "", "tip.friction = 0.3", 0.3},
      {"set for the first time, to the default", "", "tip.friction = 0.5", 0.5},
      {"another property is set", "tip.friction = 0.2", "tip.friction = 0.2 tip.restitution = 0.1", 0.9},
  };
  for (const ValueCase& c : kCases) {
    EditedShow edited(arm_with(c.before));
    edited.show().send("/physics/part/friction", "arm", "tip", 0.9);
    edited.show().ticks(2);
    EXPECT_EQ(edited.save(arm_with(c.after)), SceneReloader::ApplyResult::applied) << c.name;
    EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), c.value) << c.name;
    edited.show().ticks(1);
    EXPECT_FLOAT_EQ(edited.part("arm", "tip").rigid().getFriction(), static_cast<float>(c.value)) << c.name;
  }
}

TEST(ReloadValues, ArgumentsOfConstructorsAreExplicitlySet) {
  EditedShow edited(arm_with(""));
  edited.show().send("/physics/part/mass", "arm", "tip", 2);
  edited.show().ticks(1);
  edited.edit("--WORLD", "-- a word");
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/mass"), 2);
  edited.edit("mass = 0.5", "mass = 0.6");
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/mass"), 0.6);
  edited.show().send("/physics/part/mass", "arm", "tip", 2);
  edited.show().ticks(1);
  edited.edit("mass = 0.6, ", "");
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/mass"), 1);
}

TEST(ReloadValues, ComputedPropertiesSetTheirStoredOnes) {
  EditedShow edited(arm_with("motor.target = 0.4 motor.speed = 2"));
  edited.show().send("/physics/motor/target", "arm", "elbow", -0.2);
  edited.show().ticks(1);
  edited.save(arm_with("motor.speed = 3 motor.target = 0.4"));
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/target"), -0.2);
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/angular_velocity", 2), 3);
  edited.save(arm_with("motor.speed = 3 motor.target = 0.5 motor.mode = 'spring'"));
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/angular_servo_position", 2), 0.5);
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/angular_spring_rest_length", 2), 0.5);
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/angular_spring_active", 2), 1);
  edited.save(arm_with("motor.speed = 3 motor.target = 0.5"));
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/angular_spring_active", 2), 0);
  EXPECT_EQ(edited.show().read("/physics/body/arm/motor/elbow/angular_servo_active", 2), 1);
}

TEST(ReloadValues, WorldPropertiesFollowTheRuleToo) {
  EditedShow edited(arm_with(""));
  const auto gravity = [&] { return edited.show().read("/physics/sim/gravity", 2); };
  edited.edit("--WORLD", "sim.gravity = vec3(0, 0, -5) sim.substeps = 8");
  EXPECT_EQ(gravity(), -5);
  EXPECT_EQ(edited.show().read("/physics/sim/substeps"), 8);
  edited.show().send("/physics/sim/gravity", 0, 0, -1);
  edited.show().ticks(1);
  edited.edit("sim.substeps = 8", "sim.substeps = 6");
  EXPECT_EQ(gravity(), -1);
  EXPECT_EQ(edited.show().read("/physics/sim/substeps"), 6);
  edited.edit("sim.gravity = vec3(0, 0, -5)", "");
  EXPECT_EQ(gravity(), -9.81);
}

TEST(ReloadValues, ValuesSetByCallbacksStay) {
  EditedShow edited(arm_with("sim:on_step(function() tip.friction = 0.9 end)"));
  edited.show().ticks(1);
  edited.save(arm_with(""));
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.9);
  edited.save(arm_with("tip.friction = 0.3 sim:on_step(function() end)"));
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.3);
}

TEST(ReloadValues, TheTopLevelReadsTheValuesOfItsRun) {
  EditedShow edited(arm_with("tip.friction = 0.2 arm.root.friction = 2 * tip.friction"));
  edited.show().send("/physics/part/friction", "arm", 0.9);
  edited.show().ticks(1);
  edited.save(arm_with("tip.friction = 0.3 arm.root.friction = 2 * tip.friction"));
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/base/friction"), 0.6);
}

TEST(ReloadValues, ACopyHasTheValuesSetBeforeIt) {
  const std::string both = "tip.friction = 0.2 arm:copy('twin', { position = vec3(1, 0, 1) }) ";
  EditedShow edited(arm_with(both + "tip.friction = 0.3"));
  const auto twin = [&] { return edited.show().read("/physics/body/twin/part/tip/friction"); };
  EXPECT_EQ(twin(), 0.2);
  edited.show().send("/physics/part/friction", "twin", "tip", 0.9);
  edited.show().ticks(1);
  edited.save(arm_with(both + "tip.friction = 0.4"));
  EXPECT_EQ(twin(), 0.9) << "changes after the copy do not affect it";
  edited.save(arm_with("tip.friction = 0.25 arm:copy('twin', { position = vec3(1, 0, 1) })"));
  EXPECT_EQ(twin(), 0.25);
  edited.show().send("/physics/part/friction", "twin", "tip", 0.9);
  edited.show().ticks(1);
  edited.save(arm_with("arm:copy('twin', { position = vec3(1, 0, 1) })"));
  EXPECT_EQ(twin(), 0.5);
}

TEST(ReloadValues, AResetUsesTheCurrentFileAndOverrides) {
  EditedShow edited(arm_with("tip.friction = 0.2 tip.restitution = 0.1"));
  edited.show().send("/physics/part/friction", 0.9);  // of all parts
  edited.show().send("/physics/part/restitution", "arm", "tip", 0.8);
  edited.show().ticks(1);
  edited.save(arm_with("tip.friction = 0.3 tip.restitution = 0.1"));
  edited.show().send("/transport/reset");
  edited.show().ticks(2);
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.3) << "the editor acted last";
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/base/friction"), 0.9);
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/restitution"), 0.8);
  edited.show().send("/physics/part/friction", 0.7);
  edited.show().ticks(1);
  edited.show().send("/transport/reset");
  edited.show().ticks(2);
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.7) << "now the controller did";
  edited.save(arm_with("tip.friction = 0.3 tip.restitution = 0.2"));
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/friction"), 0.7) << "a reset is not an edit";
  EXPECT_EQ(edited.show().read("/physics/body/arm/part/tip/restitution"), 0.2);
}

}  // namespace
}  // namespace limber::engine::test

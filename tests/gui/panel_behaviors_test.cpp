// Behaviours: switched for all bodies or one, added, removed.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

const std::string kAll = "/physics/body/*/behavior/push";
const std::string kArm = "/physics/body/arm/behavior/push";
const std::string kLeg = "/physics/body/leg/behavior/push";

TEST(PanelBehaviors, OneSwitchForAllOfAName) {
  PanelRig rig;
  rig.click(kAll + "/active");
  EXPECT_EQ(rig.read(kArm + "/active"), 0);
  EXPECT_EQ(rig.read(kLeg + "/active"), 0);
  rig.click(kAll + "/active");
  EXPECT_EQ(rig.read(kArm + "/active"), 1);
  EXPECT_EQ(rig.read(kLeg + "/active"), 1);
}

TEST(PanelBehaviors, OfTheChosenBodyAlone) {
  PanelRig rig;
  rig.click("tree:/physics/body/arm");
  rig.click(kArm + "/active");
  EXPECT_EQ(rig.read(kArm + "/active"), 0);
  EXPECT_EQ(rig.read(kLeg + "/active"), 1);
}

TEST(PanelBehaviors, TheParametersOfANameSetAllThatHaveIt) {
  PanelRig rig;
  rig.click("behavior:" + kAll);
  rig.click(kAll + "/amp", 0, KeyMods{true, false, false});
  rig.key(GuiKey::a, {true, false, false});
  rig.type("3.5");
  rig.key(GuiKey::enter);
  EXPECT_EQ(rig.read(kArm + "/amp"), 3.5);
  EXPECT_EQ(rig.read(kLeg + "/amp"), 3.5);
}

TEST(PanelBehaviors, AddsAndRemoves) {
  PanelRig rig;
  rig.click("tree:/physics/body/arm");
  rig.click("behaviors.add");
  rig.click("behaviors.type");
  rig.click("behaviors.type=torque");
  rig.click("behaviors.name");
  rig.key(GuiKey::a, {true, false, false});
  rig.type("turn");
  rig.click("behaviors.add_it");
  rig.heard();
  EXPECT_EQ(rig.read("/physics/body/arm/behavior/turn/active"), 1);
  EXPECT_FALSE(find_place(rig.show.engine.store(), "/physics/body/leg/behavior/turn").ok());
  rig.click("remove:/physics/body/arm/behavior/turn");
  rig.heard();
  EXPECT_FALSE(find_place(rig.show.engine.store(), "/physics/body/arm/behavior/turn").ok());
  EXPECT_TRUE(find_place(rig.show.engine.store(), kArm).ok());
}

}  // namespace
}  // namespace limber::gui_test

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

// "spin" beside "push" on both, and a group that was made last
const std::string kThree = std::string(kScene) + R"(
for _, body in ipairs(sim.bodies) do body:add_behavior("torque", "spin", { parts = "tip" }) end
sim:add_group_behavior("cohesion", "flock", { parts = "tip" })
)";
const std::string kSpin = "/physics/body/*/behavior/spin";

// what hands did is done, and the list shows it: the panel goes on when it has heard of the step before
void settle(PanelRig& rig) {
  for (int i = 0; i < 3; i++) rig.heard();
}

TEST(PanelBehaviors, TheChosenOneActsEarlierOrLater) {
  PanelRig rig(kThree);
  const auto places = [&] {
    return std::vector<double>{
        rig.read(kArm + "/place"), rig.read(kLeg + "/place"), rig.read("/physics/body/arm/behavior/spin/place"),
        rig.read("/physics/body/leg/behavior/spin/place"), rig.read("/physics/group/flock/place")};
  };
  ASSERT_EQ(places(), (std::vector<double>{1, 1, 2, 2, 3}));
  rig.click("behavior:" + kSpin);
  EXPECT_GT(rig.where("behavior:" + kSpin).y, rig.where("behavior:" + kAll).y);
  rig.click("behaviors.earlier");
  settle(rig);
  EXPECT_EQ(places(), (std::vector<double>{2, 2, 1, 1, 3}));
  EXPECT_LT(rig.where("behavior:" + kSpin).y, rig.where("behavior:" + kAll).y) << "the list is in that order";
  rig.click("behaviors.earlier");
  settle(rig);
  EXPECT_EQ(places(), (std::vector<double>{2, 2, 1, 1, 3})) << "nothing is before it";
  rig.key(GuiKey::down, {true, false, false});
  rig.key(GuiKey::down, {true, false, false});  // two, as fast as one can
  settle(rig);
  EXPECT_EQ(places(), (std::vector<double>{1, 1, 3, 3, 2})) << "past the group, too";
  rig.click("behavior:/physics/group/flock");
  rig.click("behaviors.earlier");
  settle(rig);
  EXPECT_EQ(places(), (std::vector<double>{2, 2, 3, 3, 1}));
}

TEST(PanelBehaviors, OfTheChosenBodyAloneItIsPutElsewhere) {
  PanelRig rig(kThree);
  rig.click("tree:/physics/body/arm");
  rig.click("behavior:" + kArm);
  // what is chosen now is the behaviour: the list is of all bodies again, or still of its own
  rig.key(GuiKey::down, {true, false, false});
  settle(rig);
  EXPECT_EQ(rig.read(kArm + "/place"), 2);
  EXPECT_EQ(rig.read(kLeg + "/place"), 1);
}

}  // namespace
}  // namespace limber::gui_test

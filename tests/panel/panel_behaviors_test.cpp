// Behaviors: activated for all bodies or one, reordered, added, removed.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

const std::string kAll = "/physics/body/*/behavior/push";
const std::string kArm = "/physics/body/arm/behavior/push";
const std::string kLeg = "/physics/body/leg/behavior/push";

TEST(PanelBehaviors, CheckboxSetsAllBodies) {
  PanelFixture fixture;
  fixture.click(kAll + "/active");
  EXPECT_EQ(fixture.read(kArm + "/active"), 0);
  EXPECT_EQ(fixture.read(kLeg + "/active"), 0);
  fixture.click(kAll + "/active");
  EXPECT_EQ(fixture.read(kArm + "/active"), 1);
  EXPECT_EQ(fixture.read(kLeg + "/active"), 1);
}

TEST(PanelBehaviors, ListsSelectedBodyOnly) {
  PanelFixture fixture;
  fixture.click("tree:/physics/body/arm");
  fixture.click(kArm + "/active");
  EXPECT_EQ(fixture.read(kArm + "/active"), 0);
  EXPECT_EQ(fixture.read(kLeg + "/active"), 1);
}

TEST(PanelBehaviors, ParametersApplyToAllBodies) {
  PanelFixture fixture;
  fixture.click("behavior:" + kAll);
  fixture.click(kAll + "/amp", 0, KeyMods{true, false, false});
  fixture.key(GuiKey::a, {true, false, false});
  fixture.type("3.5");
  fixture.key(GuiKey::enter);
  EXPECT_EQ(fixture.read(kArm + "/amp"), 3.5);
  EXPECT_EQ(fixture.read(kLeg + "/amp"), 3.5);
}

TEST(PanelBehaviors, AddsAndRemoves) {
  PanelFixture fixture;
  fixture.click("tree:/physics/body/arm");
  fixture.click("behaviors.add");
  fixture.click("behaviors.type");
  fixture.click("behaviors.type=torque");
  fixture.click("behaviors.name");
  fixture.key(GuiKey::a, {true, false, false});
  fixture.type("turn");
  fixture.click("behaviors.add_it");
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/body/arm/behavior/turn/active"), 1);
  EXPECT_FALSE(find_property(fixture.show.engine.store(), "/physics/body/leg/behavior/turn").ok());
  fixture.click("remove:/physics/body/arm/behavior/turn");
  fixture.sync();
  EXPECT_FALSE(find_property(fixture.show.engine.store(), "/physics/body/arm/behavior/turn").ok());
  EXPECT_TRUE(find_property(fixture.show.engine.store(), kArm).ok());
}

// "spin" after "push" on both bodies, and a group that was added last.
const std::string kThree = std::string(kScene) + R"(
for _, body in ipairs(sim.bodies) do body:add_behavior("torque", "spin", { parts = "tip" }) end
sim:add_group_behavior("cohesion", "flock", { parts = "tip" })
)";
const std::string kSpin = "/physics/body/*/behavior/spin";

// Waits until several queued moves are executed and displayed; each waits for the result of the previous one.
void finish_animations(PanelFixture& fixture) {
  for (int i = 0; i < 3; i++) fixture.sync();
}

TEST(PanelBehaviors, MovesSelectedBehavior) {
  PanelFixture fixture(kThree);
  const auto places = [&] {
    return std::vector<double>{fixture.read(kArm + "/place"), fixture.read(kLeg + "/place"),
                               fixture.read("/physics/body/arm/behavior/spin/place"),
                               fixture.read("/physics/body/leg/behavior/spin/place"),
                               fixture.read("/physics/group/flock/place")};
  };
  ASSERT_EQ(places(), (std::vector<double>{1, 1, 2, 2, 3}));
  fixture.click("behavior:" + kSpin);
  EXPECT_GT(fixture.rect_of("behavior:" + kSpin).y, fixture.rect_of("behavior:" + kAll).y);
  fixture.click("behaviors.earlier");
  finish_animations(fixture);
  EXPECT_EQ(places(), (std::vector<double>{2, 2, 1, 1, 3}));
  EXPECT_LT(fixture.rect_of("behavior:" + kSpin).y, fixture.rect_of("behavior:" + kAll).y)
      << "the list is in that order";
  fixture.click("behaviors.earlier");
  finish_animations(fixture);
  EXPECT_EQ(places(), (std::vector<double>{2, 2, 1, 1, 3})) << "nothing is before it";
  fixture.key(GuiKey::down, {true, false, false});
  fixture.key(GuiKey::down, {true, false, false});  // two moves within a frame
  finish_animations(fixture);
  EXPECT_EQ(places(), (std::vector<double>{1, 1, 3, 3, 2})) << "past the group, too";
  fixture.click("behavior:/physics/group/flock");
  fixture.click("behaviors.earlier");
  finish_animations(fixture);
  EXPECT_EQ(places(), (std::vector<double>{2, 2, 3, 3, 1}));
}

TEST(PanelBehaviors, MovesBehaviorOfSelectedBodyOnly) {
  PanelFixture fixture(kThree);
  fixture.click("tree:/physics/body/arm");
  fixture.click("behavior:" + kArm);
  // the behavior is selected now: the list may show all bodies or still only this one
  fixture.key(GuiKey::down, {true, false, false});
  finish_animations(fixture);
  EXPECT_EQ(fixture.read(kArm + "/place"), 2);
  EXPECT_EQ(fixture.read(kLeg + "/place"), 1);
}

}  // namespace
}  // namespace limber::panel::test

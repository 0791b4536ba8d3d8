// The switches of the output to lights, the list of fixtures, and the monitor.
#include "panel/drawn_text.h"
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

constexpr const char* kLightScene = R"(
sim:add_fixture("spot", { profile = "moving_spot", universe = 4, address = 7, dimmer = 1 })
sim:add_fixture("par", { profile = "rgb_par", universe = 9, dimmer = 1, rgb = vec3(1, 0.5, 0) })
)";

TEST(PanelLighting, SwitchesAndShowsFixtures) {
  PanelFixture fixture(kLightScene, 1280, 720);
  fixture.show.ticks(2);
  fixture.sync();
  fixture.click("tab:lighting");
  EXPECT_TRUE(fixture.is_visible("lighting.state"));
  EXPECT_TRUE(fixture.is_visible("lighting.fixture:spot"));
  EXPECT_TRUE(fixture.is_visible("lighting.fixture:par"));
  fixture.click("lighting.armed");
  fixture.sync();
  EXPECT_EQ(fixture.read("/lighting/armed"), 1);
  fixture.click("lighting.blackout");
  fixture.sync();
  EXPECT_EQ(fixture.read("/lighting/blackout"), 1);
  fixture.click("lighting.fixture:par");
  EXPECT_EQ(fixture.gui->context().selected, "/lighting/fixture/par");
}

TEST(PanelLighting, KeysArmAndDarken) {
  PanelFixture fixture(kLightScene);
  fixture.key(GuiKey::l, kCtrl);
  EXPECT_EQ(fixture.read("/lighting/armed"), 1);
  fixture.key(GuiKey::l, kCtrl);
  EXPECT_EQ(fixture.read("/lighting/armed"), 0);
  fixture.key(GuiKey::b, kCtrl);
  EXPECT_EQ(fixture.read("/lighting/blackout"), 1);
}

TEST(PanelLighting, ASceneWithoutFixturesSaysHowToAddOne) {
  PanelFixture fixture;
  fixture.click("tab:lighting");
  EXPECT_TRUE(fixture.is_visible("lighting.armed"));
  EXPECT_FALSE(fixture.is_visible("lighting.universe:1"));
}

}  // namespace
}  // namespace limber::panel::test

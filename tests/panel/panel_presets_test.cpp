// Preset slots: store, recall, morph, and the interpolating index.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

void at_once(PanelFixture& fixture) { fixture.gui->context().settings.morph_seconds = 0; }

TEST(PanelPresets, StoreRecallAndInterpolate) {
  PanelFixture fixture;
  at_once(fixture);
  fixture.drag("/scene/rate", 0.25);
  const double low = fixture.read("/scene/rate");
  fixture.click("preset.1");
  EXPECT_EQ(fixture.read("/preset/count"), 1);
  fixture.drag("/scene/rate", 0.75);
  const double high = fixture.read("/scene/rate");
  fixture.click("preset.2");
  EXPECT_EQ(fixture.read("/preset/count"), 2);
  fixture.click("preset.1");
  EXPECT_EQ(fixture.read("/scene/rate"), low);
  fixture.key(GuiKey::digit_2);
  EXPECT_EQ(fixture.read("/scene/rate"), high) << "by its key";
  fixture.drag("preset.index", 0.5);
  EXPECT_NEAR(fixture.read("/scene/rate"), (low + high) / 2, 0.06) << "half-way between the two";
  fixture.click("preset.1", 1);
  fixture.click("preset.delete");
  EXPECT_EQ(fixture.read("/preset/count"), 1);
}

TEST(PanelPresets, CtrlClickOverwrites) {
  PanelFixture fixture;
  at_once(fixture);
  fixture.click("preset.1");
  fixture.drag("/scene/rate", 0.9);
  const double now = fixture.read("/scene/rate");
  fixture.click("preset.1", 0, KeyMods{true, false, false});
  fixture.drag("/scene/rate", 0.1);
  fixture.click("preset.1");
  EXPECT_EQ(fixture.read("/scene/rate"), now);
  EXPECT_EQ(fixture.read("/preset/count"), 1);
}

TEST(PanelPresets, MorphHasConfiguredDuration) {
  PanelFixture fixture;
  fixture.click("preset.1");
  fixture.drag("/scene/rate", 1);
  fixture.gui->context().settings.morph_seconds = 1;
  fixture.click("preset.easing");
  fixture.click("preset.easing=linear");
  fixture.click("preset.1");
  fixture.show.ticks(30);  // half a second
  EXPECT_NEAR(fixture.read("/scene/rate"), 1.25, 0.05) << "half-way from 2 to 0.5";
  fixture.show.ticks(40);
  EXPECT_EQ(fixture.read("/scene/rate"), 0.5);
}

TEST(PanelPresets, KeyOfEmptySlotDoesNothing) {
  PanelFixture fixture;
  fixture.key(GuiKey::digit_5);
  EXPECT_EQ(fixture.read("/preset/count"), 0);
  EXPECT_NE(fixture.gui->context().notice.text.find("Preset 5 not found"), std::string::npos);
}

}  // namespace
}  // namespace limber::panel::test

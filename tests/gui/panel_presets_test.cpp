// Preset slots: store, recall, morph, the index between two.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

void at_once(PanelRig& rig) { rig.gui->desk().settings.morph_seconds = 0; }

TEST(PanelPresets, StoreRecallAndBetween) {
  PanelRig rig;
  at_once(rig);
  rig.drag("/scene/rate", 0.25);
  const double low = rig.read("/scene/rate");
  rig.click("preset.1");
  EXPECT_EQ(rig.read("/preset/count"), 1);
  rig.drag("/scene/rate", 0.75);
  const double high = rig.read("/scene/rate");
  rig.click("preset.2");
  EXPECT_EQ(rig.read("/preset/count"), 2);
  rig.click("preset.1");
  EXPECT_EQ(rig.read("/scene/rate"), low);
  rig.key(GuiKey::digit_2);
  EXPECT_EQ(rig.read("/scene/rate"), high) << "by its key";
  rig.drag("preset.index", 0.5);
  EXPECT_NEAR(rig.read("/scene/rate"), (low + high) / 2, 0.06) << "half-way between the two";
  rig.click("preset.1", 1);
  rig.click("preset.delete");
  EXPECT_EQ(rig.read("/preset/count"), 1);
}

TEST(PanelPresets, CtrlAndAClickStoreOverOne) {
  PanelRig rig;
  at_once(rig);
  rig.click("preset.1");
  rig.drag("/scene/rate", 0.9);
  const double now = rig.read("/scene/rate");
  rig.click("preset.1", 0, KeyMods{true, false, false});
  rig.drag("/scene/rate", 0.1);
  rig.click("preset.1");
  EXPECT_EQ(rig.read("/scene/rate"), now);
  EXPECT_EQ(rig.read("/preset/count"), 1);
}

TEST(PanelPresets, AMorphTakesTheTimeThatIsSet) {
  PanelRig rig;
  rig.click("preset.1");
  rig.drag("/scene/rate", 1);
  rig.gui->desk().settings.morph_seconds = 1;
  rig.click("preset.easing");
  rig.click("preset.easing=linear");
  rig.click("preset.1");
  rig.show.ticks(30);  // half a second
  EXPECT_NEAR(rig.read("/scene/rate"), 1.25, 0.05) << "half-way from 2 to 0.5";
  rig.show.ticks(40);
  EXPECT_EQ(rig.read("/scene/rate"), 0.5);
}

TEST(PanelPresets, AnEmptySlotsKeyDoesNothing) {
  PanelRig rig;
  rig.key(GuiKey::digit_5);
  EXPECT_EQ(rig.read("/preset/count"), 0);
  EXPECT_NE(rig.gui->desk().notice.find("no preset 5"), std::string::npos);
}

}  // namespace
}  // namespace limber::gui_test

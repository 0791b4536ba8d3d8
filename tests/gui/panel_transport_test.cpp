// The transport's buttons and keys.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(PanelTransport, PlaysStepsAndGoesBack) {
  PanelRig rig;
  rig.show.ticks(3);
  rig.click("transport.play");
  EXPECT_EQ(rig.read("/physics/sim/paused"), 1);
  const double tick = rig.read("/physics/sim/tick");
  rig.click("transport.step");
  rig.show.ticks(5);
  EXPECT_EQ(rig.read("/physics/sim/tick"), tick + 1) << "one tick, and time stands still again";
  rig.key(GuiKey::period);
  rig.show.ticks(5);
  EXPECT_EQ(rig.read("/physics/sim/tick"), tick + 2);
  rig.click("transport.reset");
  rig.show.ticks(1);
  EXPECT_LE(rig.read("/physics/sim/tick"), 1);
  rig.drag("/physics/sim/speed", 0.9);
  EXPECT_GT(rig.read("/physics/sim/speed"), 1);
}

TEST(PanelTransport, SpaceIsALetterWhereOneTypes) {
  PanelRig rig;
  rig.click("parameters.search");
  rig.key(GuiKey::space);
  EXPECT_EQ(rig.read("/physics/sim/paused"), 0);
  rig.key(GuiKey::escape);
  rig.key(GuiKey::space);
  EXPECT_EQ(rig.read("/physics/sim/paused"), 1);
}

}  // namespace
}  // namespace limber::gui_test

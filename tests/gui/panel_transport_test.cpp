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

TEST(PanelTransport, PanicBringsToRestAndOnceMoreGoesOn) {
  PanelRig rig;
  rig.show.ticks(60);
  EXPECT_FALSE(rig.sees("panic.banner"));
  const PanelRect before = rig.where("transport.time");
  rig.click("transport.panic");
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/panicked"), 1);
  EXPECT_TRUE(rig.sees("panic.banner"));
  EXPECT_EQ(rig.gui->desk().notice, "panic: everything comes to rest");
  EXPECT_EQ(rig.where("transport.time").x, before.x) << "nothing moves";
  rig.click("transport.panic");
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/panicked"), 1) << "a second click by mistake";
  rig.show.ticks(61);
  rig.click("transport.panic");
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/panicked"), 0);
  EXPECT_FALSE(rig.sees("panic.banner"));
  EXPECT_EQ(rig.gui->desk().notice, "the panic is over");
}

TEST(PanelTransport, ThePanicKeyActsWhereOneTypesAndWhatTheFirstPressLeavesIsGoneBackTo) {
  PanelRig rig;
  rig.show.ticks(90);
  rig.click("parameters.search");
  rig.key(GuiKey::period, kCtrl);
  EXPECT_EQ(rig.read("/physics/sim/panicked"), 1);
  rig.show.ticks(70);
  EXPECT_EQ(rig.read("/physics/sim/tick"), 160);
  rig.key(GuiKey::period, kCtrl);
  EXPECT_EQ(rig.read("/physics/sim/panicked"), 0);
  EXPECT_LE(rig.read("/physics/sim/tick"), 90) << "the newest good moment is not behind the panic";
  rig.key(GuiKey::f1);
  rig.key(GuiKey::period, kCtrl);
  EXPECT_EQ(rig.read("/physics/sim/panicked"), 1) << "hidden, too";
  EXPECT_FALSE(rig.sees("panic.banner")) << "the picture stays clean then";
}

TEST(PanelTransport, KeysAndButtonsGoBackInTime) {
  PanelRig rig;
  rig.show.ticks(200);
  rig.key(GuiKey::comma);
  EXPECT_EQ(rig.read("/physics/sim/tick"), 199);
  EXPECT_EQ(rig.read("/physics/sim/paused"), 1) << "a step back stands still";
  rig.click("transport.step_back");
  EXPECT_EQ(rig.read("/physics/sim/tick"), 198);
  // three presses before the panel looks
  InputEvent event;
  event.kind = InputEvent::Kind::key;
  event.key = GuiKey::comma;
  for (int i = 0; i < 6; i++) {
    event.down = i % 2 == 0;
    rig.push(event);
  }
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/tick"), 195);
  rig.key(GuiKey::comma, kShift);
  EXPECT_EQ(rig.read("/physics/sim/tick"), 75) << "two seconds";
  EXPECT_EQ(rig.gui->desk().refusal, "");
  rig.click("transport.rewind");
  EXPECT_EQ(rig.read("/physics/sim/tick"), 0);
  EXPECT_NE(rig.gui->desk().notice.find("1.25 s back, no further"), std::string::npos) << rig.gui->desk().notice;
}

}  // namespace
}  // namespace limber::gui_test

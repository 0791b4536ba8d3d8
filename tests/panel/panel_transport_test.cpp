// The buttons and keys of the transport.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(PanelTransport, PlaysStepsAndResets) {
  PanelFixture fixture;
  fixture.show.ticks(3);
  fixture.click("transport.play");
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 1);
  const double tick = fixture.read("/physics/sim/tick");
  fixture.click("transport.step");
  fixture.show.ticks(5);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), tick + 1) << "one tick, then paused again";
  fixture.key(GuiKey::period);
  fixture.show.ticks(5);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), tick + 2);
  fixture.click("transport.reset");
  fixture.show.ticks(1);
  EXPECT_LE(fixture.read("/physics/sim/tick"), 1);
  fixture.drag("/physics/sim/speed", 0.9);
  EXPECT_GT(fixture.read("/physics/sim/speed"), 1);
}

TEST(PanelTransport, SpaceTypesInTextField) {
  PanelFixture fixture;
  fixture.click("parameters.search");
  fixture.key(GuiKey::space);
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 0);
  fixture.key(GuiKey::escape);
  fixture.key(GuiKey::space);
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 1);
}

TEST(PanelTransport, PanicStopsAndResumes) {
  PanelFixture fixture;
  fixture.show.ticks(60);
  EXPECT_FALSE(fixture.is_visible("panic.banner"));
  const PanelRect before = fixture.rect_of("transport.time");
  fixture.click("transport.panic");
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/panicked"), 1);
  EXPECT_TRUE(fixture.is_visible("panic.banner"));
  EXPECT_EQ(fixture.gui->context().notice.text, "Panic: all motion is stopped");
  EXPECT_EQ(fixture.rect_of("transport.time").x, before.x) << "nothing moves";
  fixture.click("transport.panic");
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/panicked"), 1) << "a second click by mistake";
  fixture.show.ticks(61);
  fixture.click("transport.panic");
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/panicked"), 0);
  EXPECT_FALSE(fixture.is_visible("panic.banner"));
  EXPECT_EQ(fixture.gui->context().notice.text, "Panic ended");
}

TEST(PanelTransport, PanicKeyActsInTextField) {
  PanelFixture fixture;
  fixture.show.ticks(90);
  fixture.click("parameters.search");
  fixture.key(GuiKey::period, kCtrl);
  EXPECT_EQ(fixture.read("/physics/sim/panicked"), 1);
  fixture.show.ticks(70);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 160);
  fixture.key(GuiKey::period, kCtrl);
  EXPECT_EQ(fixture.read("/physics/sim/panicked"), 0);
  EXPECT_LE(fixture.read("/physics/sim/tick"), 90) << "the restored state is not later than the panic";
  fixture.key(GuiKey::f1);
  fixture.key(GuiKey::period, kCtrl);
  EXPECT_EQ(fixture.read("/physics/sim/panicked"), 1) << "hidden, too";
  EXPECT_FALSE(fixture.is_visible("panic.banner")) << "hidden with the panel";
}

TEST(PanelTransport, RewindsByKeysAndButtons) {
  PanelFixture fixture;
  fixture.show.ticks(200);
  fixture.key(GuiKey::comma);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 199);
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 1) << "a step back pauses";
  fixture.click("transport.step_back");
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 198);
  // three presses before the panel looks
  InputEvent event;
  event.kind = InputEvent::Kind::key;
  event.key = GuiKey::comma;
  for (int i = 0; i < 6; i++) {
    event.down = i % 2 == 0;
    fixture.push(event);
  }
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 195);
  fixture.key(GuiKey::comma, kShift);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 75) << "two seconds";
  EXPECT_EQ(fixture.gui->context().rejection.text, "");
  fixture.click("transport.rewind");
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 0);
  EXPECT_NE(fixture.gui->context().notice.text.find("Rewound only 1.25 s"), std::string::npos)
      << fixture.gui->context().notice.text;
}

}  // namespace
}  // namespace limber::panel::test

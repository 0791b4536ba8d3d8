// The OSC monitor logs messages only while it is visible, and shows frequent addresses less often.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(PanelOsc, LogsOnlyWhileVisible) {
  PanelFixture fixture;
  fixture.frames(3);
  EXPECT_TRUE(fixture.show.link.message_log.enabled());
  fixture.key(GuiKey::f1);
  fixture.frames(80);
  EXPECT_FALSE(fixture.show.link.message_log.enabled()) << "hidden: nothing is noted";
  fixture.key(GuiKey::f1);
  fixture.frames(3);
  EXPECT_TRUE(fixture.show.link.message_log.enabled());
}

TEST(PanelOsc, ThinsOutFrequentAddresses) {
  PanelFixture fixture;
  fixture.frames(3);
  for (int i = 0; i < 100; i++)
    fixture.show.link.message_log.add(true, "127.0.0.1:4000", {"/often", {Arg::of(1.0 * i)}});
  fixture.show.link.message_log.add(false, "127.0.0.1:9005", {"/once", {}});
  fixture.frames(3);
  ASSERT_TRUE(fixture.is_visible("osc.line1"));
  EXPECT_FALSE(fixture.is_visible("osc.line2")) << "a hundred of one address are one line";
  fixture.click("osc.line0");
  EXPECT_EQ(fixture.clipboard, "/often 0");
  fixture.click("osc.line1");
  EXPECT_EQ(fixture.clipboard, "/once");
}

}  // namespace
}  // namespace limber::panel::test

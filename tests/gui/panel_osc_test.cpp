// The OSC monitor watches only while it is seen, and thins out what comes often.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(PanelOsc, WatchesWhileItIsSeen) {
  PanelRig rig;
  rig.frames(3);
  EXPECT_TRUE(rig.show.link.traffic.watched());
  rig.key(GuiKey::f1);
  rig.frames(80);
  EXPECT_FALSE(rig.show.link.traffic.watched()) << "hidden: nothing is noted";
  rig.key(GuiKey::f1);
  rig.frames(3);
  EXPECT_TRUE(rig.show.link.traffic.watched());
}

TEST(PanelOsc, ShowsWhatComesAndThinsItOut) {
  PanelRig rig;
  rig.frames(3);
  for (int i = 0; i < 100; i++) rig.show.link.traffic.note(true, "127.0.0.1:4000", {"/often", {Arg::of(1.0 * i)}});
  rig.show.link.traffic.note(false, "127.0.0.1:9005", {"/once", {}});
  rig.frames(3);
  ASSERT_TRUE(rig.sees("osc.line1"));
  EXPECT_FALSE(rig.sees("osc.line2")) << "a hundred of one address are one line";
  rig.click("osc.line0");
  EXPECT_EQ(rig.clipboard, "/often 0");
  rig.click("osc.line1");
  EXPECT_EQ(rig.clipboard, "/once");
}

}  // namespace
}  // namespace limber::gui_test

// The status at the right end of the top bar: the sign of what was lost.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(PanelStatus, ShowsNoSignOfLossesWhileAllIsWell) {
  PanelRig rig;
  EXPECT_TRUE(rig.sees("status.text"));
  EXPECT_FALSE(rig.sees("status.health"));
}

TEST(PanelStatus, AClickOnTheSignCopiesWhatWasLost) {
  for (const double width : {1600.0, 1250.0, 1000.0}) {
    PanelRig rig(kScene, width);
    const PanelRect lua = rig.where("status.LUA");
    rig.show.link.health.add(HealthItem::loops, 17);
    rig.frames(2);
    ASSERT_TRUE(rig.sees("status.health")) << width;
    const PanelRect sign = rig.where("status.health");
    EXPECT_LE(sign.x + sign.width, rig.where("status.text").x) << width;
    EXPECT_NEAR(rig.where("status.LUA").x, lua.x, 0.01) << width << ": lamps stay where they are";
    rig.click("status.health");
    EXPECT_TRUE(rig.clipboard.starts_with("loops 17 since ")) << rig.clipboard;
    rig.show.link.health.set(HealthItem::loops, 0);
    rig.frames(2);
    EXPECT_FALSE(rig.sees("status.health")) << width;
  }
}

}  // namespace
}  // namespace limber::gui_test

// The status at the right end of the top bar: the warning sign for losses.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(PanelStatus, HidesWarningWithoutLosses) {
  PanelFixture fixture;
  EXPECT_TRUE(fixture.is_visible("status.text"));
  EXPECT_FALSE(fixture.is_visible("status.health"));
}

TEST(PanelStatus, ClickOnWarningCopiesLosses) {
  for (const double width : {1600.0, 1250.0, 1000.0}) {
    PanelFixture fixture(kScene, width);
    const PanelRect lua = fixture.rect_of("status.LUA");
    fixture.show.link.health.add(engine::HealthItem::loops, 17);
    fixture.frames(2);
    ASSERT_TRUE(fixture.is_visible("status.health")) << width;
    const PanelRect sign = fixture.rect_of("status.health");
    EXPECT_LE(sign.x + sign.width, fixture.rect_of("status.text").x) << width;
    EXPECT_NEAR(fixture.rect_of("status.LUA").x, lua.x, 0.01) << width << ": lamps stay where they are";
    fixture.click("status.health");
    EXPECT_TRUE(fixture.clipboard.starts_with("loops 17 since ")) << fixture.clipboard;
    fixture.show.link.health.set(engine::HealthItem::loops, 0);
    fixture.frames(2);
    EXPECT_FALSE(fixture.is_visible("status.health")) << width;
  }
}

}  // namespace
}  // namespace limber::panel::test

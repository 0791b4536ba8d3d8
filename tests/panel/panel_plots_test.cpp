// Plots: added by a property's context menu, and closed.
#include <algorithm>

#include <imgui.h>

#include "panel/rig.h"
#include "ui/panel/theme.h"

namespace limber::panel::test {
namespace {

TEST(PanelPlots, PlotsSelectedProperty) {
  PanelFixture fixture;
  fixture.click("/scene/rate", 1);
  fixture.click("menu:plot");
  EXPECT_EQ(fixture.gui->context().plots, std::vector<std::string>{"/scene/rate"});
  fixture.click("tab:plots");
  EXPECT_TRUE(fixture.is_visible("plot:/scene/rate"));
  fixture.show.ticks(2);
  fixture.sync();
  fixture.click("unplot:/scene/rate");
  EXPECT_TRUE(fixture.gui->context().plots.empty());
  EXPECT_FALSE(fixture.is_visible("plot:/scene/rate"));
}

// Returns the number of samples that the plotted line covers; each is a 299th of the width.
double samples_drawn(const PanelFixture& fixture, const std::string& path) {
  const PanelRect at = fixture.rect_of("plot:" + path);
  const std::uint32_t color = packed_color(ThemeColor::accent) & 0xffffff;
  double right = at.x;
  const ImDrawData& draw_data = *ImGui::GetDrawData();
  for (int i = 0; i < draw_data.CmdListsCount; i++) {
    for (const ImDrawVert& v : draw_data.CmdLists[i]->VtxBuffer) {
      const bool inside =
          v.pos.x >= at.x && v.pos.x <= at.x + at.width && v.pos.y >= at.y && v.pos.y <= at.y + at.height;
      if (inside && (v.col & 0xffffff) == color) right = std::max(right, static_cast<double>(v.pos.x));
    }
  }
  return (right - at.x) / at.width * 299;
}

TEST(PanelPlots, DiscardSamplesAfterRewind) {
  PanelFixture fixture;
  const std::string path = "/scene/rate";
  fixture.click(path, 1);
  fixture.click("menu:plot");
  fixture.click("tab:plots");
  const auto play = [&](int ticks) {
    for (int i = 0; i < ticks; i++) {
      fixture.show.ticks(1);
      fixture.sync();
    }
  };
  play(90);
  const double before = samples_drawn(fixture, path);
  EXPECT_NEAR(before, 90, 3);
  fixture.show.send("/transport/rewind", 1.0);
  fixture.sync();
  fixture.frames(2);
  EXPECT_NEAR(samples_drawn(fixture, path), before - 60, 2) << "a second of samples is discarded";
  play(30);
  EXPECT_NEAR(samples_drawn(fixture, path), before - 30, 3) << "and another one follows";
}

}  // namespace
}  // namespace limber::panel::test

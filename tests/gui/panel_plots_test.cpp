// Plots: a value that was chosen by its menu, until it is closed.
#include <algorithm>

#include <imgui.h>

#include "gui/rig.h"
#include "gui/theme.h"

namespace limber::gui_test {
namespace {

TEST(PanelPlots, PlotsWhatIsChosen) {
  PanelRig rig;
  rig.click("/scene/rate", 1);
  rig.click("plot_it");
  EXPECT_EQ(rig.gui->desk().plots, std::vector<std::string>{"/scene/rate"});
  rig.click("tab:plots");
  EXPECT_TRUE(rig.sees("plot:/scene/rate"));
  rig.show.ticks(2);
  rig.heard();
  rig.click("unplot:/scene/rate");
  EXPECT_TRUE(rig.gui->desk().plots.empty());
  EXPECT_FALSE(rig.sees("plot:/scene/rate"));
}

// how far the line of a plot reaches, in samples: each is as wide as a 299th of the field
double samples_drawn(const PanelRig& rig, const std::string& path) {
  const PanelRect at = rig.where("plot:" + path);
  const std::uint32_t color = packed(Tone::accent) & 0xffffff;
  double right = at.x;
  const ImDrawData& drawn = *ImGui::GetDrawData();
  for (int i = 0; i < drawn.CmdListsCount; i++) {
    for (const ImDrawVert& v : drawn.CmdLists[i]->VtxBuffer) {
      const bool inside =
          v.pos.x >= at.x && v.pos.x <= at.x + at.width && v.pos.y >= at.y && v.pos.y <= at.y + at.height;
      if (inside && (v.col & 0xffffff) == color) right = std::max(right, static_cast<double>(v.pos.x));
    }
  }
  return (right - at.x) / at.width * 299;
}

TEST(PanelPlots, ForgetWhatHasNotBeen) {
  PanelRig rig;
  const std::string path = "/scene/rate";
  rig.click(path, 1);
  rig.click("plot_it");
  rig.click("tab:plots");
  const auto play = [&](int ticks) {
    for (int i = 0; i < ticks; i++) {
      rig.show.ticks(1);
      rig.heard();
    }
  };
  play(90);
  const double before = samples_drawn(rig, path);
  EXPECT_NEAR(before, 90, 3);
  rig.show.send("/transport/rewind", 1.0);
  rig.heard();
  rig.frames(2);
  EXPECT_NEAR(samples_drawn(rig, path), before - 60, 2) << "a second of it is gone";
  play(30);
  EXPECT_NEAR(samples_drawn(rig, path), before - 30, 3) << "and another one follows";
}

}  // namespace
}  // namespace limber::gui_test

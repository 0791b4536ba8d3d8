// Plots: a value that was chosen by its menu, until it is closed.
#include "gui/rig.h"

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

}  // namespace
}  // namespace limber::gui_test

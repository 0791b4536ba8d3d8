// The bar of the past: back to where a hand lets go, and not before it does.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

class HistoryBar : public ::testing::Test {
 protected:
  HistoryBar() {
    rig.show.ticks(600);  // 10 s of the 30 that are kept
    rig.heard();
    bar = rig.where("transport.past");
  }
  double x_of(double seconds_back) const { return bar.x + bar.width * (1 - seconds_back / 30); }
  void move_to(double seconds_back) { rig.move(x_of(seconds_back), bar.y + bar.height / 2); }

  PanelRig rig;
  PanelRect bar;
};

TEST_F(HistoryBar, GoesBackToWhereAHandLetsGo) {
  move_to(1);
  rig.button(true);
  rig.heard();
  move_to(4);
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/tick"), 600) << "held, not let go of";
  rig.button(false);
  rig.heard();
  const double pixel = 30 / bar.width;  // s
  EXPECT_NEAR(rig.read("/physics/sim/time"), 6, pixel + 1.0 / 60);
  EXPECT_EQ(rig.read("/physics/sim/paused"), 0) << "and plays on";
}

TEST_F(HistoryBar, NoFurtherThanThereIsAPast) {
  move_to(1);
  rig.button(true);
  move_to(25);
  rig.heard();
  rig.button(false);
  rig.heard();
  EXPECT_LE(rig.read("/physics/sim/tick"), 1);
  EXPECT_EQ(rig.gui->desk().refusal, "");
}

TEST_F(HistoryBar, AHandThatComesBackToNowHasChangedItsMind) {
  move_to(3);
  rig.button(true);
  rig.heard();
  rig.move(bar.x + bar.width + 40, bar.y + 2);
  rig.heard();
  rig.button(false);
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/tick"), 600);
}

}  // namespace
}  // namespace limber::gui_test

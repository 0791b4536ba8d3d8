// The history bar rewinds to the time at which the mouse is released, and not before.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

class HistoryBar : public ::testing::Test {
 protected:
  HistoryBar() {
    fixture.show.ticks(600);  // 10 s of the 30 s of history
    fixture.sync();
    bar = fixture.rect_of("transport.history");
  }
  double x_of(double seconds_back) const { return bar.x + bar.width * (1 - seconds_back / 30); }
  void move_to(double seconds_back) { fixture.move(x_of(seconds_back), bar.y + bar.height / 2); }

  PanelFixture fixture;
  PanelRect bar;
};

TEST_F(HistoryBar, RewindsOnRelease) {
  move_to(1);
  fixture.button(true);
  fixture.sync();
  move_to(4);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 600) << "not yet released";
  fixture.button(false);
  fixture.sync();
  const double pixel = 30 / bar.width;  // s
  EXPECT_NEAR(fixture.read("/physics/sim/time"), 6, pixel + 1.0 / 60);
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 0) << "and plays on";
}

TEST_F(HistoryBar, LimitsRewindToHistory) {
  move_to(1);
  fixture.button(true);
  move_to(25);
  fixture.sync();
  fixture.button(false);
  fixture.sync();
  EXPECT_LE(fixture.read("/physics/sim/tick"), 1);
  EXPECT_EQ(fixture.gui->context().rejection.text, "");
}

TEST_F(HistoryBar, CancelsAtThePresent) {
  move_to(3);
  fixture.button(true);
  fixture.sync();
  fixture.move(bar.x + bar.width + 40, bar.y + 2);
  fixture.sync();
  fixture.button(false);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 600);
}

}  // namespace
}  // namespace limber::panel::test

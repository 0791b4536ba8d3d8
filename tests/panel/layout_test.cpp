// The layout of panels and of the widgets in them: no overlaps and nothing outside the window, at any window size.
#include "ui/panel/layout.h"

#include <algorithm>
#include <vector>

#include "panel/rig.h"

namespace limber::panel::test {
namespace {

bool overlap(const PanelRect& a, const PanelRect& b) {
  constexpr double kTouch = 0.01;
  return a.x + a.width > b.x + kTouch && b.x + b.width > a.x + kTouch && a.y + a.height > b.y + kTouch &&
         b.y + b.height > a.y + kTouch;
}

bool inside(const PanelRect& a, double width, double height) {
  constexpr double kTouch = 0.01;
  return a.x >= -kTouch && a.y >= -kTouch && a.x + a.width <= width + kTouch && a.y + a.height <= height + kTouch;
}

struct WindowSize {
  double width, height, scale;
};

TEST(Layout, PanelsStayInWindowWithoutOverlap) {
  for (double scale = 0.75; scale <= 4; scale += 0.25) {
    for (double width = 1; width < 4000; width = width * 1.17 + 1) {
      for (double height = 1; height < 2400; height = height * 1.23 + 1) {
        const Layout layout = lay_out(width, height, scale);
        std::vector<PanelRect> seen;
        for (const PanelRect& rect : layout.slots) {
          if (!rect.empty()) seen.push_back(rect);
        }
        for (std::size_t i = 0; i < seen.size(); i++) {
          ASSERT_TRUE(inside(seen[i], width, height)) << width << " × " << height << " at " << scale;
          for (std::size_t j = 0; j < i; j++)
            ASSERT_FALSE(overlap(seen[i], seen[j])) << width << " × " << height << " at " << scale;
        }
      }
    }
  }
}

TEST(Layout, IsCompactBelow1200Units) {
  EXPECT_FALSE(lay_out(1200, 800, 1).compact);
  EXPECT_TRUE(lay_out(1199, 800, 1).compact);
  EXPECT_TRUE(lay_out(2399, 1600, 2).compact) << "twice the pixels, the same units";
  EXPECT_FALSE(lay_out(2400, 1600, 2).compact);
  EXPECT_TRUE(lay_out(1, 1, 1).at(PanelSlot::top).empty());
}

TEST(Layout, LeavesTheMiddleForTheView) {
  const Layout layout = lay_out(1600, 900, 1);
  EXPECT_GT(layout.view.width, 800);
  EXPECT_GT(layout.view.height, 500);
}

// Checks the visible widgets.
void expect_no_overlap(const PanelFixture& fixture, const WindowSize& size) {
  const std::vector<NamedWidget> widgets = fixture.gui->names().all();
  ASSERT_GT(widgets.size(), 15u);
  for (const NamedWidget& widget : widgets) {
    if (widget.visible.empty()) continue;
    EXPECT_TRUE(inside(widget.visible, size.width, size.height)) << widget.name;
    // Scrolling is only vertical, so nothing is cut at the sides. A line of a list extends slightly into the gap beside
    // it.
    EXPECT_NEAR(widget.visible.width, widget.rect.width, 9 * size.scale) << widget.name << " is cut";
    for (const NamedWidget& other : widgets) {
      // the console's output and its lines may overlap
      const bool should_be_apart =
          &other != &widget && other.name != "console.output" && widget.name != "console.output";
      if (!should_be_apart || other.visible.empty()) continue;
      EXPECT_FALSE(overlap(widget.visible, other.visible)) << widget.name << " and " << other.name;
    }
  }
}

class WidgetLayout : public ::testing::TestWithParam<WindowSize> {};

TEST_P(WidgetLayout, HasNoOverlapsOrCuts) {
  const WindowSize size = GetParam();
  PanelFixture fixture(kScene, size.width, size.height);
  fixture.scale = size.scale;
  fixture.gui->context().selected = "/physics/body/arm/motor/hinge";
  fixture.frames(3);
  expect_no_overlap(fixture, size);
  for (const char* const tab :
       {"tab:scene", "tab:behaviors", "tab:errors", "tab:osc", "tab:performance", "tab:plots", "tab:routes"}) {
    if (!fixture.is_visible(tab)) continue;
    fixture.click(tab);
    fixture.move(0, 0);
    fixture.frames(3);
    expect_no_overlap(fixture, size);
  }
}

TEST_P(WidgetLayout, HasNoOverlapsDuringPanicAndTake) {
  const WindowSize size = GetParam();
  PanelFixture fixture(kScene, size.width, size.height);
  fixture.scale = size.scale;
  fixture.show.send("/take/record", "a name that is as long as names are, and a bit longer");
  fixture.sync();
  fixture.click("transport.panic");
  fixture.click("transport.rewind");  // a take has just begun: there is no past
  fixture.move(0, 0);
  fixture.sync();
  for (const char* const shown : {"panic.banner", "take.text", "rejection", "transport.history"})
    EXPECT_TRUE(fixture.is_visible(shown)) << shown;
  expect_no_overlap(fixture, size);
}

INSTANTIATE_TEST_SUITE_P(Sizes, WidgetLayout,
                         ::testing::Values(WindowSize{1600, 900, 1}, WindowSize{1280, 720, 1}, WindowSize{1200, 700, 1},
                                           WindowSize{900, 600, 1}, WindowSize{1600, 900, 2},
                                           WindowSize{3200, 1800, 2}));

}  // namespace
}  // namespace limber::panel::test

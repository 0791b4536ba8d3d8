// Places of panels: nothing overlaps, nothing is outside, whatever the window; and the same of every widget in them.
#include "gui/layout.h"

#include <algorithm>
#include <vector>

#include "gui/rig.h"

namespace limber::gui_test {
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

TEST(Layout, PanelsNeitherOverlapNorLeaveTheWindow) {
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

TEST(Layout, IsCompactBelow1200PixelsOfItsOwn) {
  EXPECT_FALSE(lay_out(1200, 800, 1).compact);
  EXPECT_TRUE(lay_out(1199, 800, 1).compact);
  EXPECT_TRUE(lay_out(2399, 1600, 2).compact) << "twice the pixels, the same room";
  EXPECT_FALSE(lay_out(2400, 1600, 2).compact);
  EXPECT_TRUE(lay_out(1, 1, 1).at(Slot::top).empty());
}

TEST(Layout, TheMiddleStaysFreeForThePicture) {
  const Layout layout = lay_out(1600, 900, 1);
  EXPECT_GT(layout.free.width, 800);
  EXPECT_GT(layout.free.height, 500);
}

// of each window of the panel, the widgets that are seen
void expect_orderly(const PanelRig& rig, const WindowSize& size) {
  const std::vector<NamedWidget> widgets = rig.gui->names().all();
  ASSERT_GT(widgets.size(), 15u);
  for (const NamedWidget& widget : widgets) {
    if (widget.visible.empty()) continue;
    EXPECT_TRUE(inside(widget.visible, size.width, size.height)) << widget.name;
    // scrolling goes up and down alone: nothing is cut at the sides
    // (a line of a list reaches a little into the gap beside it)
    EXPECT_NEAR(widget.visible.width, widget.whole.width, 9 * size.scale) << widget.name << " is cut";
    for (const NamedWidget& other : widgets) {
      // a list and its lines, a row's field and its search sign
      const bool apart = &other != &widget && other.name != "console.said" && widget.name != "console.said";
      if (!apart || other.visible.empty()) continue;
      EXPECT_FALSE(overlap(widget.visible, other.visible)) << widget.name << " and " << other.name;
    }
  }
}

class LayoutOfWidgets : public ::testing::TestWithParam<WindowSize> {};

TEST_P(LayoutOfWidgets, NothingOverlapsOrIsCut) {
  const WindowSize size = GetParam();
  PanelRig rig(kScene, size.width, size.height);
  rig.scale = size.scale;
  rig.gui->desk().selected = "/physics/body/arm/motor/hinge";
  rig.frames(3);
  expect_orderly(rig, size);
  for (const char* const tab :
       {"tab:scene", "tab:behaviors", "tab:errors", "tab:osc", "tab:performance", "tab:plots"}) {
    if (!rig.sees(tab)) continue;
    rig.click(tab);
    rig.move(0, 0);
    rig.frames(3);
    expect_orderly(rig, size);
  }
}

TEST_P(LayoutOfWidgets, NorWhileThereIsAPanicATakeAndARefusal) {
  const WindowSize size = GetParam();
  PanelRig rig(kScene, size.width, size.height);
  rig.scale = size.scale;
  rig.show.send("/take/record", "a name that is as long as names are, and a bit longer");
  rig.heard();
  rig.click("transport.panic");
  rig.click("transport.rewind");  // a take has just begun: there is no past
  rig.move(0, 0);
  rig.heard();
  for (const char* const shown : {"panic.banner", "take.text", "refusal", "transport.past"})
    EXPECT_TRUE(rig.sees(shown)) << shown;
  expect_orderly(rig, size);
}

INSTANTIATE_TEST_SUITE_P(Sizes, LayoutOfWidgets,
                         ::testing::Values(WindowSize{1600, 900, 1}, WindowSize{1280, 720, 1}, WindowSize{1200, 700, 1},
                                           WindowSize{900, 600, 1}, WindowSize{1600, 900, 2},
                                           WindowSize{3200, 1800, 2}));

}  // namespace
}  // namespace limber::gui_test

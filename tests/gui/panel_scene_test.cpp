// The tree of things: opens, finds, chooses; cheap with many.
#include <algorithm>

#include "gui/rig.h"
#include "gui/tree_list.h"

namespace limber::gui_test {
namespace {

TEST(PanelScene, OpensAndChooses) {
  PanelRig rig;
  ASSERT_TRUE(rig.sees("tree:/physics/body/arm")) << "bodies are open from the start";
  EXPECT_FALSE(rig.sees("tree:/physics/body/arm/part"));
  rig.click("tree:/physics/body/arm");
  EXPECT_EQ(rig.gui->desk().selected, "/physics/body/arm");
  EXPECT_TRUE(rig.sees("section:/physics/body/arm")) << "its rows stand among the parameters";
  rig.click("tree:/physics/body/arm");
  rig.scroll("tree:/physics/body/arm", -3);
  rig.click("tree:/physics/body/arm/part");
  rig.scroll("tree:/physics/body/arm/part", -3);
  rig.click("tree:/physics/body/arm/part/tip");
  rig.drag("/physics/body/arm/part/tip/friction", 0.8);
  EXPECT_GT(rig.read("/physics/body/arm/part/tip/friction"), 0.5);
  EXPECT_EQ(rig.read("/physics/body/leg/part/tip/friction"), 0.5);
}

TEST(PanelScene, ASearchShowsWhatFitsAndWhatItLiesIn) {
  PanelRig rig;
  rig.click("scene.search");
  rig.type("HING");
  rig.frames(2);
  EXPECT_TRUE(rig.sees("tree:/physics/body/arm/joint/hinge"));
  EXPECT_TRUE(rig.sees("tree:/physics/body/leg"));
  EXPECT_FALSE(rig.sees("tree:/physics/body/arm/part/tip"));
}

TEST(PanelScene, WhatHasGoneIsChosenNoMore) {
  PanelRig rig;
  rig.click("tree:/physics/body/leg");
  rig.show.send("/physics/body/leg/remove");
  rig.heard();
  EXPECT_FALSE(rig.sees("tree:/physics/body/leg"));
  EXPECT_EQ(rig.gui->desk().selected, "");
}

TEST(PanelScene, ManyThingsCostWhatIsSeen) {
  PanelRig rig(R"(
    sim:add_sphere_shape("ball", 0.1)
    for b = 1, 40 do
      local body = sim:add_body("body" .. b)
      for p = 1, 25 do body:add_part("part" .. p, "ball", { position = vec3(b, p, 1) }) end
    end)");
  const auto widgets = rig.gui->names().all();
  EXPECT_LT(
      std::count_if(widgets.begin(), widgets.end(), [](const NamedWidget& w) { return w.name.starts_with("tree:"); }),
      40)
      << "lines that are scrolled out of sight are not made";
  TreeList list;
  const std::shared_ptr<const Tree> tree = rig.gui->desk().image->tree;
  const TreeList::Line* const first = list.lines(tree, "").data();
  const std::size_t size = list.lines(tree, "").size();
  EXPECT_EQ(list.lines(tree, "").data(), first);
  EXPECT_EQ(list.lines(tree, "part7").size() % 40, 1u) << "bodies, each body with its parts and one that fits";
  EXPECT_EQ(list.lines(tree, "").size(), size);
}

}  // namespace
}  // namespace limber::gui_test

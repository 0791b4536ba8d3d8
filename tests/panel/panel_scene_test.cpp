// The object tree: expand, search, select; fast with many objects.
#include <algorithm>

#include "panel/rig.h"
#include "ui/panel/widgets/tree_list.h"

namespace limber::panel::test {
namespace {

TEST(PanelScene, ExpandsAndSelects) {
  PanelFixture fixture;
  ASSERT_TRUE(fixture.is_visible("tree:/physics/body/arm")) << "bodies are open from the start";
  EXPECT_FALSE(fixture.is_visible("tree:/physics/body/arm/part"));
  fixture.click("tree:/physics/body/arm");
  EXPECT_EQ(fixture.gui->context().selected, "/physics/body/arm");
  EXPECT_TRUE(fixture.is_visible("section:/physics/body/arm")) << "its properties are shown";
  fixture.click("tree:/physics/body/arm");
  fixture.scroll("tree:/physics/body/arm", -3);
  fixture.click("tree:/physics/body/arm/part");
  fixture.scroll("tree:/physics/body/arm/part", -3);
  fixture.click("tree:/physics/body/arm/part/tip");
  fixture.drag("/physics/body/arm/part/tip/friction", 0.8);
  EXPECT_GT(fixture.read("/physics/body/arm/part/tip/friction"), 0.5);
  EXPECT_EQ(fixture.read("/physics/body/leg/part/tip/friction"), 0.5);
}

TEST(PanelScene, SearchShowsMatchesWithAncestors) {
  PanelFixture fixture;
  fixture.click("scene.search");
  fixture.type("HING");
  fixture.frames(2);
  EXPECT_TRUE(fixture.is_visible("tree:/physics/body/arm/joint/hinge"));
  EXPECT_TRUE(fixture.is_visible("tree:/physics/body/leg"));
  EXPECT_FALSE(fixture.is_visible("tree:/physics/body/arm/part/tip"));
}

TEST(PanelScene, DeselectsRemovedObject) {
  PanelFixture fixture;
  fixture.click("tree:/physics/body/leg");
  fixture.show.send("/physics/body/leg/remove");
  fixture.sync();
  EXPECT_FALSE(fixture.is_visible("tree:/physics/body/leg"));
  EXPECT_EQ(fixture.gui->context().selected, "");
}

TEST(PanelScene, CostDependsOnVisibleLines) {
  PanelFixture fixture(R"(
    sim:add_sphere_shape("ball", 0.1)
    for b = 1, 40 do
      local body = sim:add_body("body" .. b)
      for p = 1, 25 do body:add_part("part" .. p, "ball", { position = vec3(b, p, 1) }) end
    end)");
  const auto widgets = fixture.gui->names().all();
  EXPECT_LT(
      std::count_if(widgets.begin(), widgets.end(), [](const NamedWidget& w) { return w.name.starts_with("tree:"); }),
      40)
      << "lines that are scrolled out of sight are not made";
  TreeList list;
  const std::shared_ptr<const TreeSnapshot> tree = fixture.gui->context().value_snapshot->tree;
  const TreeList::Line* const first = list.lines(tree, "").data();
  const std::size_t size = list.lines(tree, "").size();
  EXPECT_EQ(list.lines(tree, "").data(), first);
  EXPECT_EQ(list.lines(tree, "part7").size() % 40, 1u) << "bodies, each body with its parts and one that fits";
  EXPECT_EQ(list.lines(tree, "").size(), size);
}

}  // namespace
}  // namespace limber::panel::test

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
  fixture.click("tree:/physics/body/arm/part");
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

struct SavedScene {
  std::string file;
  bool overwrite = false;
};

// A panel that saves scenes to `saved`; `error`: the result of each attempt.
GuiOptions saving_options(const std::string& file, std::vector<SavedScene>& saved, const std::string& error) {
  GuiOptions options = PanelFixture::headless();
  options.scene_file = file;
  options.save_scene = [&saved, error](const std::string& name, bool overwrite) {
    saved.push_back({name, overwrite});
    return error.empty() ? Result<void>() : Result<void>(Error{error});
  };
  return options;
}

TEST(PanelScene, SavesTheSceneOfAModel) {
  std::vector<SavedScene> saved;
  PanelFixture fixture(kScene, 1600, 900, saving_options("/nowhere/robot.lua", saved, ""));
  fixture.click("scene.save");
  fixture.click("scene.save_write");
  ASSERT_EQ(saved.size(), 1u);
  EXPECT_EQ(saved[0].file, "/nowhere/robot.lua");
  EXPECT_FALSE(saved[0].overwrite);
  EXPECT_FALSE(fixture.is_visible("scene.save_write")) << "the window is closed";
  EXPECT_NE(fixture.gui->context().notice.text.find("/nowhere/robot.lua"), std::string::npos);
}

TEST(PanelScene, SavesWithEnter) {
  std::vector<SavedScene> saved;
  PanelFixture fixture(kScene, 1600, 900, saving_options("/nowhere/robot.lua", saved, ""));
  fixture.click("scene.save");
  fixture.key(GuiKey::enter);
  EXPECT_EQ(saved.size(), 1u);
}

TEST(PanelScene, AsksBeforeItReplacesAFile) {
  std::vector<SavedScene> saved;
  const engine::test::SceneFile existing("-- mine");
  PanelFixture fixture(kScene, 1600, 900, saving_options(existing.path(), saved, ""));
  fixture.click("scene.save");
  fixture.click("scene.save_write");
  EXPECT_TRUE(saved.empty());
  fixture.click("confirmation.cancel");
  EXPECT_TRUE(saved.empty());
  fixture.click("scene.save");
  fixture.click("scene.save_write");
  fixture.click("confirmation.confirm");
  ASSERT_EQ(saved.size(), 1u);
  EXPECT_TRUE(saved[0].overwrite);
}

TEST(PanelScene, KeepsTheWindowOpenIfSavingFails) {
  std::vector<SavedScene> saved;
  PanelFixture fixture(kScene, 1600, 900, saving_options("/nowhere/robot.lua", saved, "no such folder"));
  fixture.click("scene.save");
  fixture.click("scene.save_write");
  EXPECT_TRUE(fixture.is_visible("scene.save_write"));
  fixture.click("scene.save_cancel");
  EXPECT_FALSE(fixture.is_visible("scene.save_write"));
}

TEST(PanelScene, OffersNoSavingWithoutAModel) { EXPECT_FALSE(PanelFixture().is_visible("scene.save")); }

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

// The Lua path of every row is a name that the scene's console knows, and has the value that the address has.
#include "gui/lua_path.h"

#include "gui/rig.h"
#include "params/tree.h"

namespace limber::gui_test {
namespace {

TEST(LuaPath, EachIsKnownToTheConsole) {
  PanelRig rig;
  const Tree& tree = *rig.gui->desk().image->tree;
  std::vector<std::string> paths;
  for (std::uint32_t node = 0; node < tree.nodes().size(); node++) {
    for (const Row& row : tree.nodes()[node].table->rows()) {
      const std::string path = lua_path(tree, {node, &row});
      if (!path.empty() && row.kind != RowKind::action) paths.push_back(path);
    }
  }
  ASSERT_GT(paths.size(), 150u);
  for (const std::string& path : paths) {
    Evaluation said;
    auto wish = std::make_shared<Evaluate>();
    wish->text = path;
    wish->answer = [&](const Evaluation& e) { said = e; };
    rig.show.link.inbox.push({{}, Origin{Hand::console, 0, 0, false}, wish});
    rig.show.engine.idle();
    EXPECT_EQ(said.kind, Evaluation::Kind::value) << path << ": " << said.text;
  }
}

TEST(LuaPath, SaysWhatScriptsSay) {
  PanelRig rig;
  const Tree& tree = *rig.gui->desk().image->tree;
  const auto of = [&](const char* path) { return lua_path(tree, *tree.find(path)); };
  EXPECT_EQ(of("/physics/body/arm/part/tip/mass"), "sim:body(\"arm\"):part(\"tip\").mass");
  EXPECT_EQ(of("/physics/body/leg/behavior/push/amp"), "sim:body(\"leg\"):behavior(\"push\").amp");
  EXPECT_EQ(of("/scene/rate"), "params.rate");
  EXPECT_EQ(of("/visuals/look/exposure"), "visuals.look.exposure");
  EXPECT_EQ(of("/visuals/shape/arm%20ball/transparency"), "visuals:shape(\"arm ball\").transparency");
  EXPECT_EQ(of("/physics/body/arm/reset"), "sim:body(\"arm\"):reset()");
  EXPECT_EQ(of("/osc/received"), "") << "scripts have no such name";
}

}  // namespace
}  // namespace limber::gui_test

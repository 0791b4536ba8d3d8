// The Lua path of every property is valid in the scene's console and has the same value as the OSC address.
#include "ui/panel/lua_path.h"

#include "panel/rig.h"
#include "properties/tree_snapshot.h"

namespace limber::panel::test {
namespace {

TEST(LuaPath, IsValidInTheConsole) {
  PanelFixture fixture;
  const TreeSnapshot& tree = *fixture.gui->context().value_snapshot->tree;
  std::vector<std::string> paths;
  for (std::uint32_t node = 0; node < tree.nodes().size(); node++) {
    for (const Property& property : tree.nodes()[node].table->properties()) {
      const std::string path = lua_path(tree, {node, &property});
      if (!path.empty() && property.kind != PropertyKind::action) paths.push_back(path);
    }
  }
  ASSERT_GT(paths.size(), 150u);
  for (const std::string& path : paths) {
    Evaluation result;
    auto request = std::make_shared<engine::EvaluationRequest>();
    request->text = path;
    request->on_result = [&](const Evaluation& e) { result = e; };
    fixture.show.link.command_queue.push({{}, CommandOrigin{CommandSource::console, 0, 0, false}, request});
    fixture.show.engine.idle();
    EXPECT_EQ(result.kind, Evaluation::Kind::value) << path << ": " << result.text;
  }
}

TEST(LuaPath, MatchesScripts) {
  PanelFixture fixture;
  const TreeSnapshot& tree = *fixture.gui->context().value_snapshot->tree;
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
}  // namespace limber::panel::test

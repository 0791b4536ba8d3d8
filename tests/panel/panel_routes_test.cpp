// Routes: added from the menu of properties and by text, watched, selected, enabled, connected otherwise, removed.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

const std::string kRoute = "/physics/route/shine";
const std::string kRoutedTip = "/physics/body/arm/part/tip/";

const std::string kRouted = std::string(kScene) + R"(
sim:add_route("shine", { from = "/physics/sim/time", to = "/physics/body/arm/part/tip/transparency" })
sim:add_route("lost", { from = "/physics/sim/time", to = "/physics/body/arm/part/top/transparency" })
)";

void type_into(PanelFixture& fixture, const std::string& field, const std::string& text) {
  fixture.click(field);
  fixture.key(GuiKey::a, kCtrl);
  fixture.type(text);
}

TEST(PanelRoutes, AddsARouteByItsAddresses) {
  PanelFixture fixture;
  fixture.click("tab:routes");
  type_into(fixture, "routes.name", "mine");
  type_into(fixture, "routes.from", "/physics/sim/time");
  type_into(fixture, "routes.to", kRoutedTip + "transparency");
  fixture.click("routes.add");
  fixture.show.ticks(30);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/route/mine/links"), 1);
  EXPECT_NEAR(fixture.read(kRoutedTip + "transparency"), 29.0 / 60, 1e-9);
  EXPECT_EQ(fixture.gui->context().selected, "/physics/route/mine");
}

TEST(PanelRoutes, ShowsRoutesOfTheSceneAndTheirProblems) {
  PanelFixture fixture(kRouted);
  fixture.show.ticks(2);
  fixture.click("tab:routes");
  fixture.sync();
  EXPECT_NE(fixture.gui->context().names.find("route:" + kRoute), nullptr);
  EXPECT_NE(fixture.gui->context().names.find("route:/physics/route/lost"), nullptr);
  const auto problem = fixture.gui->context().find("/physics/route/lost/problem");
  ASSERT_TRUE(problem);
  EXPECT_NE(std::string(fixture.gui->context().text(problem->ref)).find("'tip'"), std::string::npos) << "a near name";
}

TEST(PanelRoutes, EnablesSelectsConnectsAndRemoves) {
  PanelFixture fixture(kRouted);
  fixture.click("tab:routes");
  fixture.click(kRoute + "/enabled");
  EXPECT_EQ(fixture.read(kRoute + "/enabled"), 0);
  fixture.click("route:" + kRoute);
  EXPECT_EQ(fixture.gui->context().selected, kRoute);
  type_into(fixture, "routes.to", kRoutedTip + "linear_damping");
  fixture.click("routes.add");
  fixture.click(kRoute + "/enabled");
  fixture.show.ticks(30);
  fixture.sync();
  EXPECT_GT(fixture.read(kRoutedTip + "linear_damping"), 0.4);
  EXPECT_EQ(fixture.read(kRoutedTip + "transparency"), 0);
  fixture.click("remove:" + kRoute);
  fixture.sync();
  EXPECT_FALSE(find_property(fixture.show.engine.store(), kRoute).ok());
}

TEST(PanelRoutes, CopiesTheRoutesAsLua) {
  PanelFixture fixture(std::string(kScene) + R"(
sim:add_route("shine", { from = "/physics/sim/time", to = "/physics/body/arm/part/tip/transparency", input = { 0, 4 },
  curve = "smooth" })
)");
  fixture.click("tab:routes");
  fixture.click("routes.copy");
  const std::string line =
      "sim:add_route(\"shine\", { from = \"/physics/sim/time\", to = "
      "\"/physics/body/arm/part/tip/transparency\", input_high = 4, clamp = true, curve = "
      "\"smooth\" })\n";
  EXPECT_EQ(fixture.clipboard, line);
  PanelFixture pasted(kScene + fixture.clipboard);
  pasted.click("tab:routes");
  pasted.click("routes.copy");
  EXPECT_EQ(pasted.clipboard, line) << "the line makes the same route";
}

TEST(PanelRoutes, TakesBothEndsFromTheMenusOfProperties) {
  PanelFixture fixture;
  PanelRequests& requests = fixture.gui->context().requests;
  fixture.click("tab:routes");
  requests.route_from = "/physics/sim/time";
  fixture.frame();
  requests.route_to = kRoutedTip + "transparency";
  fixture.frame();
  fixture.click("routes.add");
  fixture.show.ticks(2);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/route/route_1/links"), 1);
}

}  // namespace
}  // namespace limber::panel::test

// The widget of each type of property: user input is verified by reading the world.
#include "ui/panel/widgets/property_widget.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "panel/rig.h"
#include "properties/property_table.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel::test {
namespace {

const std::string kTip = "/physics/body/arm/part/tip";

TEST(PropertyWidget, DraggedBarSetsProperty) {
  PanelFixture fixture;
  fixture.drag("/scene/rate", 0.75);
  EXPECT_NEAR(fixture.read("/scene/rate"), 1.5, 0.03) << "three quarters of 0 .. 2";
  fixture.drag("/scene/rate", 3);
  EXPECT_EQ(fixture.read("/scene/rate"), 2) << "beyond its end: the end";
  fixture.drag("/scene/rate", -2);
  EXPECT_EQ(fixture.read("/scene/rate"), 0);
}

// For each class in the scene: a property is found by its address, dragged, read and undone.
TEST(PropertyWidget, EveryBarSetsItsPropertyAndUndoes) {
  PanelFixture fixture;
  std::set<const PropertyTable*> classes;
  std::size_t bars = 0;
  const std::shared_ptr<const TreeSnapshot> tree = fixture.gui->context().value_snapshot->tree;
  // from the end, because the first part is static and has no mass
  for (auto node = static_cast<std::uint32_t>(tree->nodes().size()); --node > 0;) {
    const PropertyTable& table = *tree->nodes()[node].table;
    if (!classes.insert(&table).second) continue;
    for (const Property& property : table.properties()) {
      const bool bar = property.kind == PropertyKind::setting &&
                       (property.type == PropertyType::number || property.type == PropertyType::integer ||
                        property.type == PropertyType::vec3);
      if (!bar) continue;
      const std::string path = tree->path({node, &property});
      SCOPED_TRACE(path);
      fixture.key(GuiKey::f, {true, false, false});
      fixture.key(GuiKey::a, {true, false, false});
      fixture.type(path);
      const std::string name = property.width > 1 ? path + "/0" : path;
      ASSERT_TRUE(fixture.is_visible(name));
      const double before = fixture.read(path);
      const SliderRange range{property.low(0), property.high(0), property.initial[0], property.step,
                              property.type == PropertyType::integer};
      const double to = range.bounded() && range.position_of(before) > 0.6 ? 0.3 : 0.8;
      fixture.drag(name, to);
      EXPECT_NE(fixture.read(path), before) << "the dragged value";
      fixture.key(GuiKey::z, {true, false, false});
      EXPECT_NEAR(fixture.read(path), before, 1e-9 * std::max(1.0, std::abs(before)));
      bars++;
    }
  }
  EXPECT_GE(bars, 60u);
}

TEST(PropertyWidget, SetsOneComponentOfVector) {
  PanelFixture fixture;
  fixture.drag("/physics/sim/gravity/0", 0.6);
  const double x = fixture.read("/physics/sim/gravity", 0);
  EXPECT_NEAR((SliderRange{-10000, 10000, 0, 0, false}).position_of(x), 0.6, 0.04);
  EXPECT_EQ(fixture.read("/physics/sim/gravity", 1), 0);
  EXPECT_EQ(fixture.read("/physics/sim/gravity", 2), -9.81);
}

TEST(PropertyWidget, CtrlClickEditsNumber) {
  PanelFixture fixture;
  fixture.click("/physics/sim/substeps", 0, KeyMods{true, false, false});
  fixture.key(GuiKey::a, {true, false, false});
  fixture.type("7");
  fixture.key(GuiKey::enter);
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 7);
  fixture.click("/physics/sim/substeps", 0, KeyMods{true, false, false});
  fixture.key(GuiKey::a, {true, false, false});
  fixture.type("99999999");
  fixture.key(GuiKey::enter);
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 1000) << "typed values are clamped";
}

TEST(PropertyWidget, SetsBooleansAndChoices) {
  PanelFixture fixture;
  fixture.click("/scene/lit");
  EXPECT_EQ(fixture.read("/scene/lit"), 0);
  fixture.click("/scene/lit");
  EXPECT_EQ(fixture.read("/scene/lit"), 1);
  fixture.click("/scene/mode");
  fixture.click("/scene/mode=fast");
  EXPECT_EQ(fixture.read("/scene/mode"), 1);
  fixture.gui->context().selected = "/physics/body/arm/motor/hinge";
  fixture.frames(2);
  fixture.click("parameters.search");
  fixture.type("arm hinge angular_active");
  fixture.frames(5);
  fixture.click("/physics/body/arm/motor/hinge/angular_active/1");
  EXPECT_EQ(fixture.read("/physics/body/arm/motor/hinge/angular_active", 0), 0);
  EXPECT_EQ(fixture.read("/physics/body/arm/motor/hinge/angular_active", 1), 1);
}

TEST(PropertyWidget, ResetsToDefault) {
  PanelFixture fixture;
  EXPECT_FALSE(fixture.is_visible("reset:/scene/rate")) << "it is the default";
  fixture.drag("/scene/rate", 0.9);
  fixture.click("reset:/scene/rate");
  EXPECT_EQ(fixture.read("/scene/rate"), 0.5);
  EXPECT_FALSE(fixture.is_visible("reset:/scene/rate"));
}

TEST(PropertyWidget, ActionUsesItsFields) {
  PanelFixture fixture;
  fixture.show.send("/physics/body/arm/motor/hinge/mode", "off");
  fixture.click("parameters.search");
  fixture.type("arm tip apply_torque");
  fixture.frames(5);
  const std::string path = kTip + "/apply_torque";
  fixture.click(path + "/1", 0, KeyMods{true, false, false});
  fixture.key(GuiKey::a, {true, false, false});
  fixture.type("2");
  fixture.key(GuiKey::enter);
  fixture.click(path);
  fixture.show.ticks(1);
  EXPECT_GT(fixture.read(kTip + "/angular_velocity", 1), 0.01) << "2 N·m about the hinge";
}

TEST(PropertyWidget, ReleasedModifierHasNoEffect) {
  PanelFixture fixture;
  fixture.click("/physics/sim/substeps", 0, KeyMods{true, false, false});
  fixture.type("8");
  fixture.key(GuiKey::enter);
  fixture.drag("/scene/rate", 0.75);
  EXPECT_NEAR(fixture.read("/scene/rate"), 1.5, 0.03) << "a drag after Ctrl and a click is a drag";
}

TEST(PropertyWidget, RightClickCopies) {
  PanelFixture fixture;
  fixture.click("/scene/rate", 1);
  fixture.click("menu:copy_address");
  EXPECT_EQ(fixture.clipboard, "/scene/rate");
  fixture.click("name:/physics/sim/gravity", 1);
  fixture.click("menu:copy_lua");
  EXPECT_EQ(fixture.clipboard, "sim.gravity");
}

// One widget of each kind: its menu has each entry once, and closes again.
TEST(PropertyWidget, RightClickOpensOneMenu) {
  PanelFixture fixture;
  const std::vector<std::string> all{"menu:copy_address", "menu:copy_lua", "menu:plot", "menu:route_from",
                                     "menu:route_to"};
  const std::vector<std::string> readout{"menu:copy_address", "menu:copy_lua", "menu:plot", "menu:route_from"};
  const std::vector<std::string> unplotted{"menu:copy_address", "menu:copy_lua"};
  struct Item {
    std::string address, widget;
    std::vector<std::string> entries;
  };
  const std::vector<Item> items{
      {"/scene/rate", "name:/scene/rate", all},
      {"/scene/rate", "/scene/rate", all},
      {"/scene/lit", "/scene/lit", all},
      {"/scene/mode", "/scene/mode", all},
      {"/physics/sim/gravity", "/physics/sim/gravity/1", all},
      {"/visuals/background", "swatch:/visuals/background", all},
      {"/visuals/background", "/visuals/background/2", all},
      {"/physics/sim/time", "/physics/sim/time", readout},
      {"/physics/body/arm/part/tip/rotation", "/physics/body/arm/part/tip/rotation/3", all},
      {"/physics/body/arm/remove", "/physics/body/arm/remove", unplotted},
      {"/take/name", "/take/name", {"menu:copy_address"}},
  };
  for (const Item& item : items) {
    SCOPED_TRACE(item.widget);
    fixture.search(item.address);
    fixture.click(item.widget, 1);
    EXPECT_EQ(fixture.names_with("menu:"), item.entries);
    fixture.key(GuiKey::escape);
    EXPECT_TRUE(fixture.names_with("menu:").empty());
  }
}

TEST(PropertyWidget, MenuIsTheSameForFavoritesAndTheTransport) {
  PanelFixture fixture;
  const std::vector<std::string> all{"menu:copy_address", "menu:copy_lua", "menu:plot", "menu:route_from",
                                     "menu:route_to"};
  fixture.click("star:/scene/rate");
  fixture.click("parameters.favorites");
  fixture.click("/scene/rate", 1);
  EXPECT_EQ(fixture.names_with("menu:"), all);
  fixture.key(GuiKey::escape);
  fixture.click("/physics/sim/speed", 1);
  EXPECT_EQ(fixture.names_with("menu:"), all) << "in the top panel";
}

TEST(PropertyWidget, RemovalAsksAndNamesTheBody) {
  PanelFixture fixture;
  fixture.search("/physics/body/arm/remove");
  fixture.click("/physics/body/arm/remove");
  ASSERT_TRUE(fixture.is_visible("confirmation.question"));
  EXPECT_NE(fixture.gui->context().requests.confirmation->question.find("body 'arm'"), std::string::npos)
      << fixture.gui->context().requests.confirmation->question;
  fixture.click("confirmation.cancel");
  EXPECT_FALSE(fixture.is_visible("confirmation.question"));
  EXPECT_EQ(fixture.show.engine.world().bodies().size(), 2u);
  fixture.click("/physics/body/arm/remove");
  fixture.key(GuiKey::escape);
  EXPECT_EQ(fixture.show.engine.world().bodies().size(), 2u);
  fixture.click("/physics/body/arm/remove");
  fixture.click("confirmation.confirm");
  EXPECT_FALSE(fixture.is_visible("confirmation.question"));
  ASSERT_EQ(fixture.show.engine.world().bodies().size(), 1u);
  EXPECT_EQ(fixture.show.engine.world().bodies().front()->name(), "leg");
}

TEST(PropertyWidget, ShowsDraggedValue) {
  PanelFixture fixture;
  const PanelRect at = fixture.rect_of("/scene/rate");
  fixture.move(at.x + at.width / 2, at.y + 4);
  fixture.button(true);
  fixture.move(at.x + at.width, at.y + 4);
  fixture.frames(4);
  fixture.show.send("/scene/rate", 0.25);  // another controller sets it meanwhile
  fixture.show.engine.idle();
  fixture.move(at.x + at.width * 0.5, at.y + 4);
  fixture.frames(2);
  PendingValues::Values values{};
  GuiContext& context = fixture.gui->context();
  ASSERT_TRUE(context.values(*context.find("/scene/rate"), values));
  EXPECT_NEAR(values[0], 1, 0.03);
  fixture.button(false);
  fixture.sync();
  EXPECT_NEAR(fixture.read("/scene/rate"), 1, 0.03) << "the last controller wins";
  fixture.show.send("/scene/rate", 0.25);
  fixture.sync();
  fixture.sync();
  ASSERT_TRUE(context.values(*context.find("/scene/rate"), values));
  EXPECT_EQ(values[0], 0.25) << "not dragged: the world's value is shown";
}

TEST(PropertyWidget, SupportsNewPropertiesWithoutCode) {
  using namespace properties;
  static const PropertyTable table(
      "gadget", "/gadget", "",
      {number("twist", "rad", 0.5, 0, 1, "Never seen before."), boolean("loud", false, "Whether.")});
  PanelFixture fixture;
  const NodeId node = fixture.show.engine.store().add(table, fixture.show.engine.store().root(), "gadget", nullptr);
  fixture.sync();
  fixture.click("parameters.search");
  fixture.type("gadget");
  fixture.frames(5);
  fixture.drag("/gadget/twist", 0.25);
  fixture.click("/gadget/loud");
  EXPECT_NEAR(fixture.show.engine.store().values(node, table.at("twist"))[0], 0.25, 0.02);
  EXPECT_EQ(fixture.show.engine.store().values(node, table.at("loud"))[0], 1);
}

TEST(PropertyWidget, EditsColors) {
  PanelFixture fixture;
  fixture.click("parameters.search");
  fixture.type("visuals/background");
  fixture.frames(5);
  ASSERT_TRUE(fixture.is_visible("swatch:/visuals/background"));
  fixture.drag("/visuals/background/0", 0.25);
  EXPECT_NEAR(fixture.read("/visuals/background", 0), 0.25, 0.03);
  EXPECT_EQ(fixture.read("/visuals/background", 2), 0.06);
  fixture.click("swatch:/visuals/background");
  ASSERT_TRUE(fixture.is_visible("picker:/visuals/background"));
}

TEST(PropertyWidget, WideRangesHaveNonlinearScale) {
  for (const SliderRange& range :
       {SliderRange{0, 2, 0.5, 0, false}, SliderRange{-10000, 10000, 0, 0, false}, SliderRange{0.001, 1e6, 1, 0, false},
        SliderRange{-1e9, 1e9, 1, 0, false}, SliderRange{1, 10000, 50, 0, true}, SliderRange{-1, 3000, 1, 0, false}}) {
    double before = -1e300;
    for (double place = 0.1; place <= 1; place += 0.01) {
      const double value = range.value_at(place);
      EXPECT_GT(value, before) << "it rises";
      EXPECT_NEAR(range.position_of(value), place, 1e-6) << range.min << " .. " << range.max;
      before = value;
    }
    EXPECT_NEAR(range.value_at(0), range.min, std::abs(range.min) * 1e-9);
    EXPECT_NEAR(range.value_at(1), range.max, std::abs(range.max) * 1e-9);
  }
  EXPECT_NEAR((SliderRange{0.001, 1e6, 1, 0, false}).value_at(0.4), 1, 0.01) << "the typical magnitude is at 40 %";
}

}  // namespace
}  // namespace limber::panel::test

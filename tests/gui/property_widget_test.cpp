// Each kind of row as a widget: what a hand does is read back from the world.
#include "gui/property_widget.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "gui/number_bar.h"
#include "gui/rig.h"
#include "params/table.h"

namespace limber::gui_test {
namespace {

const std::string kTip = "/physics/body/arm/part/tip";

TEST(PropertyWidget, ADraggedBarSetsTheWorld) {
  PanelRig rig;
  rig.drag("/scene/rate", 0.75);
  EXPECT_NEAR(rig.read("/scene/rate"), 1.5, 0.03) << "three quarters of 0 .. 2";
  rig.drag("/scene/rate", 3);
  EXPECT_EQ(rig.read("/scene/rate"), 2) << "beyond its end: the end";
  rig.drag("/scene/rate", -2);
  EXPECT_EQ(rig.read("/scene/rate"), 0);
}

// of every class that the scene has: found by its address, dragged, read back, undone
TEST(PropertyWidget, EveryBarSetsItsRowAndUndoTakesItBack) {
  PanelRig rig;
  std::set<const Table*> classes;
  std::size_t bars = 0;
  const std::shared_ptr<const Tree> tree = rig.gui->desk().image->tree;
  // from the end: the first part is static, and has no mass
  for (auto node = static_cast<std::uint32_t>(tree->nodes().size()); --node > 0;) {
    const Table& table = *tree->nodes()[node].table;
    if (!classes.insert(&table).second) continue;
    for (const Row& row : table.rows()) {
      const bool bar = row.kind == RowKind::property &&
                       (row.type == RowType::number || row.type == RowType::integer || row.type == RowType::vec3);
      if (!bar) continue;
      const std::string path = tree->path({node, &row});
      SCOPED_TRACE(path);
      rig.key(GuiKey::f, {true, false, false});
      rig.key(GuiKey::a, {true, false, false});
      rig.type(path);
      const std::string name = row.width > 1 ? path + "/0" : path;
      ASSERT_TRUE(rig.sees(name));
      const double before = rig.read(path);
      const BarRange range{row.low(0), row.high(0), row.initial[0], row.step, row.type == RowType::integer};
      const double to = range.bounded() && range.place_of(before) > 0.6 ? 0.3 : 0.8;
      rig.drag(name, to);
      EXPECT_NE(rig.read(path), before) << "the hand's value";
      rig.key(GuiKey::z, {true, false, false});
      EXPECT_NEAR(rig.read(path), before, 1e-9 * std::max(1.0, std::abs(before)));
      bars++;
    }
  }
  EXPECT_GE(bars, 60u);
}

TEST(PropertyWidget, OneNumberOfThreeIsItsOwn) {
  PanelRig rig;
  rig.drag("/physics/sim/gravity/0", 0.6);
  const double x = rig.read("/physics/sim/gravity", 0);
  EXPECT_NEAR((BarRange{-10000, 10000, 0, 0, false}).place_of(x), 0.6, 0.04);
  EXPECT_EQ(rig.read("/physics/sim/gravity", 1), 0);
  EXPECT_EQ(rig.read("/physics/sim/gravity", 2), -9.81);
}

TEST(PropertyWidget, ANumberIsTypedAfterCtrlAndAClick) {
  PanelRig rig;
  rig.click("/physics/sim/substeps", 0, KeyMods{true, false, false});
  rig.key(GuiKey::a, {true, false, false});
  rig.type("7");
  rig.key(GuiKey::enter);
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 7);
  rig.click("/physics/sim/substeps", 0, KeyMods{true, false, false});
  rig.key(GuiKey::a, {true, false, false});
  rig.type("99999999");
  rig.key(GuiKey::enter);
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 1000) << "what is typed stays within its range";
}

TEST(PropertyWidget, TruthsAndChoices) {
  PanelRig rig;
  rig.click("/scene/lit");
  EXPECT_EQ(rig.read("/scene/lit"), 0);
  rig.click("/scene/lit");
  EXPECT_EQ(rig.read("/scene/lit"), 1);
  rig.click("/scene/mode");
  rig.click("/scene/mode=fast");
  EXPECT_EQ(rig.read("/scene/mode"), 1);
  rig.gui->desk().selected = "/physics/body/arm/motor/hinge";
  rig.frames(2);
  rig.click("parameters.search");
  rig.type("arm hinge angular_active");
  rig.frames(5);
  rig.click("/physics/body/arm/motor/hinge/angular_active/1");
  EXPECT_EQ(rig.read("/physics/body/arm/motor/hinge/angular_active", 0), 0);
  EXPECT_EQ(rig.read("/physics/body/arm/motor/hinge/angular_active", 1), 1);
}

TEST(PropertyWidget, BackToTheDefault) {
  PanelRig rig;
  EXPECT_FALSE(rig.sees("reset:/scene/rate")) << "it is the default";
  rig.drag("/scene/rate", 0.9);
  rig.click("reset:/scene/rate");
  EXPECT_EQ(rig.read("/scene/rate"), 0.5);
  EXPECT_FALSE(rig.sees("reset:/scene/rate"));
}

TEST(PropertyWidget, AnActionTakesWhatItsFieldsSay) {
  PanelRig rig;
  rig.show.send("/physics/body/arm/motor/hinge/mode", "off");
  rig.click("parameters.search");
  rig.type("arm tip apply_torque");
  rig.frames(5);
  const std::string path = kTip + "/apply_torque";
  rig.click(path + "/1", 0, KeyMods{true, false, false});
  rig.key(GuiKey::a, {true, false, false});
  rig.type("2");
  rig.key(GuiKey::enter);
  rig.click(path);
  rig.show.ticks(1);
  EXPECT_GT(rig.read(kTip + "/angular_velocity", 1), 0.01) << "2 N·m about the hinge";
}

TEST(PropertyWidget, AModifierThatIsLetGoOfIsLetGoOf) {
  PanelRig rig;
  rig.click("/physics/sim/substeps", 0, KeyMods{true, false, false});
  rig.type("8");
  rig.key(GuiKey::enter);
  rig.drag("/scene/rate", 0.75);
  EXPECT_NEAR(rig.read("/scene/rate"), 1.5, 0.03) << "a drag after Ctrl and a click is a drag";
}

TEST(PropertyWidget, TheRightClickCopies) {
  PanelRig rig;
  rig.click("/scene/rate", 1);
  rig.click("copy_address");
  EXPECT_EQ(rig.clipboard, "/scene/rate");
  rig.click("name:/physics/sim/gravity", 1);
  rig.click("copy_lua");
  EXPECT_EQ(rig.clipboard, "sim.gravity");
}

TEST(PropertyWidget, WhileAHandHoldsItThePanelShowsTheHand) {
  PanelRig rig;
  const PanelRect at = rig.where("/scene/rate");
  rig.move(at.x + at.width / 2, at.y + 4);
  rig.button(true);
  rig.move(at.x + at.width, at.y + 4);
  rig.frames(4);
  rig.show.send("/scene/rate", 0.25);  // somebody else says otherwise meanwhile
  rig.show.engine.idle();
  rig.move(at.x + at.width * 0.5, at.y + 4);
  rig.frames(2);
  HandValues::Values values{};
  Desk& desk = rig.gui->desk();
  ASSERT_TRUE(desk.values(*desk.find("/scene/rate"), values));
  EXPECT_NEAR(values[0], 1, 0.03);
  rig.button(false);
  rig.heard();
  EXPECT_NEAR(rig.read("/scene/rate"), 1, 0.03) << "the last hand wins";
  rig.show.send("/scene/rate", 0.25);
  rig.heard();
  rig.heard();
  ASSERT_TRUE(desk.values(*desk.find("/scene/rate"), values));
  EXPECT_EQ(values[0], 0.25) << "nobody holds it: the world is shown";
}

TEST(PropertyWidget, ANewRowNeedsNoPanelCode) {
  using namespace rows;
  static const Table table(
      "gadget", "/gadget", "",
      {number("twist", "rad", 0.5, 0, 1, "Never seen before."), boolean("loud", false, "Whether.")});
  PanelRig rig;
  const NodeId node = rig.show.engine.store().add(table, rig.show.engine.store().root(), "gadget", nullptr);
  rig.heard();
  rig.click("parameters.search");
  rig.type("gadget");
  rig.frames(5);
  rig.drag("/gadget/twist", 0.25);
  rig.click("/gadget/loud");
  EXPECT_NEAR(rig.show.engine.store().values(node, table.at("twist"))[0], 0.25, 0.02);
  EXPECT_EQ(rig.show.engine.store().values(node, table.at("loud"))[0], 1);
}

TEST(PropertyWidget, ColoursAreHueSaturationBrightness) {
  PanelRig rig;
  rig.click("parameters.search");
  rig.type("visuals/background");
  rig.frames(5);
  ASSERT_TRUE(rig.sees("swatch:/visuals/background"));
  rig.drag("/visuals/background/0", 0.25);
  EXPECT_NEAR(rig.read("/visuals/background", 0), 0.25, 0.03);
  EXPECT_EQ(rig.read("/visuals/background", 2), 0.06);
  rig.click("swatch:/visuals/background");
  ASSERT_TRUE(rig.sees("picker:/visuals/background"));
}

TEST(PropertyWidget, BarsAreStretchedWhereRangesAreWide) {
  for (const BarRange& range :
       {BarRange{0, 2, 0.5, 0, false}, BarRange{-10000, 10000, 0, 0, false}, BarRange{0.001, 1e6, 1, 0, false},
        BarRange{-1e9, 1e9, 1, 0, false}, BarRange{1, 10000, 50, 0, true}, BarRange{-1, 3000, 1, 0, false}}) {
    double before = -1e300;
    for (double place = 0.1; place <= 1; place += 0.01) {
      const double value = range.value_at(place);
      EXPECT_GT(value, before) << "it rises";
      EXPECT_NEAR(range.place_of(value), place, 1e-6) << range.min << " .. " << range.max;
      before = value;
    }
    EXPECT_NEAR(range.value_at(0), range.min, std::abs(range.min) * 1e-9);
    EXPECT_NEAR(range.value_at(1), range.max, std::abs(range.max) * 1e-9);
  }
  EXPECT_NEAR((BarRange{0.001, 1e6, 1, 0, false}).value_at(0.4), 1, 0.01) << "the usual size has room";
}

}  // namespace
}  // namespace limber::gui_test

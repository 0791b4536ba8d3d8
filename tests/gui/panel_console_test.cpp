// The console: expressions, what they print, completion, history.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

void enter(PanelRig& rig, const std::string& line) {
  rig.click("console.line");
  rig.type(line);
  rig.key(GuiKey::enter);
  rig.heard();
}

TEST(PanelConsole, SetsTheWorld) {
  PanelRig rig;
  enter(rig, "sim.gravity = vec3(1, 2, 3)");
  EXPECT_EQ(rig.read("/physics/sim/gravity", 2), 3);
  enter(rig, "sim.substeps = 9");
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 9) << "the field has the keyboard again";
}

TEST(PanelConsole, TextsOfSeveralLinesWaitForTheirEnd) {
  PanelRig rig;
  enter(rig, "for i = 1, 3 do");
  enter(rig, "sim.substeps = i");
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 4) << "not yet whole";
  enter(rig, "end");
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 3);
}

TEST(PanelConsole, TabCompletes) {
  PanelRig rig;
  rig.click("console.line");
  rig.type("sim.subs");
  rig.key(GuiKey::tab);
  rig.heard();
  rig.frames(3);
  rig.type(" = 6");
  rig.key(GuiKey::enter);
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 6);
}

TEST(PanelConsole, UpBringsTheLastLineBack) {
  PanelRig rig;
  enter(rig, "sim.substeps = sim.substeps + 1");
  rig.click("console.line");
  rig.key(GuiKey::up);
  rig.key(GuiKey::enter);
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/substeps"), 6) << "4 and twice one more";
}

}  // namespace
}  // namespace limber::gui_test

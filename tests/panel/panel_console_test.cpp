// The console: expressions, output, completion, history.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

void enter(PanelFixture& fixture, const std::string& line) {
  fixture.click("console.line");
  fixture.type(line);
  fixture.key(GuiKey::enter);
  fixture.sync();
}

TEST(PanelConsole, EvaluatesInTheScene) {
  PanelFixture fixture;
  enter(fixture, "sim.gravity = vec3(1, 2, 3)");
  EXPECT_EQ(fixture.read("/physics/sim/gravity", 2), 3);
  enter(fixture, "sim.substeps = 9");
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 9) << "the field has the keyboard again";
}

TEST(PanelConsole, SupportsMultilineInput) {
  PanelFixture fixture;
  enter(fixture, "for i = 1, 3 do");
  enter(fixture, "sim.substeps = i");
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 4) << "not yet whole";
  enter(fixture, "end");
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 3);
}

TEST(PanelConsole, TabCompletes) {
  PanelFixture fixture;
  fixture.click("console.line");
  fixture.type("sim.subs");
  fixture.key(GuiKey::tab);
  fixture.sync();
  fixture.frames(3);
  fixture.type(" = 6");
  fixture.key(GuiKey::enter);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 6);
}

TEST(PanelConsole, UpRecallsLastLine) {
  PanelFixture fixture;
  enter(fixture, "sim.substeps = sim.substeps + 1");
  fixture.click("console.line");
  fixture.key(GuiKey::up);
  fixture.key(GuiKey::enter);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/substeps"), 6) << "4 and twice one more";
}

}  // namespace
}  // namespace limber::panel::test

// GuiContext: undo and redo, messages and snapshot requests.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(GuiContext, UndoesWholeDrag) {
  PanelFixture fixture;
  fixture.drag("/scene/rate", 0.75);
  const double first = fixture.read("/scene/rate");
  fixture.drag("/scene/rate", 0.9);
  const double second = fixture.read("/scene/rate");
  fixture.click("/scene/lit");
  fixture.key(GuiKey::z, kCtrl);
  EXPECT_EQ(fixture.read("/scene/lit"), 1);
  EXPECT_EQ(fixture.read("/scene/rate"), second);
  fixture.key(GuiKey::z, kCtrl);
  EXPECT_EQ(fixture.read("/scene/rate"), first) << "the whole drag, whatever it went through";
  fixture.key(GuiKey::z, kCtrl);
  EXPECT_EQ(fixture.read("/scene/rate"), 0.5);
  fixture.key(GuiKey::z, kCtrlShift);
  fixture.key(GuiKey::y, kCtrl);
  EXPECT_EQ(fixture.read("/scene/rate"), second);
  fixture.key(GuiKey::z, kCtrl);
  fixture.drag("/scene/rate", 0.1);
  const double last = fixture.read("/scene/rate");
  fixture.key(GuiKey::y, kCtrl);
  EXPECT_EQ(fixture.read("/scene/rate"), last) << "after a new edit there is nothing to redo";
}

TEST(GuiContext, UndoesEditsOfAnyController) {
  PanelFixture fixture;
  fixture.drag("/scene/rate", 0.75);
  const double dragged = fixture.read("/scene/rate");
  fixture.show.send("/scene/rate", 0.25);
  fixture.show.ticks(40);
  fixture.frames(2);
  ASSERT_EQ(fixture.read("/scene/rate"), 0.25);
  fixture.key(GuiKey::z, kCtrl);
  EXPECT_EQ(fixture.read("/scene/rate"), dragged);
}

TEST(GuiContext, MessagesHaveThePanelAsSource) {
  engine::EngineLink link;
  GuiContext context(link);
  context.send("/transport/play");
  std::vector<engine::Command> commands;
  link.command_queue.drain(commands);
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].origin.source, CommandSource::panel);
  EXPECT_EQ(commands[0].messages.at(0).address, "/transport/play");
}

TEST(GuiContext, LimitsSnapshotRequests) {
  engine::EngineLink link;
  GuiContext context(link);
  for (int i = 0; i < 240; i++) {
    context.begin_frame(i / 240.0);
    const std::shared_ptr<engine::ValueSnapshot> snapshot = link.value_snapshots.acquire_buffer();
    snapshot->request = link.value_snapshot_requests.load();
    link.value_snapshots.publish(snapshot);
  }
  EXPECT_LE(link.value_snapshot_requests.load(), 21u);
  EXPECT_GE(link.value_snapshot_requests.load(), 15u);
}

}  // namespace
}  // namespace limber::panel::test

// Undo and redo of what the panel has set; what a preset key says.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(Desk, UndoesOneDragAtATime) {
  PanelRig rig;
  rig.drag("/scene/rate", 0.75);
  const double first = rig.read("/scene/rate");
  rig.drag("/scene/rate", 0.9);
  const double second = rig.read("/scene/rate");
  rig.click("/scene/lit");
  rig.key(GuiKey::z, kCtrl);
  EXPECT_EQ(rig.read("/scene/lit"), 1);
  EXPECT_EQ(rig.read("/scene/rate"), second);
  rig.key(GuiKey::z, kCtrl);
  EXPECT_EQ(rig.read("/scene/rate"), first) << "the whole drag, whatever it went through";
  rig.key(GuiKey::z, kCtrl);
  EXPECT_EQ(rig.read("/scene/rate"), 0.5);
  rig.key(GuiKey::z, kCtrlShift);
  rig.key(GuiKey::y, kCtrl);
  EXPECT_EQ(rig.read("/scene/rate"), second);
  rig.key(GuiKey::z, kCtrl);
  rig.drag("/scene/rate", 0.1);
  const double last = rig.read("/scene/rate");
  rig.key(GuiKey::y, kCtrl);
  EXPECT_EQ(rig.read("/scene/rate"), last) << "after a new edit there is nothing to redo";
}

TEST(Desk, UndoesWhatAnyHandHasSet) {
  PanelRig rig;
  rig.drag("/scene/rate", 0.75);
  const double dragged = rig.read("/scene/rate");
  rig.show.send("/scene/rate", 0.25);
  rig.show.ticks(40);
  rig.frames(2);
  ASSERT_EQ(rig.read("/scene/rate"), 0.25);
  rig.key(GuiKey::z, kCtrl);
  EXPECT_EQ(rig.read("/scene/rate"), dragged);
}

TEST(Desk, MessagesAreThePanelsHand) {
  EngineLink link;
  Desk desk(link);
  desk.send("/transport/play");
  std::vector<Command> commands;
  link.inbox.drain(commands);
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].origin.hand, Hand::panel);
  EXPECT_EQ(commands[0].messages.at(0).address, "/transport/play");
}

TEST(Desk, ImagesAreAskedForTwentyTimesASecondAtMost) {
  EngineLink link;
  Desk desk(link);
  for (int i = 0; i < 240; i++) {
    desk.look(i / 240.0);
    const std::shared_ptr<Image> image = link.images.spare();
    image->asks = link.image_asks.load();
    link.images.publish(image);
  }
  EXPECT_LE(link.image_asks.load(), 21u);
  EXPECT_GE(link.image_asks.load(), 15u);
}

}  // namespace
}  // namespace limber::gui_test

// Events: a press and a release within one frame are two frames; a press is where the mouse was.
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(Input, PressesShorterThanAFrameAreNotLost) {
  PanelRig rig;
  ASSERT_FALSE(rig.show.engine.world().store().values(rig.show.engine.world().id(), World::table().at("paused"))[0] !=
               0);
  for (int i = 1; i <= 5; i++) {
    // down and up before the panel looks
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = GuiKey::space;
    event.down = true;
    rig.push(event);
    event.down = false;
    rig.push(event);
    rig.heard();
    EXPECT_EQ(rig.read("/physics/sim/paused"), i % 2);
  }
  const PanelRect play = rig.where("transport.play");
  rig.move(play.x + 4, play.y + 4);
  rig.button(true);
  rig.button(false);
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/paused"), 0) << "and a click";
}

TEST(Input, TwoPressesInOneFrameAreTwo) {
  PanelRig rig;
  const double tick = rig.read("/physics/sim/tick");
  for (int i = 0; i < 3; i++) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = GuiKey::f2;
    event.down = true;
    rig.push(event);
    event.down = false;
    rig.push(event);
  }
  rig.heard();
  EXPECT_TRUE(rig.gui->desk().help) << "three times: on, off, on";
  EXPECT_EQ(rig.read("/physics/sim/tick"), tick);
}

TEST(Input, APressIsWhereTheMouseWasThen) {
  PanelRig rig;
  const PanelRect step = rig.where("transport.step");
  const PanelRect play = rig.where("transport.play");
  rig.move(play.x + 4, play.y + 4);
  rig.button(true);
  rig.button(false);
  rig.move(step.x + 4, step.y + 4);  // all of it before the panel looks
  rig.heard();
  EXPECT_EQ(rig.read("/physics/sim/paused"), 1);
}

TEST(Input, ADragWithinAFrameGoesToItsEnd) {
  PanelRig rig;
  const PanelRect bar = rig.where("/scene/rate");
  rig.move(bar.x + bar.width / 2, bar.y + 5);
  rig.button(true);
  rig.move(bar.x + bar.width + 50, bar.y + 5);
  rig.button(false);
  rig.heard();
  EXPECT_EQ(rig.read("/scene/rate"), 2);
}

TEST(Input, LettersComeAsFastAsSomebodyTypes) {
  PanelRig rig;
  rig.click("parameters.search");
  for (const char letter : std::string("rate")) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = static_cast<GuiKey>(static_cast<int>(GuiKey::a) + letter - 'a');
    event.down = true;
    rig.push(event);
    InputEvent text;
    text.kind = InputEvent::Kind::text;
    text.letter = static_cast<std::uint32_t>(letter);
    rig.push(text);
    event.down = false;
    rig.push(event);
  }
  rig.frame();
  EXPECT_FALSE(rig.gui->has_events()) << "a word is one frame";
  rig.frames(4);
  EXPECT_TRUE(rig.sees("/scene/rate"));
}

TEST(Input, AFloodOfEventsIsBounded) {
  InputQueue queue;
  InputEvent event;
  event.kind = InputEvent::Kind::key;
  event.key = GuiKey::f1;
  for (int i = 0; i < 100000; i++) queue.push(event);
  PanelRig rig;
  int frames = 0;
  while (!queue.empty() && frames < 100000) {
    (void)queue.frame();
    frames++;
  }
  EXPECT_LE(frames, static_cast<int>(InputQueue::kMost));
}

}  // namespace
}  // namespace limber::gui_test

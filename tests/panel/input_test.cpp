// Input events: a press and a release within one frame take two frames; a press acts at the position that the mouse
// had.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(Input, KeepsPressesShorterThanAFrame) {
  PanelFixture fixture;
  ASSERT_FALSE(fixture.show.engine.world().store().values(fixture.show.engine.world().id(),
                                                          sim::World::table().at("paused"))[0] != 0);
  for (int i = 1; i <= 5; i++) {
    // press and release before the next frame
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = GuiKey::space;
    event.down = true;
    fixture.push(event);
    event.down = false;
    fixture.push(event);
    fixture.sync();
    EXPECT_EQ(fixture.read("/physics/sim/paused"), i % 2);
  }
  const PanelRect play = fixture.rect_of("transport.play");
  fixture.move(play.x + 4, play.y + 4);
  fixture.button(true);
  fixture.button(false);
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 0) << "and a click";
}

TEST(Input, SeparatesTwoPressesInOneFrame) {
  PanelFixture fixture;
  const double tick = fixture.read("/physics/sim/tick");
  for (int i = 0; i < 3; i++) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = GuiKey::f2;
    event.down = true;
    fixture.push(event);
    event.down = false;
    fixture.push(event);
  }
  fixture.sync();
  EXPECT_TRUE(fixture.gui->context().show_help) << "three times: on, off, on";
  EXPECT_EQ(fixture.read("/physics/sim/tick"), tick);
}

TEST(Input, PressUsesPositionOfItsTime) {
  PanelFixture fixture;
  const PanelRect step = fixture.rect_of("transport.step");
  const PanelRect play = fixture.rect_of("transport.play");
  fixture.move(play.x + 4, play.y + 4);
  fixture.button(true);
  fixture.button(false);
  fixture.move(step.x + 4, step.y + 4);  // all events before the next frame
  fixture.sync();
  EXPECT_EQ(fixture.read("/physics/sim/paused"), 1);
}

TEST(Input, DragWithinAFrameReachesItsEnd) {
  PanelFixture fixture;
  const PanelRect bar = fixture.rect_of("/scene/rate");
  fixture.move(bar.x + bar.width / 2, bar.y + 5);
  fixture.button(true);
  fixture.move(bar.x + bar.width + 50, bar.y + 5);
  fixture.button(false);
  fixture.sync();
  EXPECT_EQ(fixture.read("/scene/rate"), 2);
}

TEST(Input, DeliversFastTyping) {
  PanelFixture fixture;
  fixture.click("parameters.search");
  for (const char letter : std::string("rate")) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = static_cast<GuiKey>(static_cast<int>(GuiKey::a) + letter - 'a');
    event.down = true;
    fixture.push(event);
    InputEvent text;
    text.kind = InputEvent::Kind::text;
    text.character = static_cast<std::uint32_t>(letter);
    fixture.push(text);
    event.down = false;
    fixture.push(event);
  }
  fixture.frame();
  EXPECT_FALSE(fixture.gui->has_events()) << "a word is one frame";
  fixture.frames(4);
  EXPECT_TRUE(fixture.is_visible("/scene/rate"));
}

TEST(Input, LimitsQueuedEvents) {
  InputQueue queue;
  InputEvent event;
  event.kind = InputEvent::Kind::key;
  event.key = GuiKey::f1;
  for (int i = 0; i < 100000; i++) queue.push(event);
  PanelFixture fixture;
  int frames = 0;
  while (!queue.empty() && frames < 100000) {
    (void)queue.next_frame();
    frames++;
  }
  EXPECT_LE(frames, static_cast<int>(InputQueue::kMaxEvents));
}

}  // namespace
}  // namespace limber::panel::test

// The time row: recording and replaying takes, rejected messages.
#include <filesystem>
#include <vector>

#include "engine/takes/reader.h"
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

std::vector<std::string> saved_takes(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "takes", none))
    files.push_back(entry.path().string());
  return files;
}

TEST(PanelTime, RecordsTake) {
  PanelFixture fixture;
  fixture.show.ticks(30);
  EXPECT_FALSE(fixture.is_visible("take.text"));
  fixture.key(GuiKey::r, kCtrl);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 0) << "from the scene's start";
  fixture.show.ticks(45);
  fixture.sync();
  EXPECT_TRUE(fixture.is_visible("take.text"));
  EXPECT_EQ(fixture.gui->context().take_state().name.substr(0, 6), "scene-");
  EXPECT_NEAR(fixture.gui->context().take_state().seconds, 0.75, 1e-9);
  fixture.click("transport.record");
  fixture.sync();
  EXPECT_FALSE(fixture.is_visible("take.text"));
  EXPECT_NE(fixture.gui->context().notice.text.find("recorded: 00:00.75"), std::string::npos)
      << fixture.gui->context().notice.text;
  fixture.show.engine.finish_saving();
  const std::vector<std::string> files = saved_takes(fixture.folder());
  ASSERT_EQ(files.size(), 1u);
  auto reader = engine::TakeReader::open(files[0]);
  ASSERT_TRUE(reader) << reader.error();
  EXPECT_EQ((*reader)->count_ticks(), 45u);
}

TEST(PanelTime, IgnoresCtrlRInTextField) {
  PanelFixture fixture;
  fixture.show.ticks(30);
  fixture.click("parameters.search");
  fixture.key(GuiKey::r, kCtrl);
  EXPECT_EQ(fixture.read("/physics/sim/tick"), 30) << "Ctrl+R in a text field must not restart the scene";
  EXPECT_TRUE(fixture.gui->context().take_state().name.empty());
}

TEST(PanelTime, ShowsRejectedMessage) {
  PanelFixture fixture;
  EXPECT_FALSE(fixture.is_visible("rejection"));
  fixture.click("transport.step_back");
  ASSERT_TRUE(fixture.is_visible("rejection"));
  EXPECT_EQ(fixture.gui->context().rejection.text.find("/transport/step: can't rewind"), 0u)
      << fixture.gui->context().rejection.text;
  fixture.click("rejection");
  EXPECT_EQ(fixture.clipboard, fixture.gui->context().rejection.text);
  fixture.frames(9 * 60);
  EXPECT_FALSE(fixture.is_visible("rejection"));
}

TEST(PanelTime, HidesRejectedMessagesOfOthers) {
  PanelFixture fixture;
  fixture.show.send("/transport/step", -1.0);
  fixture.sync();
  EXPECT_FALSE(fixture.is_visible("rejection"));
}

TEST(PanelTime, ShowsReplayPosition) {
  const engine::test::SceneFile scene(kScene);
  engine::EngineOptions options = engine::test::fast_options(scene.path());
  options.record = scene.path() + ".take";
  {
    engine::test::Show show(options);
    show.ticks(300);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  engine::EngineOptions replay = engine::test::fast_options();
  replay.replay = options.record;
  PanelFixture fixture(replay);
  fixture.key(GuiKey::space);
  const TakeState take = fixture.gui->context().take_state();
  EXPECT_EQ(take.name, "scene.lua");
  EXPECT_TRUE(take.replaying);
  EXPECT_NEAR(take.duration, 5, 1e-9);
  EXPECT_GT(take.seconds, 0);
  EXPECT_LT(take.seconds, 5);
  EXPECT_NEAR(take.seconds, fixture.gui->context().value_snapshot->snapshot->time, 1e-9);
  EXPECT_TRUE(fixture.is_visible("take.line"));
  EXPECT_FALSE(fixture.is_visible("transport.history")) << "there is no way back in a replay";
  EXPECT_NE(fixture.gui->context().rejection.text.find("a take is being replayed"), std::string::npos)
      << fixture.gui->context().rejection.text;
  EXPECT_TRUE(fixture.is_visible("rejection"));
}

TEST(PanelTime, PlaysLatestTake) {
  PanelFixture fixture;
  std::vector<std::string> asked;
  fixture.show.link.on_scene_request = [&](const Message& message, const CommandOrigin&) {
    asked.push_back(message.address);
  };
  fixture.click("take.play");
  EXPECT_TRUE(asked.empty()) << "the user is asked before";
  fixture.click("confirmation.cancel");
  EXPECT_TRUE(asked.empty());
  fixture.click("take.play");
  fixture.click("confirmation.confirm");
  EXPECT_EQ(asked, (std::vector<std::string>{"/take/play"}));
  fixture.key(GuiKey::r, kCtrlShift);
  ASSERT_TRUE(fixture.is_visible("confirmation.question")) << "also with the key";
  fixture.key(GuiKey::space);
  EXPECT_EQ(asked.size(), 1u) << "only Enter confirms";
  fixture.key(GuiKey::enter);
  EXPECT_EQ(asked.size(), 2u);
  EXPECT_FALSE(fixture.is_visible("confirmation.question"));
  fixture.key(GuiKey::f1);
  fixture.key(GuiKey::r, kCtrlShift);
  EXPECT_TRUE(fixture.is_visible("confirmation.question")) << "while the panel is hidden";
  fixture.key(GuiKey::escape);
  fixture.key(GuiKey::f1);
  EXPECT_EQ(asked.size(), 2u);
  fixture.key(GuiKey::space);
  fixture.click("transport.record");
  fixture.show.ticks(40);
  fixture.sync();
  fixture.click("take.play");
  EXPECT_FALSE(fixture.is_visible("confirmation.question")) << "only one take at a time";
  fixture.click("transport.record");
  fixture.show.engine.finish_saving();
  ASSERT_EQ(saved_takes(fixture.folder()).size(), 1u);
  ASSERT_TRUE(engine::test::play_take(fixture.show, saved_takes(fixture.folder())[0]).ok());
  fixture.sync();
  EXPECT_TRUE(fixture.gui->context().take_state().in_show);
  fixture.click("take.stop");
  fixture.sync();
  EXPECT_FALSE(fixture.gui->context().take_state().in_show);
  EXPECT_NE(fixture.gui->context().notice.text.find("has ended; live control resumes"), std::string::npos)
      << fixture.gui->context().notice.text;
}

}  // namespace
}  // namespace limber::panel::test

// The row of time: takes that are recorded and replayed, why a message was refused.
#include <filesystem>
#include <vector>

#include "engine/take_reader.h"
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

std::vector<std::string> takes_in(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "takes", none))
    files.push_back(entry.path().string());
  return files;
}

TEST(PanelTime, AKeyRecordsATakeAndTheButtonEndsIt) {
  PanelRig rig;
  rig.show.ticks(30);
  EXPECT_FALSE(rig.sees("take.text"));
  rig.key(GuiKey::r, kCtrl);
  EXPECT_EQ(rig.read("/physics/sim/tick"), 0) << "from the scene's start";
  rig.show.ticks(45);
  rig.heard();
  EXPECT_TRUE(rig.sees("take.text"));
  EXPECT_EQ(rig.gui->desk().take().name.substr(0, 6), "scene-");
  EXPECT_NEAR(rig.gui->desk().take().seconds, 0.75, 1e-9);
  rig.click("transport.record");
  rig.heard();
  EXPECT_FALSE(rig.sees("take.text"));
  EXPECT_NE(rig.gui->desk().notice.find("has ended: 00:00.75"), std::string::npos) << rig.gui->desk().notice;
  rig.show.engine.finish_saving();
  const std::vector<std::string> files = takes_in(rig.folder());
  ASSERT_EQ(files.size(), 1u);
  auto reader = TakeReader::open(files[0]);
  ASSERT_TRUE(reader) << reader.error();
  EXPECT_EQ((*reader)->count_ticks(), 45u);
}

TEST(PanelTime, CtrlRIsNoMessageWhereOneTypes) {
  PanelRig rig;
  rig.show.ticks(30);
  rig.click("parameters.search");
  rig.key(GuiKey::r, kCtrl);
  EXPECT_EQ(rig.read("/physics/sim/tick"), 30) << "in a shell it searches; nobody's show begins anew for that";
  EXPECT_TRUE(rig.gui->desk().take().name.empty());
}

TEST(PanelTime, ARefusedMessageIsShownForAWhile) {
  PanelRig rig;
  EXPECT_FALSE(rig.sees("refusal"));
  rig.click("transport.step_back");
  ASSERT_TRUE(rig.sees("refusal"));
  EXPECT_EQ(rig.gui->desk().refusal.find("/transport/step: time can't go back"), 0u) << rig.gui->desk().refusal;
  rig.click("refusal");
  EXPECT_EQ(rig.clipboard, rig.gui->desk().refusal);
  rig.frames(9 * 60);
  EXPECT_FALSE(rig.sees("refusal"));
}

TEST(PanelTime, WhatOthersSentIsNotShownAsThePanelsRefusal) {
  PanelRig rig;
  rig.show.send("/transport/step", -1.0);
  rig.heard();
  EXPECT_FALSE(rig.sees("refusal"));
}

TEST(PanelTime, AReplayShowsWhereItIsAndThatHandsAreRefused) {
  const engine_test::SceneFile scene(kScene);
  EngineOptions options = engine_test::fast_options(scene.path());
  options.record = scene.path() + ".take";
  {
    engine_test::Show show(options);
    show.ticks(300);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  EngineOptions replay = engine_test::fast_options();
  replay.replay = options.record;
  PanelRig rig(replay);
  rig.key(GuiKey::space);
  const TakeState take = rig.gui->desk().take();
  EXPECT_EQ(take.name, "scene.lua");
  EXPECT_TRUE(take.replays);
  EXPECT_NEAR(take.whole, 5, 1e-9);
  EXPECT_GT(take.seconds, 0);
  EXPECT_LT(take.seconds, 5);
  EXPECT_NEAR(take.seconds, rig.gui->desk().image->snapshot->time, 1e-9);
  EXPECT_TRUE(rig.sees("take.line"));
  EXPECT_FALSE(rig.sees("transport.past")) << "there is no way back in a replay";
  EXPECT_NE(rig.gui->desk().refusal.find("a take is replayed"), std::string::npos) << rig.gui->desk().refusal;
  EXPECT_TRUE(rig.sees("refusal"));
}

TEST(PanelTime, TheNewestTakePlaysByAButtonAndAKey) {
  PanelRig rig;
  std::vector<std::string> asked;
  rig.show.link.ask_scenes = [&](const Message& wish, const Origin&) { asked.push_back(wish.address); };
  rig.click("take.play");
  EXPECT_EQ(asked, (std::vector<std::string>{"/take/play"}));
  rig.key(GuiKey::r, kCtrlShift);
  EXPECT_EQ(asked.size(), 2u);
  rig.click("transport.record");
  rig.show.ticks(40);
  rig.heard();
  EXPECT_FALSE(rig.sees("take.play")) << "one take at a time";
  rig.click("transport.record");
  rig.show.engine.finish_saving();
  ASSERT_EQ(takes_in(rig.folder()).size(), 1u);
  ASSERT_TRUE(engine_test::begin_take(rig.show, takes_in(rig.folder())[0]).ok());
  rig.heard();
  EXPECT_TRUE(rig.gui->desk().take().plays);
  rig.click("take.stop");
  rig.heard();
  EXPECT_FALSE(rig.gui->desk().take().plays);
  EXPECT_TRUE(rig.sees("take.play"));
  EXPECT_NE(rig.gui->desk().notice.find("is over: the show is yours"), std::string::npos) << rig.gui->desk().notice;
}

}  // namespace
}  // namespace limber::gui_test

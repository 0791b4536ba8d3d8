// Cues: order, follow times, pause, jumps, reloads, takes and rewinds.
#include "engine/cue_show.h"

namespace limber::engine::test {
namespace {

TEST_F(CueShow, GoStartsTheCuesInOrder) {
  Show show(options());
  EXPECT_EQ(current(show), 0);
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 1);
  EXPECT_EQ(show.read("/scene/wind"), 1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 0);
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 2);
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 3);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -2);
  show.sent_texts();
  send(show, "/cue/go");
  EXPECT_TRUE(sent(show, "/error /cue/go the last cue has run"));
  EXPECT_EQ(current(show), 3);
}

TEST_F(CueShow, ACueMorphsToItsPreset) {
  Show show(options());
  send(show, "/cue/jump", "storm");
  const double at_start = show.read("/scene/wind");
  show.ticks(20);
  // linear from 0 to 4 in one second: 4/60 in each tick
  EXPECT_NEAR(show.read("/scene/wind") - at_start, 20 * 4.0 / 60, 1e-9);
}

TEST_F(CueShow, MessagesOverrideThePreset) {
  write(R"({"limber cues": 1, "cues": [{"name": "both", "preset": "filed", "messages": [["/scene/wind", 2]]}]})");
  Show show(options());
  send(show, "/cue/go");
  EXPECT_EQ(show.read("/scene/wind"), 2);
}

TEST_F(CueShow, FollowCountsTicks) {
  Show show(options());
  send(show, "/cue/jump", 2);
  show.ticks(29);
  EXPECT_EQ(current(show), 2);
  EXPECT_NEAR(show.read("/cue/follow"), 0, 1e-9) << "half a second has passed";
  show.ticks(1);
  EXPECT_EQ(current(show), 3) << "in the tick half a second after that of the cue";
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -2);
}

TEST_F(CueShow, PauseStopsTheFollowTime) {
  Show show(options());
  send(show, "/cue/jump", 2);
  show.ticks(9);
  send(show, "/cue/pause");
  EXPECT_EQ(show.read("/cue/paused"), 1);
  EXPECT_NEAR(show.read("/cue/follow"), 20.0 / 60, 1e-9);
  show.ticks(100);
  EXPECT_EQ(current(show), 2);
  send(show, "/cue/pause", 1);
  EXPECT_EQ(show.read("/cue/paused"), 1) << "a value sets it";
  send(show, "/cue/pause");
  show.ticks(19);
  EXPECT_EQ(current(show), 2);
  show.ticks(1);
  EXPECT_EQ(current(show), 3);
}

// Each step is requested and made in one pass.
TEST_F(CueShow, FollowCountsTheTicksOfLockstep) {
  EngineOptions lockstep = options();
  lockstep.fast = false;
  lockstep.lockstep = true;
  Show show(lockstep);
  show.send("/cue/jump", 2);
  for (int i = 0; i < 30; i++) send(show, "/transport/step", 1);
  EXPECT_EQ(current(show), 2);
  send(show, "/transport/step", 1);
  EXPECT_EQ(current(show), 3);
}

TEST_F(CueShow, GoResumes) {
  Show show(options());
  send(show, "/cue/go");
  send(show, "/cue/pause");
  send(show, "/cue/go");
  EXPECT_EQ(show.read("/cue/paused"), 0);
  show.ticks(30);
  EXPECT_EQ(current(show), 3);
}

TEST_F(CueShow, PausedTimeAndAPanicDelayTheNextCue) {
  Show show(options());
  send(show, "/cue/jump", 2);
  send(show, "/transport/pause");
  show.ticks(100);
  send(show, "/transport/play");
  EXPECT_EQ(current(show), 2);
  send(show, "/transport/panic");
  show.ticks(100);
  EXPECT_EQ(current(show), 2);
  send(show, "/transport/panic_end");
  EXPECT_EQ(current(show), 2);
  show.ticks(30);
  EXPECT_EQ(current(show), 3);
}

TEST_F(CueShow, JumpsAndGoesBack) {
  Show show(options());
  send(show, "/cue/back");
  EXPECT_TRUE(sent(show, "/error /cue/back there is no cue before this one"));
  send(show, "/cue/jump", "end");
  EXPECT_EQ(current(show), 3);
  send(show, "/cue/back");
  EXPECT_EQ(current(show), 2);
  send(show, "/cue/back");
  EXPECT_EQ(current(show), 1);
  send(show, "/cue/jump", 3);
  EXPECT_EQ(current(show), 3);
  show.sent_texts();
  send(show, "/cue/jump", "strom");
  EXPECT_TRUE(sent(show, "there is no cue 'strom'; did you mean 'storm'?"));
  send(show, "/cue/jump", 4);
  EXPECT_TRUE(sent(show, "the number of a cue must be 1 to 3, got 4"));
  EXPECT_EQ(current(show), 3);
  send(show, "/list/cues");
  EXPECT_TRUE(sent(show, "/list/cues calm storm end"));
}

TEST_F(CueShow, ACueDoesNotControlTheCueList) {
  write(R"({"limber cues": 1, "cues": [{"name": "a", "messages": [["/c*e/go"]]}, {"name": "b"}]})");
  Show show(options());
  const std::uint64_t before = log_newest();
  send(show, "/cue/go");
  EXPECT_TRUE(logged(before, "cue: /c*e/go: a cue can't control the cue list"));
  show.ticks(3);
  EXPECT_EQ(current(show), 1);
}

TEST_F(CueShow, ATakeReplaysWithoutTheFiles) {
  EngineOptions recorded = options();
  recorded.record = folder.path("now.take");
  std::uint64_t hash = 0;
  {
    Show show(recorded);
    send(show, "/route/add", "number", "/cue/follow", "/physics/body/ball/part/p/linear_damping");
    for (int i = 0; i < 120; i++) {
      if (i == 10 || i == 20) show.send("/cue/go");
      if (i == 30) show.send("/cue/pause");
      if (i == 40) show.send("/cue/pause");
      if (i == 100) show.send("/cue/jump", "calm");
      show.ticks(1);
    }
    EXPECT_EQ(current(show), 1);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -2) << "the last cue started by itself";
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
  }
  write(R"({"limber cues": 1, "cues": [{"name": "calm", "messages": [["/physics/sim/gravity", 0, 0, 9]]}]})");
  expect_replay(recorded.record, hash);
  folder.remove("scripts/scene.cues.json");
  folder.remove("scripts/scene.presets.json");
  expect_replay(recorded.record, hash);
}

// The cues continue where they were, in the take as well; a route makes a difference visible in the hash.
TEST_F(CueShow, ATakeThatBeginsLaterContinuesTheCues) {
  Show show(options());
  send(show, "/route/add", "number", "/cue/current", "/physics/body/ball/part/p/linear_damping");
  send(show, "/cue/go");
  send(show, "/take/record", "later");
  EXPECT_EQ(current(show), 1);
  show.ticks(10);
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 2);
  show.ticks(40);
  EXPECT_EQ(current(show), 3);
  const std::uint64_t hash = show.engine.state_hash();
  show.engine.end_take();
  show.engine.finish_saving();
  expect_replay(folder.path("takes/later.take"), hash);
}

TEST_F(CueShow, ARewindRestoresTheCues) {
  Show show(options());
  show.ticks(5);
  send(show, "/cue/jump", 2);
  show.ticks(40);
  EXPECT_EQ(current(show), 3);
  const std::uint64_t tick = show.engine.world().tick();
  const std::uint64_t hash = show.engine.state_hash();
  send(show, "/transport/step", -20);
  EXPECT_EQ(current(show), 2);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 0);
  send(show, "/transport/play");
  while (show.engine.world().tick() < tick) show.ticks(1);
  EXPECT_EQ(current(show), 3);
  EXPECT_EQ(show.engine.state_hash(), hash) << "it started by itself in the same tick again";
}

TEST_F(CueShow, UndoRevertsACueInOneStep) {
  write(R"({"limber cues": 1, "cues": [
    {"name": "two", "messages": [["/scene/wind", 2], ["/physics/sim/gravity", 0, 0, -3]]}]})");
  Show show(options());
  send(show, "/scene/wind", 1);
  show.ticks(100);
  send(show, "/cue/go");
  show.ticks(100);
  send(show, "/edit/undo");
  EXPECT_EQ(show.read("/scene/wind"), 1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 0);
}

TEST_F(CueShow, WrongMessagesAreLoggedAndTheOthersSent) {
  write(R"({"limber cues": 1, "cues": [{"name": "a", "preset": "none",
    "messages": [["/scene/wnd", 1], ["/physics/sim/gravity", "down"], ["/scene/wind", 3]]}]})");
  Show show(options());
  const std::uint64_t before = log_newest();
  send(show, "/cue/go");
  EXPECT_TRUE(logged(before, "cue: /preset/recall: there is no preset 'none'"));
  EXPECT_TRUE(logged(before, "cue: /scene/wnd: "));
  EXPECT_TRUE(logged(before, "cue: /physics/sim/gravity: "));
  EXPECT_EQ(show.read("/scene/wind"), 3);
}

TEST_F(CueShow, AResetKeepsTheCue) {
  Show show(options());
  send(show, "/cue/go");
  send(show, "/transport/reset");
  show.ticks(1);
  EXPECT_EQ(current(show), 1);
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 2);
}

TEST_F(CueShow, ASavedFileIsReadAgain) {
  Show show(options());
  send(show, "/cue/jump", "storm");
  send(show, "/cue/pause");
  write(R"({"limber cues": 1, "cues": [{"name": "new"}, {"name": "calm"}, {"name": "storm"}, {"name": "last"}]})");
  run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.reload_cues()); });
  EXPECT_EQ(current(show), 3) << "the number of the same cue in the new list";
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 4);
  show.sent_texts();
  write(R"({"limber cues": 1, "cues": [{"name": "new", "easing": "quick"}]})");
  run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.reload_cues()); });
  EXPECT_TRUE(sent(show, "cue 1 'new': easing: unknown easing 'quick'"));
  send(show, "/list/cues");
  EXPECT_TRUE(sent(show, "/list/cues new calm storm last")) << "the cues stay";
}

TEST_F(CueShow, AnotherSceneHasItsOwnCues) {
  folder.write("scripts/other.lua", kCueScene);
  folder.write("scripts/other.cues.json", R"({"limber cues": 1, "cues": [{"name": "hello"}]})");
  Show show(options());
  send(show, "/cue/go");
  run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.change_scene(folder.path("scripts/other.lua")).ok()); });
  EXPECT_EQ(current(show), 0);
  show.sent_texts();
  send(show, "/list/cues");
  EXPECT_TRUE(sent(show, "/list/cues hello"));
}

TEST_F(CueShow, TheOptionNamesAFileForAllScenes) {
  folder.write("scripts/other.lua", kCueScene);
  folder.write("tour.cues.json", R"({"limber cues": 1, "cues": [{"name": "one"}, {"name": "two"}]})");
  EngineOptions with_file = options();
  with_file.files.cues = folder.path("tour.cues.json");
  Show show(with_file);
  EXPECT_EQ(show.engine.cue_file(), with_file.files.cues);
  send(show, "/cue/go");
  run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.change_scene(folder.path("scripts/other.lua")).ok()); });
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 2);
}

TEST_F(CueShow, AFileOfTheOptionMustBeValid) {
  EngineLink link;
  EngineOptions missing = options();
  missing.files.cues = folder.path("none.cues.json");
  Engine engine(link, missing);
  const Result<void> started = engine.start();
  ASSERT_FALSE(started.ok());
  EXPECT_TRUE(started.error().starts_with(fmt::format("--cues {}: ", missing.files.cues))) << started.error();
}

TEST_F(CueShow, AShowStartsWithoutOrWithABadFile) {
  folder.remove("scripts/scene.cues.json");
  {
    Show show(options());
    send(show, "/cue/go");
    EXPECT_TRUE(sent(show, "there are no cues; write them to "));
  }
  write("{");
  log_to_stderr(false);
  Show show(options());
  write(kCues);
  run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.reload_cues()); });
  send(show, "/cue/go");
  EXPECT_EQ(current(show), 1);
}

}  // namespace
}  // namespace limber::engine::test

// Cues: order, follow times, pause, jumps, reloads, takes and rewinds.
#include "engine/taken.h"

#include <algorithm>

namespace limber::engine::test {
namespace {

// The wind pushes the ball; handlers show in which order messages arrive.
constexpr const char* kCueScene = R"(
params { { "wind", 0, min = 0, max = 10 } }
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.1)
sim:add_body("ball"):add_part("p", ball, { mass = 1 })
local function part() return sim:body("ball").parts[1] end
sim:on_step(function() part():apply_force(vec3(params.wind, 0, 0)) end)
state.order = 1
osc:on("/cue/go", function() state.order = state.order * 2; part():apply_impulse(vec3(0, state.order, 0)) end)
osc:on("/note", function(x) state.order = state.order + x; part():apply_impulse(vec3(0, 0, state.order)) end)
)";
constexpr const char* kCues = R"({
  "limber cues": 1,
  "cues": [
    { "name": "calm", "messages": [["/scene/wind", 1], ["/note", 3]] },
    { "name": "storm", "preset": "filed", "time": 1, "easing": "linear", "follow": 0.5 },
    { "name": "end", "messages": [["/physics/sim/gravity", 0, 0, -2]], "note": "the lights go out" }
  ]
})";

struct CueShow : testing::Test {
  CueShow() {
    folder.write("scripts/scene.lua", kCueScene);
    folder.write("scripts/scene.presets.json", preset_file_text("/scene", "\"wind\": 4"));
    write(kCues);
  }
  void write(const std::string& cues) const { folder.write("scripts/scene.cues.json", cues); }
  EngineOptions options() const { return fast_options(folder.path("scripts/scene.lua")); }
  /// Sends a message, and executes it in a tick.
  template <class... A>
  static void send(Show& show, std::string address, A&&... args) {
    show.send(std::move(address), std::forward<A>(args)...);
    show.ticks(1);
  }
  static double current(Show& show) { return show.read("/cue/current"); }
  static bool sent(Show& show, const std::string& text) {
    const std::vector<std::string> texts = show.sent_texts();
    return std::ranges::any_of(texts, [&](const std::string& line) { return line.find(text) != line.npos; });
  }

  static bool logged(std::uint64_t since, const std::string& text) {
    return std::ranges::any_of(log_since(since),
                               [&](const LogLine& line) { return line.text.find(text) != line.text.npos; });
  }

  ShowFolder folder;
};

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

// At 120 beats per minute, a beat has 30 ticks and a bar of three beats 90.
struct BeatCueShow : CueShow {
  BeatCueShow() {
    write(R"({"limber cues": 1, "cues": [
      {"name": "one", "follow": 0.5}, {"name": "two", "at": "beat", "messages": [["/scene/wind", 2]]},
      {"name": "three", "at": "bar"}, {"name": "four"}]})");
  }
  static void tick_until_next_cue(Show& show, double cue) {
    for (int i = 0; i < 500 && current(show) != cue; i++) show.ticks(1);
    EXPECT_EQ(current(show), cue);
  }
};

TEST_F(BeatCueShow, CuesWaitForTheBeatAndTheBar) {
  Show show(options());
  send(show, "/clock/beats_per_bar", 3);
  show.ticks(4);
  send(show, "/cue/jump", "two");
  EXPECT_EQ(current(show), 0);
  EXPECT_EQ(show.read("/cue/waiting"), 2);
  tick_until_next_cue(show, 2);
  EXPECT_EQ(show.engine.world().tick(), 31u) << "in the tick after beat 1 was reached";
  EXPECT_EQ(show.read("/scene/wind"), 2);
  EXPECT_EQ(show.read("/cue/waiting"), 0);
  send(show, "/cue/go");
  tick_until_next_cue(show, 3);
  EXPECT_EQ(show.engine.world().tick(), 91u);
}

TEST_F(BeatCueShow, TheSecondGoDoesNotWait) {
  Show show(options());
  show.ticks(3);
  send(show, "/cue/jump", 3);
  EXPECT_EQ(current(show), 0);
  send(show, "/cue/jump", 3);
  EXPECT_EQ(current(show), 3);
  send(show, "/clock/playing", 0);
  send(show, "/cue/jump", 2);
  show.ticks(100);
  EXPECT_EQ(show.read("/cue/waiting"), 2) << "a clock that stands still has no beats";
  send(show, "/cue/jump", 4);
  EXPECT_EQ(show.read("/cue/waiting"), 0) << "another cue replaces it";
}

// A cue that starts by itself waits for its beat as well, a rewind and a take reproduce it.
TEST_F(BeatCueShow, FollowsOnTheBeat) {
  EngineOptions recorded = options();
  recorded.record = folder.path("beat.take");
  std::uint64_t hash = 0;
  {
    Show show(recorded);
    send(show, "/route/add", "number", "/cue/waiting", "/physics/body/ball/part/p/linear_damping");
    show.ticks(10);
    send(show, "/cue/go");
    EXPECT_EQ(current(show), 1);
    tick_until_next_cue(show, 2);
    EXPECT_EQ(show.engine.world().tick(), 61u) << "30 ticks after the first cue, then at the next beat";
    const std::uint64_t tick = show.engine.world().tick();
    const std::uint64_t there = show.engine.state_hash();
    send(show, "/transport/step", -10);
    EXPECT_EQ(show.read("/cue/waiting"), 2);
    send(show, "/transport/play");
    while (show.engine.world().tick() < tick) show.ticks(1);
    EXPECT_EQ(show.engine.state_hash(), there);
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
  }
  folder.remove("scripts/scene.cues.json");
  expect_replay(recorded.record, hash);
}

TEST_F(CueShow, TheFirstCueBeginsByItself) {
  write(
      R"({"limber cues": 1, "cues": [{"name": "a", "begin": 0.5, "messages": [["/scene/wind", 2]]}, {"name": "b"}]})");
  EngineOptions recorded = options();
  recorded.record = folder.path("begin.take");
  std::uint64_t hash = 0;
  {
    Show show(recorded);
    show.ticks(30);
    EXPECT_EQ(current(show), 0);
    show.ticks(1);
    EXPECT_EQ(current(show), 1);
    EXPECT_EQ(show.read("/scene/wind"), 2);
    show.ticks(100);
    EXPECT_EQ(current(show), 1) << "only once";
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
  }
  folder.remove("scripts/scene.cues.json");
  expect_replay(recorded.record, hash);
}

TEST_F(CueShow, AMessageStartsTheCueThatWaitsForIt) {
  write(R"({"limber cues": 1, "cues": [
    {"name": "a", "when": "/drum"}, {"name": "b", "when": "/scene/wind"}, {"name": "c"}]})");
  Show show(options());
  send(show, "/scene/wind", 1);
  EXPECT_EQ(current(show), 0) << "it is not the next one";
  send(show, "/drum", 0);
  EXPECT_EQ(current(show), 0) << "a button was released";
  show.sent_texts();
  send(show, "/drum", 1);
  EXPECT_EQ(current(show), 1);
  EXPECT_FALSE(sent(show, "/error"));
  send(show, "/drum", 1);
  EXPECT_EQ(current(show), 1);
  EXPECT_TRUE(sent(show, "/error /drum")) << "no cue waits for it";
  send(show, "/scene/wind", 5);
  EXPECT_EQ(current(show), 2);
  EXPECT_EQ(show.read("/scene/wind"), 5) << "it has its usual effect";
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

TEST_F(CueShow, EditsChangeTheFileAndTheList) {
  Show show(options());
  send(show, "/cue/go");
  const auto edit = [&](const char* address, std::vector<Arg> args) {
    Result<void> done;
    run_while_ticking(show, [&] { done = show.engine.edit_cues({address, std::move(args)}); });
    return done ? "" : done.error();
  };
  EXPECT_EQ(edit("/cue/add", {Arg::of("lift"), Arg::of("filed")}), "");
  show.sent_texts();
  send(show, "/list/cues");
  EXPECT_TRUE(sent(show, "/list/cues calm lift storm end"));
  EXPECT_NE(folder.read("scripts/scene.cues.json").find("{ \"name\": \"lift\", \"preset\": \"filed\" }"),
            std::string::npos);
  const std::string before = folder.read("scripts/scene.cues.json");
  EXPECT_NE(edit("/cue/set", {Arg::of("lift"), Arg::of("time"), Arg::of(-1.0)}).find("time: must be a number"),
            std::string::npos);
  EXPECT_EQ(folder.read("scripts/scene.cues.json"), before);
  write("{");
  EXPECT_NE(edit("/cue/remove", {Arg::of("lift")}).find("not valid JSON"), std::string::npos);
  EXPECT_EQ(folder.read("scripts/scene.cues.json"), "{") << "a file with an error is not replaced";
  send(show, "/list/cues");
  EXPECT_TRUE(sent(show, "/list/cues calm lift storm end"));
}

TEST_F(CueShow, EditsDoNotWriteThroughALink) {
  folder.write("other/real.cues.json", kCues);
  folder.remove("scripts/scene.cues.json");
  std::filesystem::create_symlink(folder.path("other/real.cues.json"), folder.path("scripts/scene.cues.json"));
  Show show(options());
  run_while_ticking(show, [&] {
    const Result<void> done = show.engine.edit_cues({"/cue/remove", {Arg::of(1.0)}});
    ASSERT_FALSE(done.ok());
    EXPECT_NE(done.error().find("is a link to another folder"), std::string::npos) << done.error();
  });
  EXPECT_EQ(folder.read("other/real.cues.json"), kCues);
}

}  // namespace
}  // namespace limber::engine::test

// Cues that start at beats, by messages and by themselves; edits of the list.
#include "engine/cue_show.h"

namespace limber::engine::test {
namespace {

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

TEST_F(BeatCueShow, TheWaitingCueStaysTheSameInAnEditedList) {
  Show show(options());
  show.ticks(3);
  send(show, "/clock/playing", 0);
  send(show, "/cue/jump", "two");
  EXPECT_EQ(show.read("/cue/waiting"), 2);
  const auto edit = [&](const char* address, const char* cue) {
    run_while_ticking(show, [&] { EXPECT_TRUE(show.engine.edit_cues({address, {Arg::of(cue)}}).ok()); });
    show.ticks(1);
  };
  edit("/cue/add", "zero");
  EXPECT_EQ(show.read("/cue/waiting"), 3) << "a cue was added before it";
  edit("/cue/remove", "two");
  EXPECT_EQ(show.read("/cue/waiting"), 0);
  send(show, "/clock/playing", 1);
  show.ticks(100);
  EXPECT_EQ(current(show), 0) << "no other cue takes its place";
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

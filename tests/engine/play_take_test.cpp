// Playback of a take in a running session: it is bit-exact, and the session continues from its end.
#include "engine/taken.h"

#include <algorithm>

namespace limber::engine::test {
namespace {

constexpr const char* kLiveScene = R"(
sim:add_sphere_shape("ball", 0.1)
sim:add_body("mine"):add_part("ball", "ball", { mass = 1, position = vec3(0, 0, 5) })
)";

/// A take of a session with random inputs, and another scene for the session that plays it.
struct PlayTake : testing::Test {
  PlayTake() { write_take_scene(folder); }
  std::uint64_t record(int ticks, std::uint64_t seed) { return record_take(folder, take, ticks, seed); }

  ShowFolder folder;
  std::string take = folder.path("long.take");
  SceneFile live_scene{kLiveScene};
};

// Runs the remaining ticks of the take.
void play_to_end(Show& show) {
  while (show.read("/take/ticks") < show.read("/take/whole")) show.ticks(1);
}

bool received(Show& show, const std::string& start) {
  const std::vector<std::string> lines = show.sent_texts();
  return std::ranges::any_of(lines, [&](const std::string& line) { return line.starts_with(start); });
}

std::string evaluate_reply(Show& show, const std::string& text) {
  auto request = std::make_shared<EvaluationRequest>();
  std::string reply;
  request->text = text;
  request->on_result = [&](const Evaluation& result) { reply = result.text; };
  show.link.command_queue.push({{}, {CommandSource::console}, std::move(request)});
  show.engine.idle();
  return reply;
}

bool has_preset(const Show& show, const std::string& preset) {
  return std::ranges::any_of(show.engine.presets().list(), [&](const auto& p) { return p->name == preset; });
}

TEST_F(PlayTake, IsExactInsideAnotherSession) {
  const std::uint64_t hash = record(120, 5);
  Show show(live_scene.path());
  show.send("/physics/sim/gravity", 0.0, 0.0, -3.0);
  show.send("/transport/speed", 0.5);
  show.ticks(20);
  ASSERT_TRUE(play_take(show, take).ok());
  EXPECT_EQ(show.read("/take/plays"), 1);
  play_to_end(show);
  EXPECT_EQ(show.engine.state_hash(), hash);
  const double whole = show.read("/take/whole");
  show.sent_texts();
  show.ticks(1);
  EXPECT_TRUE(received(show, fmt::format("/take/played long {} -1", whole)));
  EXPECT_EQ(show.read("/take/plays"), 0);
}

TEST_F(PlayTake, LiveInputResumesAtItsEnd) {
  record(60, 6);
  Show show(live_scene.path());
  ASSERT_TRUE(play_take(show, take).ok());
  play_to_end(show);
  const double tick = show.read("/physics/sim/tick");
  show.send("/physics/body/ball2/part/p/linear_damping", 0.25);
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/body/ball2/part/p/linear_damping"), 0.25);
  EXPECT_EQ(show.read("/physics/sim/tick"), tick + 3) << "no tick is skipped or repeated";
  const std::string reply = evaluate_reply(show, "while true do end");
  EXPECT_NE(reply.find(fmt::format("stopped after {:g} ms", script::ScriptLimits().call_ms)), std::string::npos)
      << "scripts have the limits of a live session again: " << reply;
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read("/physics/body/ball2/part/p/linear_damping"), 0.25) << "it survives a reset like other overrides";
}

TEST_F(PlayTake, StopResumesLiveInputAtOnce) {
  record(60, 7);
  Show show(live_scene.path());
  ASSERT_TRUE(play_take(show, take).ok());
  show.ticks(5);
  show.sent_texts();
  show.send("/physics/motor/angular_spring_stiffness", "arm1", 3.0);
  show.ticks(1);
  EXPECT_TRUE(received(show, "/error /physics/motor/angular_spring_stiffness a take plays"));
  EXPECT_EQ(evaluate_reply(show, "1 + 1").find("a take plays"), 0u);
  show.send("/get", "/take/plays");
  show.ticks(1);
  EXPECT_TRUE(received(show, "/take/plays 1"));
  show.send("/take/stop");
  show.ticks(1);
  EXPECT_TRUE(received(show, "/take/stopped"));
  EXPECT_EQ(show.read("/take/plays"), 0);
  show.send("/physics/motor/angular_spring_stiffness", "arm1", 3.0);
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/body/arm1/motor/joint_1/angular_spring_stiffness", 2), 3);
  EXPECT_EQ(evaluate_reply(show, "1 + 1"), "2");
}

TEST_F(PlayTake, AnInvalidTakeChangesNothing) {
  record(60, 8);
  folder.write("cut.take", file_bytes(take).substr(0, 400));
  folder.write("other.take", "not a take\n");
  Show undisturbed(live_scene.path());
  Show show(live_scene.path());
  for (const char* name : {"cut.take", "other.take", "missing.take"}) {
    const Result<void> played = play_take(show, folder.path(name));
    ASSERT_FALSE(played.ok()) << name;
    EXPECT_NE(played.error().find(name), std::string::npos) << played.error();
  }
  show.send("/take/record", "mine");
  show.ticks(1);
  EXPECT_EQ(play_take(show, take).error(), "a take is being recorded; /take/stop ends it");
  show.send("/take/stop");
  show.send("/transport/reset");
  show.ticks(21);
  undisturbed.ticks(20);
  EXPECT_EQ(show.engine.state_hash(), undisturbed.engine.state_hash());
}

TEST_F(PlayTake, RestoresThePresetsOfTheSession) {
  {
    EngineOptions options = take_options(folder);
    options.record = folder.path("p.take");
    Show show(options);
    show.ticks(5);
    show.send("/preset/store", "of the take");
    show.ticks(20);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  Show show(folder.path("scripts/scene.lua"));
  show.send("/preset/delete", "of the take");
  show.send("/preset/store", "mine");
  show.ticks(1);
  ASSERT_TRUE(play_take(show, folder.path("p.take")).ok());
  show.ticks(10);
  EXPECT_TRUE(has_preset(show, "of the take"));
  EXPECT_FALSE(has_preset(show, "mine"));
  play_to_end(show);
  show.ticks(1);
  EXPECT_FALSE(has_preset(show, "of the take"));
  EXPECT_TRUE(has_preset(show, "mine"));
  show.send("/preset/store", "later");
  show.ticks(1);
  show.engine.finish_saving();
  const std::string file = file_bytes(folder.path("scripts/scene.presets.json"));
  EXPECT_EQ(file.find("of the take"), file.npos);
  EXPECT_NE(file.find("\"later\""), file.npos) << "they are saved again";
}

TEST_F(PlayTake, RejectsReloadsUntilItEnds) {
  record(300, 9);
  Show show(live_scene.path());
  ASSERT_TRUE(play_take(show, take).ok());
  bool tried = true;
  run_while_ticking(show, [&] { tried = show.engine.reload(); });
  EXPECT_FALSE(tried);
  Result<void> changed;
  run_while_ticking(show, [&] { changed = show.engine.change_scene(live_scene.path()); });
  EXPECT_EQ(changed.error(), "a take plays; /take/stop ends it");
  show.send("/take/stop");
  show.ticks(1);
  run_while_ticking(show, [&] { tried = show.engine.reload(); });
  EXPECT_TRUE(tried);
  run_while_ticking(show, [&] { changed = show.engine.change_scene(live_scene.path()); });
  ASSERT_TRUE(changed.ok()) << changed.error();
  EXPECT_TRUE(find_property(show.engine.store(), "/physics/body/mine").ok());
}

}  // namespace
}  // namespace limber::engine::test

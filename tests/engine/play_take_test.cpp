// A take that plays in the place of a show: it comes to the bit, and then the show goes on from there.
#include "engine/taken.h"

#include <algorithm>

namespace limber::engine_test {
namespace {

constexpr const char* kLive = R"(
sim:add_sphere_shape("ball", 0.1)
sim:add_body("mine"):add_part("ball", "ball", { mass = 1, position = vec3(0, 0, 5) })
)";

/// A take of a wild show, and another show that may play it.
struct PlayTake : testing::Test {
  PlayTake() { lay_out(folder); }
  std::uint64_t record(int ticks, std::uint64_t seed) { return record_take(folder, take, ticks, seed); }

  ShowFolder folder;
  std::string take = folder.path("long.take");
  SceneFile live{kLive};
};

// the ticks that the take still has
void to_its_end(Show& show) {
  while (show.read("/take/ticks") < show.read("/take/whole")) show.ticks(1);
}

bool heard(Show& show, const std::string& start) {
  const std::vector<std::string> lines = show.outbox();
  return std::ranges::any_of(lines, [&](const std::string& line) { return line.starts_with(start); });
}

std::string answer_to(Show& show, const std::string& text) {
  auto wish = std::make_shared<Evaluate>();
  std::string answer;
  wish->text = text;
  wish->answer = [&](const Evaluation& said) { answer = said.text; };
  show.link.inbox.push({{}, {Hand::console}, std::move(wish)});
  show.engine.idle();
  return answer;
}

bool has(const Show& show, const std::string& preset) {
  return std::ranges::any_of(show.engine.presets().list(), [&](const auto& p) { return p->name == preset; });
}

TEST_F(PlayTake, ComesToTheBitInTheMiddleOfAnotherShow) {
  const std::uint64_t hash = record(120, 5);
  Show show(live.path());
  show.send("/physics/sim/gravity", 0.0, 0.0, -3.0);
  show.send("/transport/speed", 0.5);
  show.ticks(20);
  ASSERT_TRUE(begin_take(show, take).ok());
  EXPECT_EQ(show.read("/take/plays"), 1);
  to_its_end(show);
  EXPECT_EQ(show.engine.state_hash(), hash);
  const double whole = show.read("/take/whole");
  show.outbox();
  show.ticks(1);
  EXPECT_TRUE(heard(show, fmt::format("/take/played long {} -1", whole)));
  EXPECT_EQ(show.read("/take/plays"), 0);
}

TEST_F(PlayTake, TheShowGoesOnFromItsEndByHand) {
  record(60, 6);
  Show show(live.path());
  ASSERT_TRUE(begin_take(show, take).ok());
  to_its_end(show);
  const double tick = show.read("/physics/sim/tick");
  show.send("/physics/body/ball2/part/p/linear_damping", 0.25);
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/body/ball2/part/p/linear_damping"), 0.25);
  EXPECT_EQ(show.read("/physics/sim/tick"), tick + 3) << "no tick is lost, none comes twice";
  const std::string said = answer_to(show, "while true do end");
  EXPECT_NE(said.find(fmt::format("stopped after {:g} ms", ScriptLimits().call_ms)), std::string::npos)
      << "scripts have a live show's limits again: " << said;
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read("/physics/body/ball2/part/p/linear_damping"), 0.25)
      << "it is the show's, with what hands have set";
}

TEST_F(PlayTake, StopBringsTheHandsBackAtOnce) {
  record(60, 7);
  Show show(live.path());
  ASSERT_TRUE(begin_take(show, take).ok());
  show.ticks(5);
  show.outbox();
  show.send("/physics/motor/angular_spring_stiffness", "arm1", 3.0);
  show.ticks(1);
  EXPECT_TRUE(heard(show, "/error /physics/motor/angular_spring_stiffness a take plays"));
  EXPECT_EQ(answer_to(show, "1 + 1").find("a take plays"), 0u);
  show.send("/get", "/take/plays");
  show.ticks(1);
  EXPECT_TRUE(heard(show, "/take/plays 1"));
  show.send("/take/stop");
  show.ticks(1);
  EXPECT_TRUE(heard(show, "/take/stopped"));
  EXPECT_EQ(show.read("/take/plays"), 0);
  show.send("/physics/motor/angular_spring_stiffness", "arm1", 3.0);
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/body/arm1/motor/joint_1/angular_spring_stiffness", 2), 3);
  EXPECT_EQ(answer_to(show, "1 + 1"), "2");
}

TEST_F(PlayTake, OneThatIsBadLeavesTheShowAsItIs) {
  record(60, 8);
  folder.write("cut.take", take_bytes(take).substr(0, 400));
  folder.write("other.take", "not a take\n");
  Show undisturbed(live.path());
  Show show(live.path());
  for (const char* name : {"cut.take", "other.take", "missing.take"}) {
    const Result<void> played = begin_take(show, folder.path(name));
    ASSERT_FALSE(played.ok()) << name;
    EXPECT_NE(played.error().find(name), std::string::npos) << played.error();
  }
  show.send("/take/record", "mine");
  show.ticks(1);
  EXPECT_EQ(begin_take(show, take).error(), "a take is being recorded; /take/stop ends it");
  show.send("/take/stop");
  show.send("/transport/reset");
  show.ticks(21);
  undisturbed.ticks(20);
  EXPECT_EQ(show.engine.state_hash(), undisturbed.engine.state_hash());
}

TEST_F(PlayTake, ThePresetsOfTheShowAreBackAndTheirFileIsAsItWas) {
  {
    EngineOptions options = taken_options(folder);
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
  ASSERT_TRUE(begin_take(show, folder.path("p.take")).ok());
  show.ticks(10);
  EXPECT_TRUE(has(show, "of the take"));
  EXPECT_FALSE(has(show, "mine"));
  to_its_end(show);
  show.ticks(1);
  EXPECT_FALSE(has(show, "of the take"));
  EXPECT_TRUE(has(show, "mine"));
  show.send("/preset/store", "later");
  show.ticks(1);
  show.engine.finish_saving();
  const std::string file = take_bytes(folder.path("scripts/scene.presets.json"));
  EXPECT_EQ(file.find("of the take"), file.npos);
  EXPECT_NE(file.find("\"later\""), file.npos) << "they are saved again";
}

TEST_F(PlayTake, AReloadWaitsUntilItIsOver) {
  record(300, 9);
  Show show(live.path());
  ASSERT_TRUE(begin_take(show, take).ok());
  bool tried = true;
  beside(show, [&] { tried = show.engine.reload(); });
  EXPECT_FALSE(tried);
  Result<void> changed;
  beside(show, [&] { changed = show.engine.change_scene(live.path()); });
  EXPECT_EQ(changed.error(), "a take plays; /take/stop ends it");
  show.send("/take/stop");
  show.ticks(1);
  beside(show, [&] { tried = show.engine.reload(); });
  EXPECT_TRUE(tried);
  beside(show, [&] { changed = show.engine.change_scene(live.path()); });
  ASSERT_TRUE(changed.ok()) << changed.error();
  EXPECT_TRUE(find_place(show.engine.store(), "/physics/body/mine").ok());
}

}  // namespace
}  // namespace limber::engine_test

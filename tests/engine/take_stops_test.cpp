// Stopped script calls in takes and rewinds: they are not executed again, and every replay terminates.
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

// trap() loops forever when it is called for the first time: a stopped call leaves `hits` at 1
constexpr const char* kTrap = R"(
sim.timestep = 0.02
local ball = sim:add_body("ball"):add_part("p", sim:add_sphere_shape("s", 0.1), { position = vec3(0, 0, 9) })
local hits = 0
osc:on("/push", function(x) ball:apply_impulse(vec3(x, rng:uniform(0, 0.1), 0)) end)
function trap()
  hits = hits + 1
  ball:apply_impulse(vec3(0, hits, 0))
  while hits == 1 do end
end
)";

struct TrapFixture {
  ShowFolder folder;
  EngineOptions options;

  TrapFixture() {
    log_to_stderr(false);
    folder.write("scripts/scene.lua", kTrap);
    options = fast_options(folder.path("scripts/scene.lua"));
    options.scene_options.limits.call_ms = 5 * script::kBudgetScale;
    options.scene_options.limits.replay_ms = 20 * script::kBudgetScale;
    options.record = folder.path("takes/trap.take");
    std::filesystem::create_directories(folder.path("takes"));
  }
  std::uint64_t end(Show& show) const {
    show.engine.end_take();
    const std::uint64_t hash = show.engine.state_hash();
    show.engine.finish_saving();
    return hash;
  }
};

TEST(TakeStops, AStoppedCallStaysStoppedWhenAReplayRewinds) {
  TrapFixture trapped;
  std::uint64_t hash = 0;
  {
    Show show(trapped.options);
    show.ticks(60);
    evaluate(show, "while true do end");
    show.ticks(5);
    // in the tick of a rewind, before and after the rewind
    evaluate(show, "while true do end");
    show.send("/transport/rewind_ticks", 8);
    show.send("/push", 1);
    evaluate(show, "while true do end");
    show.send("/push", 1);
    show.ticks(3);
    show.send("/transport/rewind_ticks", 6);
    show.ticks(10);
    hash = trapped.end(show);
  }
  expect_replay(trapped.options.record, hash);
}

TEST(TakeStops, ARewindEndsEvenIfARepeatedCallDoesNot) {
  TrapFixture trapped;
  Show show(trapped.options);
  show.ticks(60);
  evaluate(show, "trap()");
  show.ticks(3);
  evaluate(show, "trap()");
  show.ticks(3);
  const std::uint64_t seen = log_newest();
  show.send("/transport/rewind_ticks", 1);
  show.engine.idle();
  EXPECT_EQ(show.engine.world().tick(), 64u) << "in tick 63 the second call is the first";
  bool reported = false;
  for (const LogLine& line : log_since(seen)) reported = reported || line.text.find("rewind: a script") == 0;
  EXPECT_TRUE(reported);
  show.ticks(5);
  EXPECT_EQ(show.engine.world().tick(), 69u);
}

// Changes of Lua variables by a stopped call are not in the take: the second call of trap() is the first in the replay.
TEST(TakeStops, PlaybackWithDifferentCallsEnds) {
  TrapFixture trapped;
  {
    Show show(trapped.options);
    show.ticks(10);
    evaluate(show, "trap()");
    show.ticks(3);
    evaluate(show, "trap()");
    show.ticks(200);
    (void)trapped.end(show);
  }
  EngineOptions options = trapped.options;
  options.record.clear();
  options.fast = false;
  Show show(options);
  ASSERT_TRUE(play_take(show, trapped.options.record).ok());
  for (int i = 0; i < 100 && show.read("/take/plays") != 0; i++) show.ticks(1);
  EXPECT_EQ(show.read("/take/plays"), 0) << "it ends where the replay diverges";
  show.send("/push", 1);
  show.ticks(1);
  EXPECT_TRUE(show.engine.is_replaying() == false);
}

}  // namespace
}  // namespace limber::engine::test

// Sleep in a show: commands wake bodies in the same tick, a rewind restores sleeping bodies and rest times, and a take
// replays to the same result.
#include <gtest/gtest.h>

#include "engine/rewound.h"
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

// Two stacks, a hinged beam and a moving ball; a behavior that pushes only when it is switched on.
constexpr const char* kSleepers = R"(
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("p", sim:add_plane_shape("ground"))
local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
for i = 1, 4 do
  local body = sim:add_body("box" .. i)
  body:add_part("p", box, { position = vec3(i % 2, 0, 0.101 + 0.2 * math.floor((i - 1) / 2)) })
end
sim:body("box1"):add_behavior("force", "wind", { amp = 0 })
local beam = sim:add_body("beam")
local base = beam:add_part("base", box, { mass = 0, position = vec3(5, 0, 1) })
local arm = beam:add_part("arm", box, { position = vec3(5.5, 0, 1) })
beam:add_motor(beam:add_joint("hinge", base, arm, { position = vec3(5, 0, 1), axis = vec3(0, 1, 0) }))
local ball = sim:add_body("ball"):add_part("p", sim:add_sphere_shape("ball", 0.1), { position = vec3(-4, 0, 0.1) })
sim:at(3, function() ball.linear_velocity = vec3(6, 0, 0) end)
sim:on_step(function() arm:apply_force(vec3(0, 0, 0)) end)
)";

struct WakingMessage {
  const char* name;
  void (*send)(Show& show);
};

struct SleepMessage : testing::TestWithParam<WakingMessage> {};

TEST_P(SleepMessage, WakesInTheSameTick) {
  const SceneFile scene(kSleepers);
  Show show(scene.path());
  show.send("/preset/store", "before");
  show.ticks(1);
  show.send("/physics/part/friction", "box4", "p", 0.4);
  show.ticks(149);
  ASSERT_EQ(show.read("/physics/sim/sleeping_parts"), 6);
  GetParam().send(show);
  show.ticks(1);
  EXPECT_LT(show.read("/physics/sim/sleeping_parts"), 6);
}

const WakingMessage kMessages[] = {
    {"hold", [](Show& show) { show.send("/physics/part/hold", "box1", "p", 0, 0, 0, 1, 0, 1); }},
    {"target", [](Show& show) { show.send("/physics/motor/target", "beam", 0.1); }},
    {"preset", [](Show& show) { show.send("/preset/recall", "before"); }},
    {"morph",
     [](Show& show) {
       show.send("/preset/recall", "before", 0.5);
       show.ticks(1);  // start from the current values
     }},
    {"undo", [](Show& show) { show.send("/edit/undo"); }},
    {"behavior", [](Show& show) { show.send("/physics/behavior/parameter", "wind", "amp", 0.1); }},
    {"enabled", [](Show& show) { show.send("/physics/body/box1/enabled", 0); }},
    {"remove", [](Show& show) { show.send("/physics/body/box2/remove"); }},
    {"reset", [](Show& show) { show.send("/transport/reset"); }},
    {"panic", [](Show& show) { show.send("/transport/panic"); }},
};

INSTANTIATE_TEST_SUITE_P(Each, SleepMessage, testing::ValuesIn(kMessages),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SleepInAShow, IsRepeatedExactlyAfterARewind) {
  const SceneFile scene(kSleepers);
  std::vector<std::uint64_t> hashes;
  const auto inputs = [](Show& show, std::uint64_t tick) {
    if (tick == 250) show.send("/physics/motor/target", "beam", 0.2);
  };
  {
    Show reference(scene.path());
    play_to(reference, 400, inputs, hashes);
  }
  Show show(scene.path());
  ASSERT_TRUE(replays_identically(show, 170, inputs, hashes));
  EXPECT_EQ(show.read("/physics/sim/sleeping_parts"), 6);
  // rewinds to before they slept, and to where they slept, from after the impact of the ball
  const std::pair<double, std::uint64_t> returns[] = {{1.5, 300}, {3, 230}, {1, 400}, {2, 400}};
  for (const auto& [seconds, to] : returns) {
    show.send("/transport/rewind", seconds);
    show.engine.idle();
    ASSERT_EQ(show.engine.state_hash(), hashes[show.engine.world().tick()]);
    ASSERT_TRUE(replays_identically(show, to, inputs, hashes));
  }
}

TEST(SleepInAShow, IsTheSameForAnyNumberOfThreads) {
  const SceneFile scene(kSleepers);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    EngineOptions options = fast_options(scene.path());
    options.threads = threads;
    Show show(options);
    if (threads == 1) {
      play_to(show, 300, no_inputs, hashes);
    } else {
      EXPECT_TRUE(replays_identically(show, 300, no_inputs, hashes));
    }
  }
}

}  // namespace
}  // namespace limber::engine::test

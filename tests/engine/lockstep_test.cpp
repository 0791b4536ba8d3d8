// --lockstep: time advances only by /transport/step, and messages act in their order.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "show.h"

namespace limber::engine::test {
namespace {

using Lines = std::vector<std::string>;

constexpr const char* kScene = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
sim:add_body("ball"):add_part("ball", ball, { position = { 0, 0, 100 } })
sim.paused = false
sim:on_step(function() osc:send("/tick", sim.tick, sim.gravity.z) end)
osc:on("/told", function(x) osc:send("/heard", x, sim.tick) end)
)";

EngineOptions lockstep_options(const std::string& scene) {
  EngineOptions options;
  options.scene = scene;
  options.lockstep = true;
  return options;
}

// What was sent, without changes of the transport.
Lines sent(Show& show) {
  Lines texts = show.sent_texts();
  std::erase_if(texts, [](const std::string& text) { return text.starts_with("/transport/state"); });
  return texts;
}

TEST(Lockstep, TimeAdvancesOnlyByRequestedTicks) {
  const SceneFile scene(kScene);
  Show show(lockstep_options(scene.path()));
  show.ticks(5);
  EXPECT_EQ(show.engine.world().tick(), 0U) << "even if the scene plays";
  show.send("/transport/play");
  show.send("/physics/sim/paused", 0);
  show.ticks(5);
  EXPECT_EQ(show.engine.world().tick(), 0U);
  EXPECT_EQ(sent(show), (Lines{"/error /transport/play with --lockstep, time advances only by /transport/step"}));
  show.send("/transport/step", 3);
  show.ticks(10);
  EXPECT_EQ(show.engine.world().tick(), 3U);
}

TEST(Lockstep, MessagesActInTheirOrder) {
  const SceneFile scene(kScene);
  Show show(lockstep_options(scene.path()));
  show.send("/physics/sim/gravity", 0, 0, -1);
  show.send("/told", 1);
  show.send("/transport/step", 2);
  show.send("/physics/sim/gravity", 0, 0, -2);
  show.send("/told", 2);
  show.send("/get", "/physics/sim/tick");
  show.send("/transport/step");
  show.send("/physics/sim/gravity", 0, 0, -3);
  show.ticks(10);
  EXPECT_EQ(sent(show), (Lines{"/heard 1 0", "/tick 0 -1", "/tick 1 -1", "/transport/stepped 2", "/physics/sim/tick 2",
                               "/heard 2 2", "/tick 2 -2", "/transport/stepped 3"}));
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3);
}

TEST(Lockstep, EachRequestIsAnsweredToItsSender) {
  const SceneFile scene(kScene);
  Show show(lockstep_options(scene.path()));
  for (const std::uint16_t port : {std::uint16_t{4001}, std::uint16_t{4002}})
    show.link.command_queue.push({{message("/transport/step", 2)}, {CommandSource::osc, 0x7f000001, port}});
  show.ticks(8);
  Lines answers;
  std::vector<Outgoing> sent;
  show.link.output_queue.drain(sent);
  for (const Outgoing& out : sent) {
    if (out.message.address == "/transport/stepped")
      answers.push_back(fmt::format("{} {}", out.origin.port, out.message.args[0].number));
  }
  EXPECT_EQ(answers, (Lines{"4001 2", "4002 4"}));
}

// The loop doesn't wait for the time of a tick: that would take 100 s here.
TEST(Lockstep, RunsAsFastAsRequested) {
  const SceneFile scene(std::string(kScene) + "sim.timestep = 1");
  EngineOptions options = lockstep_options(scene.path());
  options.ticks = 100;
  Show show(std::move(options));
  for (int i = 0; i < 100; i++) show.send("/transport/step");
  show.engine.run();
  EXPECT_EQ(show.engine.world().tick(), 100U);
}

// The second in which a panic can't be ended by another one is simulated time: passes without ticks don't count.
TEST(Lockstep, ThePanicsFirstSecondIsSimulatedTime) {
  const SceneFile scene(kScene);
  Show show(lockstep_options(scene.path()));
  const auto panic = [&] {
    show.link.command_queue.push_urgent({UrgentKind::panic,
                                         message("/transport/panic"),
                                         {CommandSource::panel},
                                         show.link.command_queue.next_arrival()});
    show.ticks(1);
  };
  panic();
  show.send("/transport/step", 30);
  show.ticks(200);
  panic();
  EXPECT_TRUE(show.engine.world().panic().on()) << "after half a second";
  show.send("/transport/step", 31);
  show.ticks(200);
  panic();
  EXPECT_FALSE(show.engine.world().panic().on()) << "after a second";
}

TEST(Lockstep, TakesReplayToTheSameState) {
  const SceneFile scene(kScene);
  const std::string take = scene.path() + ".take";
  std::uint64_t hash = 0;
  {
    EngineOptions options = lockstep_options(scene.path());
    options.record = take;
    Show show(std::move(options));
    for (int i = 1; i <= 5; i++) {
      show.send("/physics/sim/gravity", 0, 0, -i);
      show.send("/transport/step", i);
    }
    show.ticks(30);
    hash = show.engine.state_hash();
    EXPECT_EQ(show.engine.world().tick(), 15U);
  }
  EngineOptions options = fast_options();
  options.replay = take;
  Show replay(std::move(options));
  replay.engine.run();
  EXPECT_EQ(replay.engine.world().tick(), 15U);
  EXPECT_EQ(replay.engine.state_hash(), hash);
}

}  // namespace
}  // namespace limber::engine::test

// The tick: order of its phases, pause, reset, end, output.
#include "engine/engine.h"

#include <thread>

#include "base/log/log.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

using Lines = std::vector<std::string>;

constexpr const char* kBall = R"(
sim.gravity = vec3(0, 0, -10)
sim.timestep = 0.1
sim.substeps = 1
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { position = vec3(0, 0, 100) })
)";

TEST(Engine, EveryCounterHasAProperty) {
  Show show;
  Counters& c = show.link.counters;
  std::uint64_t value = 10;
  for (auto* counter : {&c.received, &c.malformed, &c.denied, &c.unknown, &c.refused, &c.clamped, &c.dropped,
                        &c.dropped_kernel, &c.sent, &c.unsent}) {
    *counter = value++;
  }
  show.ticks(1);
  double expected = 10;
  for (const char* name : {"received", "malformed", "denied", "unknown", "refused", "clamped", "dropped",
                           "dropped_kernel", "sent", "unsent"}) {
    EXPECT_EQ(show.read(std::string("/osc/") + name), expected++) << name;
  }
}

TEST(Engine, ALongErrorTextIsShortened) {
  // an /error that repeats a name of four-byte escapes must fit receivers of strings up to 1024 bytes
  Show show;
  show.send("/physics/part/mass", "arm", std::string(1000, '\x01'), 1);
  show.send("/" + std::string(1000, '\x01'), 1);
  show.ticks(1);
  std::vector<Outgoing> out;
  show.link.output_queue.drain(out);
  ASSERT_EQ(out.size(), 2u);
  for (const Outgoing& error : out) {
    EXPECT_EQ(error.message.address, "/error");
    EXPECT_LE(error.message.args.at(1).text.size(), 1000u);
    EXPECT_EQ(error.message.args.at(1).text.find("there is no"), 0u);
  }
}

TEST(Engine, TheCommandQueueIsLimitedInBytes) {
  // datagrams of 16 KiB with 16384 flags as arguments need fifty times their size in memory
  EngineLink link;
  Command flood{{{"/n", std::vector<Arg>(16384, Arg::of(true))}}, {}};
  const std::size_t fit = EngineLink::kMaxBytes / weight_of(flood);
  EXPECT_LT(fit, 100u);
  for (std::size_t i = 0; i < fit + 5; i++) EXPECT_EQ(link.command_queue.push(flood), i < fit);
  EXPECT_EQ(link.command_queue.dropped(), 5u);
}

TEST(Engine, CommandsTakeEffectBeforeThePhysicsOfTheirTick) {
  const SceneFile scene(kBall);
  Show show(scene.path());
  show.ticks(1);  // v = g·t
  EXPECT_NEAR(show.read("/physics/body/ball/part/ball/linear_velocity", 2), -1, 1e-6);
  show.send("/physics/sim/gravity", 20);
  show.ticks(1);
  EXPECT_NEAR(show.read("/physics/body/ball/part/ball/linear_velocity", 2), 1, 1e-6);
}

TEST(Engine, MessagesOfACommandActInOneTickAndTheLastOneWins) {
  const SceneFile scene(kBall);
  Show show(scene.path());
  Command bundle;
  for (const double g : {5.0, -3.0, 40.0}) bundle.messages.push_back(message("/physics/sim/gravity", g));
  bundle.messages.push_back(message("/physics/part/linear_velocity", 0, 0, 2));
  show.link.command_queue.push(std::move(bundle));
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -10) << "nothing before the tick";
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 40);
  EXPECT_NEAR(show.read("/physics/body/ball/part/ball/linear_velocity", 2), 2 + 4, 1e-6);
}

TEST(Engine, RunsThePhasesOfATickInOrder) {
  const SceneFile scene(std::string(kBall) + R"(
local function say(what) osc:send("/said", what, sim.gravity.z) end
sim:on_start(function() say("start") end)
sim:on_step(function() say("step") end)
sim:every(0.1, function() say("timer") end)
osc:on("/say", function(what) say(what) end)
)");
  EngineLink link;
  Engine engine(link, fast_options(scene.path()));
  ASSERT_TRUE(engine.start().ok());
  std::vector<Outgoing> out;
  link.output_queue.drain(out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(text_of(out[0].message), "/said start -10");
  EXPECT_EQ(out[0].destination, Outgoing::Destination::targets);
  engine.tick();
  link.output_queue.drain(out);
  // handlers are called after all messages of the tick have taken effect
  link.command_queue.push({{message("/say", "one")}, {}});
  link.command_queue.push({{message("/physics/sim/gravity", -4), message("/say", "two")}, {}});
  engine.tick();
  link.output_queue.drain(out);
  Lines lines;
  for (const Outgoing& o : out) lines.push_back(text_of(o.message));
  EXPECT_EQ(lines, (Lines{"/said one -4", "/said two -4", "/said timer -4", "/said step -4"}));
}

TEST(Engine, AHandlerAnswersUnknownAddresses) {
  const SceneFile scene(std::string(kBall) + R"(
osc:on("/mine", function(v) osc:reply("/mine/back", v) end)
osc:on("/physics/sim/gravity", function() osc:send("/heard") end)
)");
  Show show(scene.path());
  show.send("/mine", 7);
  show.send("/yours", 7);
  show.send("/physics/sim/gravity", 1);
  show.send("/physics/sim/gravity", 1, 2);
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(),
            (Lines{"/error /physics/sim/gravity takes 1 or 3 numbers, not 2", "/mine/back 7",
                   "/error /yours there is no address /yours; `limber describe` lists all", "/heard", "/heard"}));
  EXPECT_EQ(show.link.counters.unknown.load(), 1U);
  EXPECT_EQ(show.link.counters.refused.load(), 1U);
  EXPECT_EQ(show.read("/osc/unknown"), 1);
  EXPECT_EQ(show.read("/osc/refused"), 1);
}

TEST(Engine, AnswersGoToTheSender) {
  Show show;
  show.link.command_queue.push(
      {{message("/get", "/physics/sim/substeps"), message("/list/bodies")}, {CommandSource::osc, 1, 2}});
  show.link.command_queue.push({{message("/nowhere")}, {CommandSource::osc, 3, 4}});
  show.ticks(1);
  std::vector<Outgoing> out;
  show.link.output_queue.drain(out);
  ASSERT_EQ(out.size(), 3U);
  EXPECT_EQ(text_of(out[0].message), "/physics/sim/substeps 4");
  EXPECT_EQ(text_of(out[1].message), "/list/bodies ");
  EXPECT_EQ(out[0].destination, Outgoing::Destination::reply);
  EXPECT_EQ(out[1].origin.port, 2);
  EXPECT_EQ(out[2].destination, Outgoing::Destination::error);
  EXPECT_EQ(out[2].origin.ip, 3U);
}

TEST(Engine, WhilePausedOnlyCommandsAndHandlersRun) {
  const SceneFile scene(std::string(kBall) + R"(
sim:on_step(function() osc:send("/step", sim.tick) end)
osc:on("/ask", function() osc:reply("/told", sim.tick) end)
)");
  Show show(scene.path());
  show.ticks(2);
  show.sent_texts();
  show.send("/transport/pause");
  show.ticks(3);
  EXPECT_EQ(show.sent_texts(), (Lines{"/transport/state 1 2 0.2 1"}));
  EXPECT_EQ(show.engine.world().tick(), 2U);
  EXPECT_TRUE(show.link.snapshots.read()->paused);
  show.send("/ask");
  show.send("/physics/part/position", 1, 2, 3);
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), (Lines{"/told 2"}));
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/center", 1), 2) << "values are published while paused";

  show.send("/transport/step");
  show.ticks(3);
  EXPECT_EQ(show.sent_texts(), (Lines{"/step 2", "/transport/stepped 3"}));
  show.send("/transport/step", 2);
  show.ticks(4);
  EXPECT_EQ(show.sent_texts(), (Lines{"/step 3", "/step 4", "/transport/stepped 5"}));
  show.send("/transport/step", 3);
  show.send("/transport/pause");
  show.ticks(4);
  EXPECT_EQ(show.sent_texts(), (Lines{"/transport/stepped 5"})) << "pausing cancels pending steps";
  show.send("/transport/play");
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), (Lines{"/step 5", "/transport/state 0 6 0.6000000000000001 1"}));
  EXPECT_FALSE(show.link.snapshots.read()->paused);
}

TEST(Engine, StepRejectsInvalidCounts) {
  Show show;
  show.send("/transport/step", -1);
  show.send("/transport/step", 1e9);
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(),
            (Lines{"/error /transport/step can't rewind: the scene starts there",
                   "/error /transport/step the number of ticks must be 1 to 100000, or -1 to -100000 to rewind"}));
  EXPECT_EQ(show.engine.world().tick(), 1U);
}

TEST(Engine, ResetRestartsTheSceneWithOverrides) {
  const SceneFile scene(std::string(kBall) + R"(
state.runs = (state.runs or 0) + 1
sim:on_start(function() osc:send("/start", state.runs, sim.time) end)
sim:at(0.25, function() sim:add_body("late") end)
)");
  Show show(scene.path());
  show.ticks(5);
  EXPECT_NE(show.engine.world().find_body("late"), nullptr);
  const std::uint64_t hash_after_5 = show.engine.state_hash();
  show.send("/physics/part/friction", "ball", 0.125);
  show.send("/physics/body/ball/part/ball/restitution", 0.5);
  show.send("/physics/part/friction", "ball", 0.25);
  show.send("/physics/sim/speed", 3);
  show.ticks(1);
  show.sent_texts();
  show.send("/transport/reset");
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), (Lines{"/start 1 0", "/transport/state 0 0 0 1"})) << "state is emptied";
  EXPECT_EQ(show.engine.world().tick(), 0U);
  EXPECT_EQ(show.engine.world().find_body("late"), nullptr);
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/position", 2), 100);
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/linear_velocity", 2), 0);
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/friction"), 0.25) << "the last override";
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/restitution"), 0.5);
  EXPECT_EQ(show.read("/physics/sim/speed"), 3);
  EXPECT_EQ(show.link.snapshots.read()->tick, 0U);
  // without the overrides it would be the same run again
  show.send("/physics/part/friction", "ball", 0.5);
  show.send("/physics/part/restitution", "ball", 0);
  show.send("/transport/reset");
  show.ticks(1);
  show.ticks(5);
  EXPECT_EQ(show.engine.state_hash(), hash_after_5);
}

TEST(Engine, TheSceneCanRequestAReset) {
  const SceneFile scene(std::string(kBall) + "osc:on('/again', function() sim:reset() end)\n");
  Show show(scene.path());
  show.ticks(3);
  show.send("/again");
  show.ticks(1);
  EXPECT_EQ(show.engine.world().tick(), 0U);
}

TEST(Engine, ANewSeedTakesEffectAtTheNextStart) {
  const SceneFile scene("sim.seed = 5\nosc:on('/draw', function() osc:reply('/drawn', rng:uniform()) end)\n");
  const auto draw = [](Show& show) {
    show.send("/draw");
    show.ticks(1);
    return show.sent_texts();
  };
  Show show(scene.path());
  const Lines first = draw(show);
  show.send("/transport/reset");
  show.ticks(1);
  show.sent_texts();
  EXPECT_EQ(show.read("/physics/sim/seed"), 5);
  EXPECT_EQ(draw(show), first);
  show.send("/physics/sim/seed", 6);
  show.send("/transport/reset");
  show.ticks(1);
  show.sent_texts();
  EXPECT_EQ(show.read("/physics/sim/seed"), 6) << "the override";
  const Lines other = draw(show);
  EXPECT_NE(other, first);
  EngineOptions options = fast_options(scene.path());
  options.scene_options.seed = 6;
  Show from_start(std::move(options));
  EXPECT_EQ(draw(from_start), other);
}

TEST(Engine, AResetWithABrokenFileChangesNothing) {
  const SceneFile scene(kBall);
  Show show(scene.path());
  show.ticks(3);
  const std::uint64_t hash = show.engine.state_hash();
  scene.write("this is no Lua");
  log_to_stderr(false);
  show.send("/transport/reset");
  show.send("/transport/pause");
  show.engine.tick();
  log_to_stderr(true);
  EXPECT_EQ(show.engine.faults(), 1U);
  EXPECT_EQ(show.engine.world().tick(), 3U);
  ASSERT_NE(show.engine.world().find_body("ball"), nullptr);
  EXPECT_EQ(show.engine.state_hash(), hash);
  scene.write(kBall);
  show.send("/transport/reset");
  show.engine.tick();
  EXPECT_EQ(show.engine.world().tick(), 0U);
}

TEST(Engine, RunsForANumberOfTicksOrATime) {
  const SceneFile scene(kBall);
  EngineOptions options = fast_options(scene.path());
  options.ticks = 7;
  Show by_ticks(options);
  by_ticks.engine.run();
  EXPECT_EQ(by_ticks.engine.world().tick(), 7U);
  options.ticks = 0;
  Show none(options);
  none.engine.run();
  EXPECT_EQ(none.engine.world().tick(), 0U);
  options.ticks.reset();
  options.duration = 0.7;  // 7 times 0.1 is a little less than 0.7 in binary
  Show by_time(options);
  by_time.engine.run();
  EXPECT_EQ(by_time.engine.world().tick(), 7U);
  EXPECT_EQ(by_time.engine.state_hash(), by_ticks.engine.state_hash());
  options.fast = false;
  Show paced(options);
  paced.engine.run();
  EXPECT_EQ(paced.engine.state_hash(), by_ticks.engine.state_hash()) << "the clock does not affect the result";
}

TEST(Engine, StopsAndReportsAnEndlessCallback) {
  // the ball falls as it would alone: after n steps of 0.1 s at 10 m/s² by 0.05 · n · (n + 1)
  const SceneFile scene(std::string(kBall) + "sim:on_step(function() sim.gravity = vec3() while true do end end)\n");
  EngineOptions options = fast_options(scene.path());
  options.scene_options.limits.call_ms = 5 * script::kBudgetScale;
  Show show(options);
  show.ticks(10);
  EXPECT_NEAR(show.read("/physics/body/ball/position", 2), 100 - 0.05 * 10 * 11, 1e-3);
  std::vector<Outgoing> out;
  show.link.output_queue.drain(out);
  std::erase_if(out, [](const Outgoing& o) { return o.message.address != "/script/error"; });
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].message.args.at(0).text, "scene.lua");
  EXPECT_EQ(show.engine.faults(), 1u);
  // a reset makes a new Lua state while the old one exists; it is stopped too
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.engine.faults(), 2u);
}

TEST(Engine, StrictEndsAtTheFirstFault) {
  EngineOptions options = fast_options();
  options.strict = true;
  Show show(options);
  show.send("/physics/sim/gravity", "down");
  show.engine.run();
  EXPECT_EQ(show.engine.world().tick(), 1U);
  EXPECT_EQ(show.engine.faults(), 1U);

  const SceneFile scene("sim:at(2, function() error('oh') end)\nsim.timestep = 1\n");
  options.scene = scene.path();
  log_to_stderr(false);
  Show erring(options);
  erring.engine.run();
  log_to_stderr(true);
  EXPECT_EQ(erring.engine.faults(), 1U);
  EXPECT_LE(erring.engine.world().tick(), 3U);
  const Lines out = erring.sent_texts();
  ASSERT_EQ(out.size(), 1U);
  EXPECT_TRUE(out[0].starts_with("/script/error ")) << out[0];
  EXPECT_NE(out[0].find("scene.lua:1"), std::string::npos) << out[0];
}

TEST(Engine, SetsAreOverridesBeforeTheFirstTick) {
  const SceneFile scene(kBall);
  EngineOptions options = fast_options(scene.path());
  options.sets = {message("/physics/sim/gravity", 5), message("/physics/body/ball/part/ball/position", 0, 0, 7),
                  message("/physics/part/mass", "ball", "ball", 3)};
  Show show(options);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 5);
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/mass"), 3);
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/center", 2), 7);
  show.ticks(3);
  show.send("/transport/reset");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/body/ball/part/ball/position", 2), 7);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), 5);

  struct Case {
    Message set;
    const char* says;
  };
  for (const Case& c : {Case{message("/physics/sim/gravty", 1),
                             "--set /physics/sim/gravty: there is no address "
                             "/physics/sim/gravty; did you mean "
                             "'/physics/sim/gravity'?"},
                        Case{message("/physics/body/bal/part/ball/mass", 1), "did you mean 'ball'?"},
                        Case{message("/physics/part/mass", "ball", "ball", "x"), "takes 1 number"},
                        Case{message("/list/bodies"), "--set /list/bodies: this is a query, not a value"}}) {
    options.sets = {c.set};
    EngineLink link;
    Engine engine(link, options);
    const Result<void> started = engine.start();
    ASSERT_FALSE(started.ok()) << c.says;
    EXPECT_NE(started.error().find(c.says), std::string::npos) << started.error();
  }
}

TEST(Engine, ClampingIsCountedAndReportedOncePerProperty) {
  Show show;
  log_to_stderr(false);
  const std::uint64_t warnings_before = log_count(LogLevel::warning);
  for (int i = 0; i < 5; i++) show.send("/physics/sim/substeps", -i);
  show.send("/physics/sim/timestep", 99);
  show.ticks(1);
  log_to_stderr(true);
  EXPECT_EQ(show.link.counters.clamped.load(), 6U);
  EXPECT_EQ(log_count(LogLevel::warning) - warnings_before, 2U);
  EXPECT_EQ(show.read("/osc/clamped"), 6);
  EXPECT_EQ(show.engine.faults(), 0U) << "a clamped value is not a fault";
}

TEST(Engine, AWaitingEngineStopsAndAnswersAtOnce) {
  // the second tick is due 100 s after the first: without the wake-up this test would take that long
  EngineOptions options;
  options.sets = {message("/physics/sim/timestep", 1), message("/physics/sim/speed", 0.01)};
  EngineLink link;
  Engine engine(link, options);
  ASSERT_TRUE(engine.start().ok());
  std::mutex mutex;
  std::condition_variable sent;
  bool answered = false;
  link.wake_network = [&] {
    const std::scoped_lock lock(mutex);
    answered = true;
    sent.notify_all();
  };
  std::thread thread([&] { engine.run(); });
  link.command_queue.push({{message("/list/bodies")}, {}});
  link.wake_engine();
  {
    std::unique_lock lock(mutex);
    sent.wait(lock, [&] { return answered; });
  }
  engine.stop();
  thread.join();
  EXPECT_LE(engine.world().tick(), 1U);
}

TEST(Engine, SendsOneEventPerContact) {
  const SceneFile scene(R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.5), { position = vec3(0, 0, 0.55), report_contacts = true })
)");
  Show show(scene.path());
  show.ticks(60);
  const Lines out = show.sent_texts();
  ASSERT_EQ(out.size(), 1U) << "it falls 5 cm and rests";
  EXPECT_TRUE(out[0].starts_with("/physics/contact ball ball floor floor ")) << out[0];
}

}  // namespace
}  // namespace limber::engine::test

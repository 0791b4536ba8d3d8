// Urgent requests overtake all waiting commands and act in the next tick; the first second of a panic.
#include "engine/taken.h"

namespace limber::engine::test {
namespace {

constexpr const char* kPanicked = "/physics/sim/panicked";
constexpr const char* kFallingBalls = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 20 do sim:add_body("ball" .. i):add_part("p", ball, { position = vec3(i, 0, 9) }) end
state.heard = 0
osc:on("/slow", function() state.heard = state.heard + 1; sim.gravity = vec3(0, 0, -state.heard) end)
)";

// fills the queue with patterns that match every part
void flood(Show& show, std::size_t messages) {
  constexpr std::size_t kEach = 64;
  for (std::size_t i = 0; i < messages; i += kEach) {
    Command command;
    command.origin = {CommandSource::osc, 0x7f000001, 4000};
    for (std::size_t k = 0; k < kEach; k++)
      command.messages.push_back(message("/physics/body/*/part/{p,q}/mass", 1 + 0.001 * static_cast<double>(i + k)));
    show.link.command_queue.push(std::move(command));
  }
}

// one of many senders
void send_from(Show& show, std::uint16_t port, Message message) {
  show.link.command_queue.push({{std::move(message)}, {CommandSource::osc, 0x7f000001, port}});
}

TEST(Urgent, APanicActsAfterOneTickOfAMillionPatterns) {
  const SceneFile file(kFallingBalls);
  Show show(file.path());
  show.ticks(1);
  flood(show, 1'000'000);
  while (show.link.command_queue.push({{message("/physics/sim/gravity", 1)}, {}})) continue;  // until the queue is full
  const std::uint64_t dropped = show.link.command_queue.dropped();
  show.send("/transport/panic");
  EXPECT_EQ(show.link.command_queue.dropped(), dropped);
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 1);
}

TEST(Urgent, APauseActsInTheNextTick) {
  Show show;
  flood(show, 100'000);
  show.send("/Transport/Pause/", 1);
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/sim/paused"), 1);
  EXPECT_EQ(show.engine.world().tick(), 0u);
}

TEST(Urgent, TheEndOfATakeActsInTheNextTick) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kFallingBalls);
  Show show(fast_options(folder.path("scripts/scene.lua")));
  show.send("/take/record", "one");
  show.ticks(2);
  flood(show, 100'000);
  show.sent_texts();
  show.send("/take/stop", 0);
  show.ticks(1);
  EXPECT_TRUE(show.sent_texts().empty()) << "a button that is released";
  show.send("/take/stop", 1);
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), std::vector<std::string>{"/take/stopped"});
}

TEST(Urgent, AcceptsAnyNumberOfSenders) {
  Show show;
  for (int i = 0; i < 3000; i++) {
    send_from(show, static_cast<std::uint16_t>(i), message("/transport/pause"));
    send_from(show, static_cast<std::uint16_t>(i), message("/transport/panic"));
    send_from(show, static_cast<std::uint16_t>(i), message("/take/stop"));
  }
  std::vector<UrgentRequest> requests;
  show.link.command_queue.drain_urgent(requests);
  EXPECT_LE(requests.size(), CommandQueue::kMaxUrgent);
  for (const UrgentKind kind : {UrgentKind::pause, UrgentKind::panic, UrgentKind::take_stop})
    EXPECT_GT(std::ranges::count(requests, kind, &UrgentRequest::kind), 0);
  EXPECT_EQ(requests.back().origin.port, 2999);
}

TEST(Urgent, TheSignalIsAPanic) {
  Show show;
  flood(show, 100'000);
  show.link.panic_signal = true;
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 1);
  EXPECT_FALSE(show.link.panic_signal);
}

TEST(Urgent, DiscardsAndCountsOvertakenRequests) {
  Show show;
  flood(show, 20'000);
  show.send("/transport/play");
  show.send("/transport/step", 5);
  show.send("/physics/sim/paused", 0);
  show.send("/physics/sim/gravity", -3);
  show.send("/transport/pause");
  show.ticks(40);
  EXPECT_EQ(show.read("/physics/sim/paused"), 1);
  EXPECT_EQ(show.engine.world().tick(), 0u) << "no step is made";
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3) << "values are";
  EXPECT_EQ(show.read("/osc/discarded"), 3);
  show.send("/transport/pause");
  show.send("/transport/play");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/sim/paused"), 0) << "a later one acts";
  EXPECT_EQ(show.read("/osc/discarded"), 3);
}

TEST(Urgent, TheOrderWithinABundleCounts) {
  Show show;
  const auto bundle = [&](std::vector<Message> messages) {
    show.link.command_queue.push({std::move(messages), {CommandSource::osc, 0x7f000001, 4000}});
    show.ticks(1);
  };
  bundle({message("/transport/play"), message("/transport/pause")});
  EXPECT_EQ(show.read("/physics/sim/paused"), 1);
  EXPECT_EQ(show.read("/osc/discarded"), 1);
  bundle({message("/transport/pause"), message("/transport/play")});
  EXPECT_EQ(show.read("/physics/sim/paused"), 0);
  bundle({message("/transport/pause", 0), message("/physics/sim/gravity", 0)});
  EXPECT_EQ(show.read("/physics/sim/paused"), 0) << "a button that is released";
}

TEST(Urgent, AnOlderResetDoesNotEndAPanic) {
  const SceneFile file(kFallingBalls);
  Show show(file.path());
  show.ticks(100);
  flood(show, 2'000);
  show.send("/transport/reset");
  show.send("/transport/rewind", 1);
  show.send("/transport/panic");
  show.ticks(40);
  EXPECT_EQ(show.read(kPanicked), 1);
  EXPECT_EQ(show.engine.world().tick(), 140u);
  EXPECT_EQ(show.read("/osc/discarded"), 2);
}

TEST(PanicFirstSecond, IgnoresAnotherRequest) {
  for (const double paused : {0.0, 1.0}) {
    Show show;
    show.send("/physics/sim/paused", paused);
    show.send("/transport/panic");
    show.ticks(1);
    for (int i = 0; i < 59; i++) {
      show.send("/transport/panic");
      show.ticks(1);
      ASSERT_EQ(show.read(kPanicked), 1) << i;
    }
    show.ticks(1);
    show.send("/transport/panic");
    show.ticks(1);
    EXPECT_EQ(show.read(kPanicked), 0);
  }
}

TEST(PanicFirstSecond, PanicEndEndsItAtAnyTime) {
  Show show;
  show.send("/transport/panic_end");
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 0);
  show.send("/transport/panic");
  show.ticks(1);
  show.send("/transport/panic_end", 0);
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 1) << "a button that is released";
  show.send("/transport/panicEnd");
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 0);
  // in one tick, the later one decides
  show.send("/transport/panic");
  show.send("/transport/panic_end");
  show.ticks(1);
  EXPECT_EQ(show.read(kPanicked), 0);
  for (int i = 0; i < 2; i++) {
    show.send("/transport/panic_end");
    show.send("/transport/panic");
    show.ticks(1);
    EXPECT_EQ(show.read(kPanicked), 1);
  }
}

TEST(PanicFirstSecond, ZeroOfAnyKindDoesNothing) {
  Show show;
  for (const Arg& zero : {Arg::of(0.0), Arg::of(false), Arg::of("0")}) {
    show.send("/transport/panic", zero);
    show.ticks(1);
    EXPECT_EQ(show.read(kPanicked), 0);
  }
}

// Returns options with a clock that advances by `seconds` each time it is read.
EngineOptions options_with_clock(const std::string& scene, double seconds) {
  EngineOptions options = fast_options(scene);
  options.fast = false;
  options.clock = [now = 0.0, seconds]() mutable { return now += seconds; };
  return options;
}

TEST(PanicFirstSecond, ATakeRecordsItsEnd) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kFallingBalls);
  EngineOptions options = options_with_clock(folder.path("scripts/scene.lua"), 0.01);
  options.record = folder.path("first.take");
  std::uint64_t hash = 0;
  {
    Show show(options);
    for (int i = 0; i < 300; i++) {
      if (i % 7 == 3) show.send("/transport/panic");
      if (i == 150) show.send("/physics/sim/paused", 1);
      if (i == 250) show.send("/physics/sim/paused", 0);
      show.ticks(1);
    }
    show.engine.end_take();
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  expect_replay(options.record, hash);
}

// each read of the clock takes 1 ms, so a handler takes 1 ms, and a tick has time for some handlers
TEST(HandlerBudget, MessagesWaitInOrderButValuesActAtOnce) {
  const SceneFile file(kFallingBalls);
  Show show(options_with_clock(file.path(), 0.001));
  for (int i = 0; i < 100; i++) show.send("/slow");
  show.send("/physics/sim/substeps", 2);
  show.ticks(1);
  const double first = -show.read("/physics/sim/gravity", 2);
  EXPECT_GT(first, 0);
  EXPECT_LE(first, 1000 * HandlerBudget::kMaxSeconds);
  EXPECT_EQ(show.read("/physics/sim/substeps"), 2);
  double before = first;
  for (int i = 0; i < 100 && before < 100; i++) {
    show.ticks(1);
    const double now = -show.read("/physics/sim/gravity", 2);
    EXPECT_LE(now - before, 1000 * HandlerBudget::kMaxSeconds);
    before = now;
  }
  EXPECT_EQ(before, 100) << "all are heard in the end";
}

TEST(HandlerBudget, AReplayAndARewindHandleTheSameMessagesPerTick) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kFallingBalls);
  EngineOptions options = options_with_clock(folder.path("scripts/scene.lua"), 0.001);
  options.record = folder.path("slow.take");
  std::uint64_t hash = 0;
  std::vector<std::uint64_t> hashes(400);
  {
    Show show(options);
    const auto play = [&](int i) {
      if (i % 40 == 19) {  // some wait at the checkpoint of tick 60
        for (int k = 0; k < 16; k++) show.send("/slow");
      }
      show.ticks(1);
    };
    for (int i = 0; i < 160; i++) {
      play(i);
      hashes[show.engine.world().tick()] = show.engine.state_hash();
    }
    // to ticks in which no message waits, over ticks in which some do
    for (const double back : {8.0, 40.0, 40.0}) {
      show.send("/transport/rewind_ticks", back);
      show.engine.idle();
      ASSERT_EQ(show.engine.state_hash(), hashes[show.engine.world().tick()]) << show.engine.world().tick();
    }
    EXPECT_EQ(show.engine.world().tick(), 72u);
    for (int i = 0; i < 50; i++) play(i);
    show.engine.end_take();
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  expect_replay(options.record, hash);
}

TEST(HandlerBudget, MessagesBeyondTheQueueAreDroppedAndCounted) {
  const SceneFile file(kFallingBalls);
  Show show(options_with_clock(file.path(), 1));  // no time for any but the first
  Command command;
  for (std::size_t i = 0; i < HandlerQueue::kMaxEntries + 100; i++) command.messages.push_back(message("/slow"));
  show.link.command_queue.push(std::move(command));
  show.ticks(1);
  EXPECT_EQ(show.read("/osc/unheard"), 100);
}

TEST(FailedHandler, IsReportedOnceAndEnabledByASave) {
  EditedShow edited("osc:on('/fails', function() nothing() end)\nosc:on('/works', function() osc:reply('/yes') end)\n");
  Show& show = edited.show();
  const auto faults = [&] {
    std::size_t count = 0;
    for (int i = 0; i < 5; i++) {
      show.send("/fails");
      show.send("/works");
      show.ticks(1);
      const std::vector<std::string> messages = show.sent_texts();
      EXPECT_EQ(std::ranges::count(messages, "/yes"), 1);
      count += static_cast<std::size_t>(
          std::ranges::count_if(messages, [](const std::string& line) { return line.starts_with("/script/error"); }));
    }
    return count;
  };
  EXPECT_EQ(faults(), 1u);
  EXPECT_EQ(show.read("/osc/disabled"), 1);
  edited.save(edited.text + "-- another line\n");
  show.ticks(1);
  EXPECT_EQ(show.read("/osc/disabled"), 0);
  EXPECT_EQ(faults(), 1u) << "it fails still";
}

// in replays of older takes, handlers are called again after they failed
TEST(FailedHandler, AnOlderTakeCallsItAgain) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", "osc:on('/fails', function() nothing() end)\n");
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("now.take");
  {
    Show show(options);
    for (int i = 0; i < 3; i++) {
      show.send("/fails");
      show.ticks(1);
    }
    EXPECT_EQ(show.engine.faults(), 1u);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  std::string bytes = file_bytes(options.record);
  const std::string rules = ",\"rules\":2";
  const std::size_t at = bytes.find(rules);
  ASSERT_NE(at, std::string::npos);
  bytes.erase(at, rules.size());
  folder.write("before.take", bytes);
  for (const auto& [file, faults] : {std::pair{"now.take", 1u}, std::pair{"before.take", 3u}}) {
    EngineLink link;
    EngineOptions replay = fast_options();
    replay.replay = folder.path(file);
    Engine engine(link, replay);
    ASSERT_TRUE(engine.start().ok());
    engine.run();
    EXPECT_EQ(engine.faults(), faults) << file;
  }
}

TEST(StepAndGet, AQueryAfterAStepIsAnsweredAfterItsTicks) {
  Show show;
  show.send("/transport/pause");
  show.ticks(1);
  show.sent_texts();
  show.send("/transport/step", 3);
  show.send("/get", "/physics/sim/tick");
  send_from(show, 4001, message("/get", "/physics/sim/tick"));
  show.ticks(6);
  EXPECT_EQ(show.sent_texts(),
            (std::vector<std::string>{"/physics/sim/tick 0", "/transport/stepped 3", "/physics/sim/tick 3"}))
      << "another sender's is answered at once";
  show.send("/transport/step", 100);
  show.send("/get", "/physics/sim/tick");
  show.ticks(10);
  show.send("/transport/pause");
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), (std::vector<std::string>{"/physics/sim/tick 13", "/transport/stepped 13"}))
      << "no step is left";
}

}  // namespace
}  // namespace limber::engine::test

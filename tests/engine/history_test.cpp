// Rewind: the replayed future is bit-identical to the original one; limits of the history and messages about them.
#include "engine/history/history.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/behaviors.h"
#include "engine/rewound.h"
#include "engine/taken.h"
#include "support/skip.h"

namespace limber::engine::test {
namespace {

// Compares a run with many random rewinds, tick by tick, with one without rewinds.
void expect_same_with_rewinds(const EngineOptions& options, TickInputs inputs, std::uint64_t ticks,
                              std::uint64_t seed) {
  log_to_stderr(false);
  std::vector<std::uint64_t> hashes;
  {
    Show reference(options);
    play_to(reference, ticks, inputs, hashes);
  }
  Show show(options);
  Random random(seed, "walk");
  int times = 0;
  for (std::uint64_t farthest = 1; farthest < ticks;) {
    const auto forward = static_cast<std::uint64_t>(random.uniform(1, 90));
    if (!replays_identically(show, std::min(ticks, show.engine.world().tick() + forward), inputs, hashes)) return;
    const std::uint64_t tick = show.engine.world().tick();
    if (tick == ticks) break;
    farthest = std::max(farthest, tick);
    show.sent_texts();
    const bool far = random.uniform() < 0.1;
    if (random.uniform() < 0.5) {
      show.send("/transport/rewind", random.uniform(0.01, far ? 4 : 0.8));
    } else {
      show.send("/transport/step", -std::floor(random.uniform(1, far ? 200 : 40)));
      show.send("/transport/play");
    }
    show.engine.idle();
    times++;
    const std::uint64_t now = show.engine.world().tick();
    ASSERT_LT(now, tick);
    ASSERT_EQ(show.engine.state_hash(), hashes[now]) << "back at tick " << now << " from " << tick;
  }
  EXPECT_GT(times, 5);
}

TEST(History, RewindIsExactForEveryBehavior) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  expect_same_with_rewinds(rewind_options(folder), no_inputs, 500, 1);
}

TEST(History, RewindIsExactForScripts) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  const ShowFolder folder;
  write_rewind_scene(folder);
  expect_same_with_rewinds(rewind_options(folder), no_inputs, 700, 2);
}

TEST(History, RewindIsExactWithManyInputs) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  const ShowFolder folder;
  write_rewind_scene(folder);
  for (std::uint64_t seed = 3; seed < 6; seed++)
    expect_same_with_rewinds(rewind_options(folder), random_inputs, 500, seed);
}

TEST(History, RewindRepeatsNoOutput) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  Show show(rewind_options(folder));
  std::vector<std::uint64_t> hashes;
  play_to(show, 170, random_inputs, hashes);
  show.sent_texts();
  const std::uint64_t lines = log_newest();
  const std::size_t changes = show.link.changes.after(0).size();
  const std::uint64_t faults = show.engine.faults();
  show.send("/transport/rewind", 0.5);
  show.engine.idle();
  const std::vector<std::string> out = show.sent_texts();
  ASSERT_EQ(out.size(), 2u) << fmt::format("{}", fmt::join(out, "\n"));
  EXPECT_EQ(out[0].substr(0, 16), "/transport/state");
  EXPECT_EQ(out[1], "/transport/rewound 0.5 140");
  EXPECT_EQ(log_newest(), lines);
  EXPECT_EQ(show.link.changes.after(0).size(), changes);
  EXPECT_EQ(show.engine.faults(), faults);
}

TEST(History, RewindsAsFarAsHistoryReaches) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewind_options(folder));
  show.ticks(300);
  EXPECT_NEAR(show.read("/transport/rewindable"), 5, 0.05);
  EXPECT_GT(show.read("/transport/history_memory"), 0.1);
  show.sent_texts();
  show.send("/transport/rewind", 20);
  show.engine.idle();
  EXPECT_EQ(show.sent_texts().back().substr(0, 26), "/transport/rewound 4.98333");
  EXPECT_EQ(show.engine.world().tick(), 1u);
  show.send("/transport/rewind", 1);
  show.engine.idle();
  EXPECT_EQ(show.sent_texts().back(), "/error /transport/rewind can't rewind: the scene starts there");
  // the property `history` limits it; default: 30 s
  show.ticks(60 * 40);
  EXPECT_NEAR(show.read("/transport/rewindable"), 30.5, 0.51);
  show.send("/physics/sim/history", 5);
  show.ticks(2);
  EXPECT_NEAR(show.read("/transport/rewindable"), 5.5, 0.51);
  show.send("/physics/sim/history", 0);
  show.ticks(100);
  EXPECT_EQ(show.read("/transport/rewindable"), 0);
  EXPECT_EQ(show.read("/transport/history_memory"), 0);
  show.sent_texts();
  show.send("/transport/rewind", 1);
  show.engine.idle();
  EXPECT_EQ(show.sent_texts().back(), "/error /transport/rewind can't rewind: history is switched off");
  show.send("/physics/sim/history", 30);
  show.ticks(100);
  EXPECT_GT(show.read("/transport/rewindable"), 1);
}

TEST(History, RejectsInvalidSpans) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewind_options(folder));
  show.ticks(100);
  const std::uint64_t hash = show.engine.state_hash();
  const double bad[] = {0, -1, std::nan(""), std::numeric_limits<double>::infinity()};
  for (const double seconds : bad) {
    show.sent_texts();
    show.send("/transport/rewind", seconds);
    show.engine.idle();
    const std::vector<std::string> out = show.sent_texts();
    ASSERT_EQ(out.size(), 1u);
    EXPECT_EQ(out[0].substr(0, 24), "/error /transport/rewind") << out[0];
  }
  for (const char* text : {"/transport/rewind", "/transport/rewind_ticks"}) {
    show.send(text);
    show.send(text, "far");
    show.send(text, 1, 2);
  }
  show.send("/transport/step", -0.5);
  show.send("/transport/rewind_ticks", 0);
  show.engine.idle();
  EXPECT_EQ(show.sent_texts().size(), 8u);
  EXPECT_EQ(show.engine.state_hash(), hash);
  EXPECT_EQ(show.engine.world().tick(), 100u);
}

TEST(History, PendingStepsContinueAfterARewind) {
  Show show;
  show.ticks(65);
  show.send("/transport/step", 10);
  show.ticks(4);
  ASSERT_EQ(show.engine.world().tick(), 69u);
  show.send("/transport/rewind_ticks", 2);
  show.ticks(20);
  EXPECT_EQ(show.engine.world().tick(), 67u + 6u);
}

TEST(History, StepsBackAndForthWhilePaused) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  const ShowFolder folder;
  write_rewind_scene(folder);
  Show show(rewind_options(folder));
  std::vector<std::uint64_t> hashes;
  play_to(show, 150, no_inputs, hashes);
  show.send("/transport/pause");
  show.ticks(5);
  EXPECT_EQ(show.engine.world().tick(), 150u);
  for (int i = 1; i <= 140; i++) {
    show.send("/transport/step", -1);
    show.ticks(2);
    ASSERT_EQ(show.engine.world().tick(), 150u - static_cast<std::uint64_t>(i));
    ASSERT_EQ(show.engine.state_hash(), hashes[show.engine.world().tick()]);
  }
  for (std::uint64_t tick = 11; tick <= 150; tick++) {
    show.send("/transport/step");
    show.ticks(2);
    ASSERT_EQ(show.engine.world().tick(), tick);
    ASSERT_EQ(show.engine.state_hash(), hashes[tick]);
  }
}

// A value that is set while paused belongs to the tick at which the simulation is paused.
TEST(History, KeepsValuesSetWhilePaused) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewind_options(folder));
  show.ticks(100);
  show.send("/transport/pause");
  show.send("/physics/body/body1/part/part1/mass", 7);
  show.ticks(1);
  const std::uint64_t hash = show.engine.state_hash();
  show.send("/transport/step", 3);
  show.ticks(3);
  show.send("/physics/body/body1/part/part1/mass", 9);
  show.ticks(1);
  show.send("/transport/step", -3);
  show.ticks(1);
  EXPECT_EQ(show.engine.world().tick(), 100u);
  EXPECT_EQ(show.read("/physics/body/body1/part/part1/mass"), 7);
  EXPECT_EQ(show.engine.state_hash(), hash);
  EXPECT_EQ(show.read("/physics/sim/paused"), 1);
}

// In one datagram: messages before the rewind are discarded, messages after it are executed at the restored time.
TEST(History, ARewindDiscardsEarlierMessagesOfItsDatagram) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewind_options(folder));
  show.ticks(100);
  show.link.command_queue.push(
      {{message("/physics/body/body1/part/part1/mass", 7), message("/transport/rewind_ticks", 10),
        message("/physics/body/body1/part/part2/mass", 9), message("/transport/pause")},
       {CommandSource::osc}});
  show.ticks(1);
  EXPECT_EQ(show.engine.world().tick(), 90u);
  EXPECT_EQ(show.read("/physics/body/body1/part/part1/mass"), 1);
  EXPECT_EQ(show.read("/physics/body/body1/part/part2/mass"), 9);
  EXPECT_EQ(show.read("/physics/sim/paused"), 1);
  // the message after the rewind can be undone
  show.send("/edit/undo");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/body/body1/part/part2/mass"), 1);
}

TEST(History, PresetsSpeedAndPauseSurviveARewind) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewind_options(folder));
  show.ticks(100);
  show.send("/preset/store", "late");
  show.send("/physics/sim/speed", 2);
  show.ticks(10);
  show.send("/transport/rewind", 1);
  show.engine.idle();
  EXPECT_EQ(show.engine.presets().names(), "late");
  EXPECT_EQ(show.read("/physics/sim/speed"), 2);
}

TEST(History, StructuralChangesEndHistory) {
  const ShowFolder folder;
  write_rewind_scene(folder, std::string(kRewindScene) + R"(
osc:on("/spawn", function() sim:body("stone1"):copy("more", { position = vec3(0, 0, 5) }) end)
osc:on("/wind", function() sim:body("arm1"):add_behavior("random_force", "wind") end)
)");
  Show show(rewind_options(folder));
  const auto expect_limit = [&](const char* address, const char* why) {
    show.ticks(150);
    const std::uint64_t tick = show.engine.world().tick();
    show.send(address);
    show.ticks(100);
    show.sent_texts();
    show.send("/transport/rewind", 20);
    show.engine.idle();
    const std::string out = show.sent_texts().back();
    EXPECT_NE(out.find(why), std::string::npos) << out;
    if (show.engine.world().tick() > 100) {
      EXPECT_GE(show.engine.world().tick(), tick) << address;
      EXPECT_LE(show.engine.world().tick(), tick + 60) << address;
    }
  };
  expect_limit("/spawn", "objects were added or removed");
  expect_limit("/wind", "objects were added or removed");
  expect_limit("/physics/body/stone9/remove", "objects were added or removed");
  expect_limit("/transport/reset", "the scene starts there");
  // a structural change in the tick of the rewind, before it: no checkpoint fits
  show.ticks(150);
  show.sent_texts();
  show.link.command_queue.push(
      {{message("/physics/body/stone8/remove"), message("/transport/rewind_ticks", 20)}, {CommandSource::osc}});
  show.ticks(1);
  const std::vector<std::string> messages = show.sent_texts();
  EXPECT_TRUE(std::ranges::any_of(messages, [](const std::string& line) {
    return line.find("can't rewind: objects were added or removed") != line.npos;
  })) << messages.size();
  show.ticks(30);
  show.send("/transport/rewind_ticks", 20);
  show.engine.idle();
  EXPECT_EQ(show.sent_texts().back().find("/error"), std::string::npos);
}

TEST(History, AReloadEndsHistory) {
  EditedShow edited(
      "local b = sim:add_body('b'):add_part('p', sim:add_sphere_shape('s', 0.1))\nsim:on_step(function() end)");
  edited.show().ticks(120);
  EXPECT_EQ(edited.save(edited.text + "\nsim.gravity = vec3(1, 0, 0)"), SceneReloader::ApplyResult::applied);
  edited.show().ticks(90);
  edited.show().sent_texts();
  edited.show().send("/transport/rewind", 20);
  edited.show().engine.idle();
  EXPECT_NE(edited.show().sent_texts().back().find("the scene was run again there"), std::string::npos);
  EXPECT_GE(edited.world().tick(), 120u);
  EXPECT_EQ(edited.show().read("/physics/sim/gravity", 0), 1);
}

// A stopped call is not executed again in a replay, and later ticks are identical.
TEST(History, StoppedCallsStayStopped) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  log_to_stderr(false);
  EngineOptions options = rewind_options(folder);
  options.scene_options.limits.call_ms = 8 * script::kBudgetScale;
  const auto inputs = [](Show& show, std::uint64_t tick) {
    random_inputs(show, tick);
    if (tick % 50 == 20) show.send("/loop", static_cast<double>(tick));
  };
  Show show(options);
  std::vector<std::uint64_t> hashes;
  play_to(show, 230, inputs, hashes);
  for (const double back : {2.5, 1.0, 3.3, 0.3}) {
    show.send("/transport/rewind", back);
    show.engine.idle();
    ASSERT_EQ(show.engine.state_hash(), hashes[show.engine.world().tick()]) << back;
    play_to(show, 230, inputs, hashes);
  }
}

TEST(History, LargeScenesHaveAShorterHistory) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", R"(
sim:add_body("ball"):add_part("p", sim:add_sphere_shape("s", 0.1))
local heaps, n = {}, 0
for k = 1, 12 do
  heaps[k] = {}
  for i = 1, 250000 do heaps[k][i] = i end
end
sim:on_step(function()
  n = n + 1
  for k = 1, 12 do for i = 1, 250000, 400 do heaps[k][i] = n end end
end)
)");
  log_to_stderr(false);
  const std::uint64_t lines = log_newest();
  Show show(rewind_options(folder));
  show.ticks(60 * 20);
  EXPECT_LE(show.read("/transport/history_memory"), 256);
  EXPECT_GT(show.read("/transport/history_memory"), 200);
  EXPECT_GT(show.read("/transport/rewindable"), 5);
  EXPECT_LT(show.read("/transport/rewindable"), 18);
  std::size_t reported = 0;
  for (const LogLine& line : log_since(lines)) reported += line.text.find("256 MB") != std::string::npos ? 1 : 0;
  EXPECT_EQ(reported, 1u);
  show.send("/transport/rewind", 30);
  show.engine.idle();
  EXPECT_NE(show.sent_texts().back().find("history is limited to 256 MB"), std::string::npos);
}

TEST(History, TakesWithRewindsReplay) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  log_to_stderr(false);
  const std::string take = folder.path("rewound.take");
  std::uint64_t hash = 0;
  {
    EngineOptions options = rewind_options(folder);
    options.record = take;
    Show show(options);
    Random random(9, "walk");
    for (int i = 0; i < 12; i++) {
      for (auto n = static_cast<int>(random.uniform(1, 80)); n > 0; n--) {
        random_inputs(show, show.engine.world().tick());
        show.ticks(1);
      }
      if (i == 6) show.send("/transport/pause");
      show.send("/transport/rewind", i == 3 ? 100 : random.uniform(0.01, 2));
      show.ticks(i % 2);
      show.send("/transport/play");
    }
    show.ticks(20);
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
  }
  expect_replay(take, hash);
}

TEST(History, ReplayedRewindSendsNoAnswers) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  const std::string take = folder.path("rewound.take");
  {
    EngineOptions options = rewind_options(folder);
    options.record = take;
    Show show(options);
    show.ticks(100);
    show.send("/transport/rewind", 0.5);
    show.send("/get", "/physics/sim/gravity");
    show.ticks(1);
    const std::vector<std::string> sent = show.sent_texts();
    EXPECT_TRUE(std::ranges::any_of(sent, [](const auto& text) { return text.starts_with("/physics/sim/gravity "); }));
    show.engine.end_take();
    show.engine.finish_saving();
  }
  EngineOptions options = fast_options();
  options.replay = take;
  Show show(options);
  while (!show.engine.replay_finished()) show.ticks(1);
  EXPECT_FALSE(show.engine.replay_result().diverged_at);
  for (const std::string& text : show.sent_texts()) {
    EXPECT_FALSE(text.starts_with("/physics/sim/gravity ")) << text;
    EXPECT_FALSE(text.starts_with("/transport/rewound")) << text;
  }
}

TEST(History, RestoresTheCheckpointBeforeATick) {
  const ShowFolder folder;
  write_rewind_scene(folder);
  Show show(rewind_options(folder));
  std::vector<std::uint64_t> hashes;
  play_to(show, 200, random_inputs, hashes);
  ASSERT_TRUE(show.engine.restore_before(150));
  const std::uint64_t tick = show.engine.world().tick();
  EXPECT_LT(tick, 150u);
  EXPECT_GE(tick, 89u);
  EXPECT_EQ(show.engine.state_hash(), hashes[tick]);
  EXPECT_TRUE(replays_identically(show, 200, random_inputs, hashes));
  EXPECT_FALSE(show.engine.restore_before(1));
}

}  // namespace
}  // namespace limber::engine::test

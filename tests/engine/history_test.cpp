// Time that goes back: what follows is what followed before, to the bit, however often; how far it goes, and what is
// said of it.
#include "engine/history.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/behaviors.h"
#include "engine/rewound.h"
#include "engine/taken.h"

namespace limber::engine_test {
namespace {

// a run that goes back by chance again and again, in every tick the same as one that never did
void expect_same_walk(const EngineOptions& options, TickHands hands, std::uint64_t ticks, std::uint64_t seed) {
  log_to_stderr(false);
  std::vector<std::uint64_t> hashes;
  {
    Show straight(options);
    play_to(straight, ticks, hands, hashes);
  }
  Show show(options);
  Random random(seed, "walk");
  int times = 0;
  for (std::uint64_t most = 1; most < ticks;) {
    const auto on = static_cast<std::uint64_t>(random.uniform(1, 90));
    if (!plays_again(show, std::min(ticks, show.engine.world().tick() + on), hands, hashes)) return;
    const std::uint64_t tick = show.engine.world().tick();
    if (tick == ticks) break;
    most = std::max(most, tick);
    show.outbox();
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

TEST(History, EveryBehaviorGoesTheSameWay) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  expect_same_walk(rewound_options(folder), no_hands, 500, 1);
}

TEST(History, ScriptsGoTheSameWay) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  expect_same_walk(rewound_options(folder), no_hands, 700, 2);
}

TEST(History, WithManyHandsToo) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  for (std::uint64_t seed = 3; seed < 6; seed++) expect_same_walk(rewound_options(folder), many_hands, 500, seed);
}

TEST(History, NothingIsSaidOrStoredTwice) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  Show show(rewound_options(folder));
  std::vector<std::uint64_t> hashes;
  play_to(show, 170, many_hands, hashes);
  show.outbox();
  const std::uint64_t lines = log_newest();
  const std::size_t changes = show.link.changes.after(0).size();
  const std::uint64_t faults = show.engine.faults();
  show.send("/transport/rewind", 0.5);
  show.engine.idle();
  const std::vector<std::string> out = show.outbox();
  ASSERT_EQ(out.size(), 2u) << fmt::format("{}", fmt::join(out, "\n"));
  EXPECT_EQ(out[0].substr(0, 16), "/transport/state");
  EXPECT_EQ(out[1], "/transport/rewound 0.5 140");
  EXPECT_EQ(log_newest(), lines);
  EXPECT_EQ(show.link.changes.after(0).size(), changes);
  EXPECT_EQ(show.engine.faults(), faults);
}

TEST(History, ItGoesAsFarAsItIsKept) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewound_options(folder));
  show.ticks(300);
  EXPECT_NEAR(show.read("/transport/rewindable"), 5, 0.05);
  EXPECT_GT(show.read("/transport/history_memory"), 0.1);
  show.outbox();
  show.send("/transport/rewind", 20);
  show.engine.idle();
  EXPECT_EQ(show.outbox().back().substr(0, 26), "/transport/rewound 4.98333");
  EXPECT_EQ(show.engine.world().tick(), 1u);
  show.send("/transport/rewind", 1);
  show.engine.idle();
  EXPECT_EQ(show.outbox().back(), "/error /transport/rewind time can't go back: the scene has begun there");
  // half a minute at most, or as the row says
  show.ticks(60 * 40);
  EXPECT_NEAR(show.read("/transport/rewindable"), 30.5, 0.51);
  show.send("/physics/sim/history", 5);
  show.ticks(2);
  EXPECT_NEAR(show.read("/transport/rewindable"), 5.5, 0.51);
  show.send("/physics/sim/history", 0);
  show.ticks(100);
  EXPECT_EQ(show.read("/transport/rewindable"), 0);
  EXPECT_EQ(show.read("/transport/history_memory"), 0);
  show.outbox();
  show.send("/transport/rewind", 1);
  show.engine.idle();
  EXPECT_EQ(show.outbox().back(), "/error /transport/rewind time can't go back: history is switched off");
  show.send("/physics/sim/history", 30);
  show.ticks(100);
  EXPECT_GT(show.read("/transport/rewindable"), 1);
}

TEST(History, WhatIsNoSpanIsRefused) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewound_options(folder));
  show.ticks(100);
  const std::uint64_t hash = show.engine.state_hash();
  const double bad[] = {0, -1, std::nan(""), std::numeric_limits<double>::infinity()};
  for (const double seconds : bad) {
    show.outbox();
    show.send("/transport/rewind", seconds);
    show.engine.idle();
    const std::vector<std::string> out = show.outbox();
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
  EXPECT_EQ(show.outbox().size(), 8u);
  EXPECT_EQ(show.engine.state_hash(), hash);
  EXPECT_EQ(show.engine.world().tick(), 100u);
}

TEST(History, StepsBackAndForthWhilePaused) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  Show show(rewound_options(folder));
  std::vector<std::uint64_t> hashes;
  play_to(show, 150, no_hands, hashes);
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

// what a hand sets while time stands still belongs to the tick at which it stands
TEST(History, WhatWasSetInAPauseStays) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewound_options(folder));
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

// of one datagram: what stands before it goes with the past, what stands behind it is done there
TEST(History, MessagesBesideARewind) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewound_options(folder));
  show.ticks(100);
  show.link.inbox.push({{message("/physics/body/body1/part/part1/mass", 7), message("/transport/rewind_ticks", 10),
                         message("/physics/body/body1/part/part2/mass", 9), message("/transport/pause")},
                        {Hand::osc}});
  show.ticks(1);
  EXPECT_EQ(show.engine.world().tick(), 90u);
  EXPECT_EQ(show.read("/physics/body/body1/part/part1/mass"), 1);
  EXPECT_EQ(show.read("/physics/body/body1/part/part2/mass"), 9);
  EXPECT_EQ(show.read("/physics/sim/paused"), 1);
  // and it can be undone
  show.send("/edit/undo");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/body/body1/part/part2/mass"), 1);
}

TEST(History, PresetsSpeedAndPauseAreOfTheHour) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kEveryBehavior);
  Show show(rewound_options(folder));
  show.ticks(100);
  show.send("/preset/store", "late");
  show.send("/physics/sim/speed", 2);
  show.ticks(10);
  show.send("/transport/rewind", 1);
  show.engine.idle();
  EXPECT_EQ(show.engine.presets().names(), "late");
  EXPECT_EQ(show.read("/physics/sim/speed"), 2);
}

TEST(History, WhatComesOrGoesIsAWall) {
  const ShowFolder folder;
  lay_out_rewound(folder, std::string(kRewoundScene) + R"(
osc:on("/spawn", function() sim:body("stone1"):copy("more", { position = vec3(0, 0, 5) }) end)
osc:on("/wind", function() sim:body("arm1"):add_behavior("random_force", "wind") end)
)");
  Show show(rewound_options(folder));
  const auto wall = [&](const char* address, const char* why) {
    show.ticks(150);
    const std::uint64_t tick = show.engine.world().tick();
    show.send(address);
    show.ticks(100);
    show.outbox();
    show.send("/transport/rewind", 20);
    show.engine.idle();
    const std::string out = show.outbox().back();
    EXPECT_NE(out.find(why), std::string::npos) << out;
    if (show.engine.world().tick() > 100) {
      EXPECT_GE(show.engine.world().tick(), tick) << address;
      EXPECT_LE(show.engine.world().tick(), tick + 60) << address;
    }
  };
  wall("/spawn", "things came or went");
  wall("/wind", "things came or went");
  wall("/physics/body/stone9/remove", "things came or went");
  wall("/transport/reset", "the scene has begun there");
  // in the tick of the rewind, before it: no state fits what there is
  show.ticks(150);
  show.outbox();
  show.link.inbox.push({{message("/physics/body/stone8/remove"), message("/transport/rewind_ticks", 20)}, {Hand::osc}});
  show.ticks(1);
  const std::vector<std::string> said = show.outbox();
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& line) {
    return line.find("time can't go back: things came or went") != line.npos;
  })) << said.size();
  show.ticks(30);
  show.send("/transport/rewind_ticks", 20);
  show.engine.idle();
  EXPECT_EQ(show.outbox().back().find("/error"), std::string::npos);
}

TEST(History, AReloadIsAWall) {
  Edited edited(
      "local b = sim:add_body('b'):add_part('p', sim:add_sphere_shape('s', 0.1))\nsim:on_step(function() end)");
  edited.show().ticks(120);
  EXPECT_EQ(edited.save(edited.text + "\nsim.gravity = vec3(1, 0, 0)"), Reload::End::applied);
  edited.show().ticks(90);
  edited.show().outbox();
  edited.show().send("/transport/rewind", 20);
  edited.show().engine.idle();
  EXPECT_NE(edited.show().outbox().back().find("the scene was run anew there"), std::string::npos);
  EXPECT_GE(edited.world().tick(), 120u);
  EXPECT_EQ(edited.show().read("/physics/sim/gravity", 0), 1);
}

// a call that was stopped is not made again, and what comes behind it is as it was
TEST(History, StoppedCallsStayStopped) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  log_to_stderr(false);
  EngineOptions options = rewound_options(folder);
  options.scene_options.limits.call_ms = 8 * kBudgetScale;
  const auto hands = [](Show& show, std::uint64_t tick) {
    many_hands(show, tick);
    if (tick % 50 == 20) show.send("/loop", static_cast<double>(tick));
  };
  Show show(options);
  std::vector<std::uint64_t> hashes;
  play_to(show, 230, hands, hashes);
  for (const double back : {2.5, 1.0, 3.3, 0.3}) {
    show.send("/transport/rewind", back);
    show.engine.idle();
    ASSERT_EQ(show.engine.state_hash(), hashes[show.engine.world().tick()]) << back;
    play_to(show, 230, hands, hashes);
  }
}

TEST(History, ALargeSceneKeepsLess) {
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
  Show show(rewound_options(folder));
  show.ticks(60 * 20);
  EXPECT_LE(show.read("/transport/history_memory"), 256);
  EXPECT_GT(show.read("/transport/history_memory"), 200);
  EXPECT_GT(show.read("/transport/rewindable"), 5);
  EXPECT_LT(show.read("/transport/rewindable"), 18);
  std::size_t said = 0;
  for (const LogLine& line : log_since(lines)) said += line.text.find("256 MB") != std::string::npos ? 1 : 0;
  EXPECT_EQ(said, 1u);
  show.send("/transport/rewind", 30);
  show.engine.idle();
  EXPECT_NE(show.outbox().back().find("more does not fit into 256 MB"), std::string::npos);
}

TEST(History, ATakeWithRewindsReplays) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  log_to_stderr(false);
  const std::string take = folder.path("rewound.take");
  std::uint64_t hash = 0;
  {
    EngineOptions options = rewound_options(folder);
    options.record = take;
    Show show(options);
    Random random(9, "walk");
    for (int i = 0; i < 12; i++) {
      for (auto n = static_cast<int>(random.uniform(1, 80)); n > 0; n--) {
        many_hands(show, show.engine.world().tick());
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

TEST(History, ReturnsToTheKeyStateBeforeATick) {
  const ShowFolder folder;
  lay_out_rewound(folder);
  Show show(rewound_options(folder));
  std::vector<std::uint64_t> hashes;
  play_to(show, 200, many_hands, hashes);
  ASSERT_TRUE(show.engine.return_before(150));
  const std::uint64_t tick = show.engine.world().tick();
  EXPECT_LT(tick, 150u);
  EXPECT_GE(tick, 89u);
  EXPECT_EQ(show.engine.state_hash(), hashes[tick]);
  EXPECT_TRUE(plays_again(show, 200, many_hands, hashes));
  EXPECT_FALSE(show.engine.return_before(1));
}

}  // namespace
}  // namespace limber::engine_test

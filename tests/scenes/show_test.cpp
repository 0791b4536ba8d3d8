// scripts/show.lua with its cues: they start at bars, the heads aim at their targets, and the arms follow the beat.
#include <algorithm>
#include <cmath>
#include <string>

#include "player.h"
#include "sim/fixtures/fixture_list.h"

namespace limber {
namespace {

TEST(ShowScene, ItsCuesFollowAtBars) {
  Player player("show.lua");
  player.play(1.0 / 60);
  EXPECT_EQ(player.value("/cue/current"), 1);
  // 12 s after its start, at the bar that is reached then
  player.play(11.9);
  EXPECT_EQ(player.value("/cue/current"), 1);
  player.play(2.2);
  EXPECT_EQ(player.value("/cue/current"), 2);
  player.play(8.5);
  EXPECT_NEAR(player.value("/scene/light"), 0.5, 1e-9) << "the preset of the second cue";
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(ShowScene, TheHeadsFollowTheHands) {
  Player player("show.lua");
  player.play(3);
  const auto& fixtures = player.world().visuals().fixtures().list();
  ASSERT_EQ(fixtures.size(), 16u);
  for (int tick = 0; tick < 60; tick++) {
    player.play(1.0 / 60);
    for (const auto& fixture : fixtures) {
      const sim::FixtureTarget& target = fixture->targets()[0];
      const sim::Part* const hand = player.body(target.body).find_part(target.part);
      const std::string path = "/lighting/fixture/" + fixture->name();
      const auto vec = [&](const char* name) {
        return Vec3(player.value(path + name, 0), player.value(path + name, 1), player.value(path + name, 2));
      };
      EXPECT_GT(glm::dot(normalized(hand->pose().position - vec("/position")), vec("/direction")), std::cos(0.1))
          << fixture->name();
    }
  }
}

// Without sway and energy, a strike is in each arm once in four beats.
TEST(ShowScene, TheArmsStrikeWithTheBeat) {
  Player player("show.lua");
  player.send("/cue/pause", {});
  player.play(0.1);
  for (const auto& [address, value] : {std::pair{"/scene/sway", 0.0}, {"/scene/energy", 0.0}, {"/scene/strike", 1.0}})
    player.send(address, {Arg::of(value)});
  player.play(2);
  double last = player.value("/physics/body/arm1/motor/joint_4/target");
  std::vector<double> beats;
  for (int tick = 0; tick < 480; tick++) {
    player.play(1.0 / 60);
    const double target = player.value("/physics/body/arm1/motor/joint_4/target");
    if (target > last + 0.2) beats.push_back(player.value("/clock/beat"));
    last = target;
  }
  ASSERT_EQ(beats.size(), 4u);
  for (const double beat : beats) EXPECT_NEAR(beat - 4 * std::round(beat / 4), 0, 0.1);
}

}  // namespace
}  // namespace limber

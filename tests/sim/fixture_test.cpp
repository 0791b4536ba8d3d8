// Lighting fixtures: aiming, motion within limits, channel values, addresses, and their part of the state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sim/counted_new.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/stage.h"
#include "sim/state/state_hash.h"
#include "sim/visuals/visuals.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kToRadians = kPi / 180;

// A world with one fixture that has these axes.
struct FixtureStage : WorldFixture {
  explicit FixtureStage(const std::string& profile_text, std::vector<FixtureTarget> targets = {}) {
    auto profile = parse_fixture_profile("test", profile_text);
    EXPECT_TRUE(profile.ok()) << (profile ? "" : profile.error());
    fixture = *world.visuals().fixtures().add("spot", *profile, std::move(targets), {});
  }
  double read(const char* property) const { return number(fixture->id(), property); }
  std::uint8_t channel(std::size_t number) {
    return world.visuals().fixtures().frame().universes.at(0).values.at(number - 1);
  }
  Fixture* fixture;
};

constexpr const char* kHead =
    "pan 540 240 800\ntilt 270 200 600\nzoom 10 40\nstrobe 1 21 50 250 7\n"
    "channel pan\nchannel pan_fine\nchannel tilt\nchannel tilt_fine\nchannel dimmer\nchannel red\nchannel green\n"
    "channel blue\nchannel white\nchannel zoom\nchannel strobe\nchannel constant 33\n";

// The least time that a rotation needs, over all ways to reach a direction: computed by trying every angle pair.
double least_time(const Vec3& direction, const PanTilt& from, const AxisLimits& pan, const AxisLimits& tilt) {
  const double p = std::atan2(direction.y, direction.x) / kToRadians;
  const double t = std::acos(std::clamp(direction.z, -1.0, 1.0)) / kToRadians;
  double least = 1e9;
  for (const bool flipped : {false, true}) {
    for (double at = p + (flipped ? 180 : 0) - 1800; at <= 1800; at += 360) {
      const double tilted = flipped ? -t : t;
      if (at < pan.low || at > pan.high || tilted < tilt.low || tilted > tilt.high) continue;
      least = std::min(least, std::max(std::abs(at - from.pan) / pan.speed, std::abs(tilted - from.tilt) / tilt.speed));
    }
  }
  return least;
}

TEST(FixtureAim, TakesTheShortestOfAllWays) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const AxisLimits pan{-270, 270, 240, 800};
  const AxisLimits tilt{-135, 135, 200, 600};
  int flips = 0;
  for (int i = 0; i < 20000; i++) {
    const Vec3 direction = normalized(Vec3(unit(random), unit(random), unit(random)));
    if (direction.z < -0.65 || std::hypot(direction.x, direction.y) < 1e-3) continue;
    const PanTilt from{270 * unit(random), 135 * unit(random)};
    const PanTilt to = aim_at(direction, from, pan, tilt, true);
    EXPECT_LT(glm::length(beam_direction(to) - direction), 1e-9);
    EXPECT_LE(std::abs(to.pan), 270 + 1e-9);
    EXPECT_LE(std::abs(to.tilt), 135 + 1e-9);
    const double time = std::max(std::abs(to.pan - from.pan) / pan.speed, std::abs(to.tilt - from.tilt) / tilt.speed);
    EXPECT_NEAR(time, least_time(direction, from, pan, tilt), 1e-6);
    flips += to.tilt < 0 ? 1 : 0;
    EXPECT_GE(aim_at(direction, from, pan, tilt, false).tilt, 0) << "without flip";
  }
  EXPECT_GT(flips, 1000);
}

TEST(FixtureAim, StaysWithinTheRangeForUnreachableDirections) {
  const AxisLimits pan{-90, 90, 100, 100};
  const AxisLimits tilt{-45, 45, 100, 100};
  const PanTilt down = aim_at({0, 0, -1}, {10, 0}, pan, tilt, true);
  EXPECT_EQ(std::abs(down.tilt), 45);
  EXPECT_EQ(down.pan, 10);
  const PanTilt behind = aim_at(normalized(Vec3(-1, 0, 1)), {0, 0}, pan, tilt, false);
  EXPECT_LE(std::abs(behind.pan), 90);
  EXPECT_NEAR(behind.tilt, 45, 1e-9);
}

TEST(FixtureMotion, NeverExceedsItsLimitsAndReachesItsTargetWithoutOvershoot) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int run = 0; run < 300; run++) {
    const double dt = 1.0 / (30 + 200 * unit(random));
    const AxisLimits limits{-1000, 1000, 40 + 300 * unit(random), 20 + 2000 * unit(random)};
    const double target = 400 * (unit(random) - 0.5);
    AxisMotion at{400 * (unit(random) - 0.5), 0};
    const double side = target - at.angle;
    for (int i = 0; i < 4000; i++) {
      const AxisMotion next = move_axis(at, target, limits, dt);
      ASSERT_LE(std::abs(next.velocity), limits.speed * (1 + 1e-12));
      ASSERT_LE(std::abs(next.velocity - at.velocity), limits.acceleration * dt * (1 + 1e-9));
      ASSERT_NEAR(next.angle, at.angle + next.velocity * dt, 1e-12);
      ASSERT_GE((target - next.angle) * (side < 0 ? -1 : 1), -1e-9) << "overshoot";
      at = next;
    }
    EXPECT_NEAR(at.angle, target, 1e-6);
  }
}

TEST(FixtureMotion, TakesTheTimeOfATrapezoid) {
  // 180° at 100°/s and 200°/s²: 0.5 s to accelerate, 0.5 s to stop, 25° each; the 130° between take 1.3 s
  const AxisLimits limits{-1000, 1000, 100, 200};
  AxisMotion at;
  int ticks = 0;
  while (std::abs(at.angle - 180) > 1e-6 && ticks < 10000) {
    at = move_axis(at, 180, limits, 0.001);
    ticks++;
  }
  EXPECT_NEAR(0.001 * ticks, 2.3, 0.01);
}

TEST(Fixture, JumpingTargetsNeverExceedSpeedAndAcceleration) {
  FixtureStage s(kHead);
  s.set(s.fixture->id(), "aim", {1});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-4, 4);
  const double dt = s.world.timestep();
  double pan_before = 0, tilt_before = 0, pan_speed_before = 0, tilt_speed_before = 0;
  for (int i = 0; i < 5000; i++) {
    if (i % 7 == 0) s.set(s.fixture->id(), "point", {unit(random), unit(random), unit(random)});
    s.ticks(1);
    const double pan_speed = (s.read("pan") - pan_before) / dt;
    const double tilt_speed = (s.read("tilt") - tilt_before) / dt;
    ASSERT_LE(std::abs(pan_speed), 240 + 1e-6);
    ASSERT_LE(std::abs(tilt_speed), 200 + 1e-6);
    ASSERT_LE(std::abs(pan_speed - pan_speed_before), 800 * dt + 1e-6);
    ASSERT_LE(std::abs(tilt_speed - tilt_speed_before), 600 * dt + 1e-6);
    ASSERT_LE(std::abs(s.read("pan")), 270 + 1e-9);
    ASSERT_LE(std::abs(s.read("tilt")), 135 + 1e-9);
    pan_before = s.read("pan");
    tilt_before = s.read("tilt");
    pan_speed_before = pan_speed;
    tilt_speed_before = tilt_speed;
  }
}

TEST(Fixture, HangsAndShinesAtAPoint) {
  FixtureStage s(kHead);
  s.set(s.fixture->id(), "position", {1, 2, 4});
  s.set(s.fixture->id(), "rotation", {180, 0, 30});
  s.set(s.fixture->id(), "aim", {1});
  s.set(s.fixture->id(), "point", {2, -1, 0.5});
  s.ticks(300);
  EXPECT_LT(glm::length(s.vec(s.fixture->id(), "direction") - normalized(Vec3(1, -3, -3.5))), 1e-9);
  EXPECT_EQ(s.vec(s.fixture->id(), "origin"), Vec3(1, 2, 4));
}

TEST(Fixture, FollowsAPartAndItsAxisAndSurvivesItsRemoval) {
  FixtureStage s(kHead, {{"ball", "part1"}, {"missing", "none"}});
  EXPECT_EQ(s.read("aim"), 2) << "targets are aimed at by default";
  Body& ball = s.body("ball");
  const Part& part =
      *ball.add_part("part1", s.shape(sphere_model(0.1)), 0, {{3, 0, 3}, quat_axis({0, 1, 0}, 60 * kToRadians)})
           .value();
  s.ticks(300);
  EXPECT_LT(glm::length(s.vec(s.fixture->id(), "direction") - Vec3(1, 0, 0)), 1e-9);
  s.set(s.fixture->id(), "point", {0, 0, 1});
  s.ticks(300);
  EXPECT_LT(glm::length(s.vec(s.fixture->id(), "direction") - normalized(part.pose() * Vec3(0, 0, 1) - Vec3(0, 0, 3))),
            1e-9);
  s.set(s.fixture->id(), "aim", {3});
  s.ticks(300);
  EXPECT_LT(glm::length(s.vec(s.fixture->id(), "direction") - part.pose().rotation * Vec3(0, 0, 1)), 1e-6);
  const double pan = s.read("pan");
  s.set(s.fixture->id(), "target", {2});
  s.ticks(10);
  EXPECT_NEAR(s.read("pan"), pan, 1e-9) << "a part that does not exist";
  s.set(s.fixture->id(), "target", {1});
  s.world.remove_body(ball);
  s.ticks(10);
  EXPECT_NEAR(s.read("pan"), pan, 1e-9);
}

TEST(Fixture, ChannelsFollowTheFormulas) {
  FixtureStage s(kHead);
  const NodeId id = s.fixture->id();
  s.set(id, "pan_target", {100});
  s.set(id, "tilt_target", {-60});
  s.set(id, "dimmer", {0.5});
  s.set(id, "rgb", {1, 0.25, 0});
  s.set(id, "white", {0.1});
  s.set(id, "zoom", {25});
  s.set(id, "strobe", {11});
  s.ticks(300);
  const int pan = static_cast<int>(std::lround((100.0 / 540 + 0.5) * 65535));
  const int tilt = static_cast<int>(std::lround((-60.0 / 270 + 0.5) * 65535));
  EXPECT_EQ(s.read("pan_dmx"), pan);
  EXPECT_EQ(s.read("tilt_dmx"), tilt);
  const std::vector<int> expected = {pan / 256, pan % 256, tilt / 256, tilt % 256, 128, 255, 64, 0, 26, 128, 150, 33};
  for (std::size_t i = 0; i < expected.size(); i++) EXPECT_EQ(s.channel(i + 1), expected[i]) << i + 1;
  EXPECT_EQ(s.world.visuals().fixtures().frame().universes[0].length, 12);
  std::string text;
  for (const int each : expected) text += (text.empty() ? "" : " ") + std::to_string(each);
  const Property& dmx = Fixture::table().at("dmx");
  EXPECT_EQ(dmx.read_text(s.fixture), text);
  s.set(id, "strobe", {0});
  s.ticks(1);
  EXPECT_EQ(s.channel(11), 7);
}

TEST(Fixture, CalibrationMovesTheRealHeadOnly) {
  FixtureStage s(kHead);
  const NodeId id = s.fixture->id();
  s.set(id, "pan_home", {15});
  s.set(id, "pan_invert", {1});
  s.set(id, "pan_target", {100});
  s.ticks(300);
  EXPECT_NEAR(s.read("pan"), 100, 1e-9);
  EXPECT_EQ(s.read("pan_dmx"), std::lround((-85.0 / 540 + 0.5) * 65535));
  s.set(id, "pan_target", {400});  // beyond the end: the real head stops at -270, that is 285
  s.ticks(300);
  EXPECT_NEAR(s.read("pan"), 285, 1e-9);
  EXPECT_EQ(s.read("pan_dmx"), 0);
}

TEST(Fixture, MasterAndBlackoutDimTheLightOnly) {
  FixtureStage s("channel red\nchannel green\nchannel blue\nchannel constant 9\n");
  const NodeId lighting = s.world.visuals().fixtures().id();
  s.set(s.fixture->id(), "rgb", {1, 0.5, 0});
  s.set(s.fixture->id(), "dimmer", {0.5});
  s.set(lighting, "grand_master", {0.5});
  s.ticks(1);
  EXPECT_EQ(s.channel(1), 64) << "255 · 0.25";
  EXPECT_EQ(s.channel(2), 32);
  EXPECT_EQ(s.channel(4), 9);
  EXPECT_NEAR(s.vec(s.fixture->id(), "light").x, 0.25, 1e-12);
  s.set(lighting, "blackout", {1});
  s.world.flush();
  EXPECT_EQ(s.channel(1), 0) << "also while time is paused";
  EXPECT_EQ(s.channel(4), 9);
  EXPECT_EQ(s.world.visuals().fixtures().frame().universes[0].dark[3], 9);
}

TEST(Fixture, PanicStopsTheHeadWithinItsAcceleration) {
  FixtureStage s(kHead);
  s.set(s.fixture->id(), "pan_target", {250});
  s.ticks(30);
  const double speed = s.read("pan_velocity");
  ASSERT_GT(speed, 200);
  s.world.panic().begin();
  const double dt = s.world.timestep();
  for (double expected = speed; expected > 0;) {
    s.ticks(1);
    expected = std::max(0.0, expected - 800 * dt);
    ASSERT_NEAR(s.read("pan_velocity"), expected, 1e-9);
  }
  EXPECT_TRUE(s.world.visuals().fixtures().frame().panicked);
}

TEST(Fixture, AddressesDoNotOverlap) {
  WorldFixture s;
  FixtureList& fixtures = s.world.visuals().fixtures();
  const auto par = *generic_fixture_profile("rgbw_par");  // 6 channels
  EXPECT_EQ((*fixtures.add("a", par, {}, {1, 10}))->address(), 10);
  EXPECT_EQ((*fixtures.add("b", par, {}, {}))->address(), 1) << "the first free one";
  EXPECT_EQ((*fixtures.add("c", par, {}, {}))->address(), 16);
  const auto fault = [&](const FixtureList::Place& place) { return fixtures.add("d", par, {}, place).error(); };
  EXPECT_EQ(
      fault({1, 12}),
      "fixture 'd': channels 12 .. 17 of universe 1 overlap with channels 10 .. 15 of fixture 'a'. The first free "
      "address is 22");
  EXPECT_EQ(fault({1, 508}),
            "fixture 'd': has 6 channels, so its address must be a whole number from 1 to 507, got 508");
  EXPECT_EQ(fault({0, 1}), "fixture 'd': the universe must be a whole number from 1 to 32767, got 0");
  EXPECT_EQ(fault({1.5, 1}), "fixture 'd': the universe must be a whole number from 1 to 32767, got 1.5");
  EXPECT_EQ(fixtures.list().size(), 3u);
  EXPECT_TRUE(fixtures.add("d", par, {}, {2, 12}).ok()) << "another universe";
  const double too_high = 510;
  const auto set = s.store.set(fixtures.find("a")->id(), "address", {&too_high, 1});
  EXPECT_FALSE(set.ok());
  s.ticks(1);
  ASSERT_EQ(fixtures.frame().universes.size(), 2u);
  EXPECT_EQ(fixtures.frame().universes[0].length, 21);
  EXPECT_EQ(fixtures.frame().universes[1].number, 2);
}

TEST(Fixture, ReportsOverlapsThatArePlayed) {
  WorldFixture s;
  FixtureList& fixtures = s.world.visuals().fixtures();
  const auto par = *generic_fixture_profile("rgb_par");
  (void)fixtures.add("a", par, {}, {});
  Fixture& b = **fixtures.add("b", par, {}, {});
  s.ticks(1);
  const std::uint64_t seen = log_since(0).empty() ? 0 : log_since(0).back().number;
  s.set(b.id(), "address", {2});
  s.ticks(5);
  std::string text;
  for (const LogLine& line : log_since(seen)) text += line.text;
  EXPECT_EQ(text,
            "fixtures 'a' (channels 1 .. 3) and 'b' (channels 2 .. 4) overlap in universe 1; the later one sets the "
            "values. Change an address");
}

TEST(Fixture, IsPartOfTheStateHash) {
  WorldFixture none;
  WorldFixture also_none;
  const Property& master = FixtureList::table().at("grand_master");
  const double half = 0.5;
  (void)also_none.store.set(also_none.world.visuals().fixtures().id(), master, {&half, 1});
  none.ticks(3);
  also_none.ticks(3);
  EXPECT_EQ(none.world.state_hash(), also_none.world.state_hash());
  FixtureStage a(kHead);
  FixtureStage b(kHead);
  a.set(a.fixture->id(), "pan_target", {50});
  b.set(b.fixture->id(), "pan_target", {50});
  a.ticks(5);
  b.ticks(5);
  EXPECT_EQ(a.world.state_hash(), b.world.state_hash());
  a.set(a.fixture->id(), "pan_target", {51});
  const std::uint64_t before = b.world.state_hash();
  b.set(b.fixture->id(), "dimmer", {0.3});
  EXPECT_NE(b.world.state_hash(), before);
}

TEST(Fixture, RemovalInAGuardedCallIsRolledBack) {
  FixtureStage s(kHead);
  const NodeId id = s.fixture->id();
  s.world.transaction().begin();
  (void)s.fixture->act_remove({});
  EXPECT_FALSE(s.store.alive(id));
  EXPECT_EQ(s.world.visuals().fixtures().list().size(), 0u);
  s.world.transaction().rollback();
  EXPECT_TRUE(s.store.alive(id));
  s.ticks(1);
  EXPECT_EQ(s.world.visuals().fixtures().find("spot"), s.fixture);
  s.world.transaction().begin();
  (void)s.fixture->act_remove({});
  s.world.transaction().commit();
  s.ticks(2);
  EXPECT_FALSE(s.store.alive(id));
  EXPECT_TRUE(s.world.visuals().fixtures().frame().universes.empty());
}

TEST(Fixture, TicksDoNotAllocate) {
  FixtureStage s(kHead);
  for (int i = 0; i < 20; i++)
    (void)s.world.visuals().fixtures().add("f" + std::to_string(i), s.fixture->shared_profile(), {}, {});
  s.ticks(30);
  const Property& target = Fixture::table().at("pan_target");
  const std::size_t before = allocations();
  for (int i = 0; i < 50; i++) {
    const double value = i;
    (void)s.store.set(s.fixture->id(), target, {&value, 1});
    s.world.step();
  }
  EXPECT_EQ(allocations() - before, 0u);
}

TEST(FixtureProfiles, GenericOnesAreValidAndUnknownOnesAreExplained) {
  EXPECT_EQ(generic_fixture_names(), (std::vector<std::string_view>{"dimmer", "moving_beam", "moving_spot",
                                                                    "moving_wash", "rgb_par", "rgbw_par"}));
  for (const std::string_view name : generic_fixture_names()) {
    const auto profile = generic_fixture_profile(name);
    ASSERT_TRUE(profile.ok()) << profile.error();
    EXPECT_FALSE((*profile)->description.empty()) << name;
  }
  EXPECT_EQ(generic_fixture_profile("moving_spott").error(),
            "there is no fixture profile 'moving_spott'; did you mean 'moving_spot'?");
}

TEST(FixtureProfiles, ErrorsNameLineProblemAndFix) {
  const auto fault = [](const std::string& text) {
    const auto profile = parse_fixture_profile("a.fixture", text);
    return profile ? "valid" : profile.error();
  };
  EXPECT_EQ(fault("channel dimmer # the lamp\n"), "valid");
  EXPECT_EQ(fault(""), "a.fixture: has no channels. Add lines such as: channel dimmer");
  EXPECT_EQ(fault("\nchanel dimmer"), "a.fixture:2: unknown keyword 'chanel'; did you mean 'channel'?");
  EXPECT_EQ(fault("channel dimer"), "a.fixture:1: unknown function 'dimer'; did you mean 'dimmer'?");
  EXPECT_EQ(fault("channel"), "a.fixture:1: 'channel' needs the name of its function, such as: channel dimmer");
  EXPECT_EQ(fault("channel red\nchannel red"), "a.fixture:2: a second channel 'red'. Each function has one channel");
  EXPECT_EQ(fault("channel red 5"), "a.fixture:1: 'channel red' takes no further words, got '5'");
  EXPECT_EQ(fault("channel constant 256"),
            "a.fixture:1: 'channel constant': the value must be a whole number from 0 to 255, got '256'");
  EXPECT_EQ(fault("pan 540 240\nchannel pan"),
            "a.fixture:1: 'pan' takes 3 numbers (range in deg, speed in deg/s, acceleration in deg/s²), got 2");
  EXPECT_EQ(fault("pan 540 nan 800\nchannel pan"),
            "a.fixture:1: 'pan': the speed in deg/s must be a number from 0.1 to 10000, got 'nan'");
  EXPECT_EQ(fault("pan 540 240 800\npan 540 240 800"),
            "a.fixture:2: 'pan' is declared twice. Remove one of both lines");
  EXPECT_EQ(fault("channel pan"), "a.fixture: channel 'pan' needs its limits, such as: pan 540 240 800");
  EXPECT_EQ(fault("tilt 270 240 800\nchannel dimmer"), "a.fixture: declares 'tilt' without a channel 'tilt'");
  EXPECT_EQ(fault("channel dimmer_fine"), "a.fixture: channel 'dimmer_fine' needs a channel 'dimmer'");
  EXPECT_EQ(fault("zoom 40 8\nchannel zoom"), "a.fixture:1: 'zoom': 40 must be less than 8");
  EXPECT_EQ(fault("beam 20\nzoom 8 40\nchannel zoom"), "a.fixture: has both 'zoom' and 'beam'. Keep one of both lines");
  std::string many;
  for (int i = 0; i < 513; i++) many += "channel constant 0\n";
  EXPECT_EQ(fault(many), "a.fixture:513: a fixture has at most 512 channels");
  EXPECT_EQ(fault(std::string(70000, ' ')), "a.fixture: a profile has at most 65536 bytes, not 70000");
  EXPECT_EQ(fault("chan\x1bnel\n"), "a.fixture:1: unknown keyword 'chan\\x1bnel'; did you mean 'channel'?");
}

}  // namespace
}  // namespace limber::sim

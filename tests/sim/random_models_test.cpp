// Random scenes keep the properties of physics: finite, deterministic, no energy from nothing. LIMBER_RANDOM_MODELS
// sets the number of scenes, LIMBER_RANDOM_FIRST the first one.
#include "sim/random_models.h"

#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "support/skip.h"

namespace limber::sim::test {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text == nullptr ? fallback : std::strtoull(text, nullptr, 10);
}

/// Two runs over differently filled heap and stack; reports reads of uninitialized variables as a difference.
RandomOutcome play_twice(std::uint64_t number, const RandomSceneOptions& options) {
  mallopt(M_PERTURB, 0x11);
  const RandomOutcome first = play_random_scene(number, 0x11, 2, options);
  mallopt(M_PERTURB, 0x7f);
  const RandomOutcome second = play_random_scene(number, 0x7f, 2, options);
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(first.finite) << "scene " << number;
  EXPECT_EQ(first.hash, second.hash) << "scene " << number;
  return first;
}

/// Upper bound of the unexplained energy, J: motors that change a part's speed by tens of rad/s in a step leave an
/// error of second order.
double allowed_excess(const RandomOutcome& o) { return 0.02 * o.max_kinetic + 2e-3 * o.absolute_work + 1e-3; }

/// Plays scenes of a plan (by default the first 12). Of 200 scenes, one may gain energy or be unstable: chains of very
/// different masses that rotate by a radian in a step do.
void play_scenes(const RandomSceneOptions& options) {
  const std::uint64_t first = from_environment("LIMBER_RANDOM_FIRST", 1);
  const std::uint64_t count = from_environment("LIMBER_RANDOM_MODELS", 12);
  std::uint64_t failures = 0;
  std::string report;
  for (std::uint64_t n = first; n < first + count; n++) {
    const RandomOutcome o = play_twice(n, options);
    if ((n - first + 1) % 1000 == 0) std::printf("%llu scenes\n", static_cast<unsigned long long>(n - first + 1));
    // the iterative solver can't close all loops: such scenes may be unstable
    if (o.iterative || (o.excess <= allowed_excess(o) && o.health_events == 0)) continue;
    failures++;
    report += fmt::format("\nscene {}: {:.3g} J of {:.3g} J unexplained at {:.3f} s, {} instabilities", n, o.excess,
                          o.max_kinetic, o.created_at, o.health_events);
  }
  EXPECT_LE(failures, count / 200) << report;
  if (failures > 0) std::printf("%s\n", report.c_str());
}

TEST(RandomModels, TreesWithoutContactsGainNoEnergy) {
  LIMBER_SKIP_IF(is_emulated(), "random scenes");
  play_scenes({.contacts = false, .loops = false, .iterative = false});
}

TEST(RandomModels, TreesInContactGainNoEnergy) {
  LIMBER_SKIP_IF(is_emulated(), "random scenes");
  play_scenes({.loops = false, .iterative = false});
}

TEST(RandomModels, NoSceneGainsEnergy) {
  LIMBER_SKIP_IF(is_emulated(), "random scenes");
  play_scenes({});
}

TEST(RandomModels, JointsOfTreesStayClosed) {
  LIMBER_SKIP_IF(is_emulated(), "random scenes");
  for (std::uint64_t n = 1; n <= 12; n++) {
    const RandomOutcome o = play_random_scene(n, 0, 2, {.contacts = false, .loops = false, .iterative = false});
    EXPECT_LE(o.created, 0.1 * o.max_kinetic + 1e-3) << "scene " << n << " at " << o.created_at << " s";
    EXPECT_LE(o.gap, 0.002) << "scene " << n;
    EXPECT_EQ(o.fallbacks, 0u) << "scene " << n;
  }
}

/// Scenes that once failed: 2, because the account counted work of a motor at its limit; 26, 77, 93, 157, 282 and 400,
/// because of fallbacks or instabilities in contact; 66 and 186, because of uninitialized variables; 1176, because of a
/// diverging drift correction (one of its islands may still be solved by iteration).
class FormerFailure : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(FormerFailure, Passes) {
  const RandomOutcome o = play_twice(GetParam(), {.iterative = false});
  EXPECT_LE(o.excess, allowed_excess(o));
  EXPECT_EQ(o.health_events, 0u);
  EXPECT_LE(o.fallbacks, GetParam() == 1176 ? 1u : 0u);
}

INSTANTIATE_TEST_SUITE_P(RandomModels, FormerFailure, ::testing::Values(2, 26, 66, 77, 93, 157, 186, 282, 400, 1176));

// A servo of 10 N·m holds a load and drops it: the account does not count work of the motor or of gravity as gained
// energy, but it does count an impulse that it can't see.
TEST(RandomModels, AccountFindsUnexplainedEnergy) {
  LIMBER_SKIP_IF(is_emulated(), "random scenes");
  WorldFixture s;
  s.set(s.world.id(), "timestep", {1.0 / 240});
  s.substeps(1);
  s.gravity({0, 0, -9.81});
  Body& robot = s.body("robot");
  Part& base = s.part(robot, sphere_model(0.05), 0);
  Part& link = s.part(robot, box_model({0.4, 0.1, 0.1}), 1, {{0.3, 0, 0}, quat_identity()});
  Joint& joint = *robot.add_joint("joint", base, link, model::JointType::revolute, Vec3(0), Vec3(0, 1, 0)).value();
  Motor& motor = *robot.add_motor(joint).value();
  s.set(motor.id(), "max_angular_force", {10, 10, 10});
  s.set(motor.id(), "target", {-1});
  s.world.flush();
  EnergyAccount energy(s);
  const auto steps = [&](int count) {
    for (int i = 0; i < count; i++) {
      energy.before();
      s.ticks(1);
      energy.after();
    }
  };
  steps(240);
  EXPECT_GT(energy.absolute_work(), 1);
  EXPECT_LE(energy.created(), 1e-3 * energy.absolute_work());
  s.set(motor.id(), "mode", {0});
  steps(60);
  EXPECT_LE(energy.created(), 1e-3 * energy.absolute_work());
  link.apply_impulse({0, 0, 5});
  energy.before();
  s.ticks(1);
  energy.after();
  EXPECT_GT(energy.created(), 1);
}

}  // namespace
}  // namespace limber::sim::test

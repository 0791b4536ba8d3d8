// Random scenes keep the properties of physics: finite, deterministic, no energy from nothing. LIMBER_RANDOM_MODELS
// sets the number of scenes, LIMBER_RANDOM_FIRST the first one.
#include "sim/random_models.h"

#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

namespace limber::test {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// Two runs over differently filled heap and stack; reports reads of uninitialized variables as a difference.
RandomOutcome play_twice(std::uint64_t number, const RandomPlan& plan) {
  mallopt(M_PERTURB, 0x11);
  const RandomOutcome first = play_random_scene(number, 0x11, 2, plan);
  mallopt(M_PERTURB, 0x7f);
  const RandomOutcome second = play_random_scene(number, 0x7f, 2, plan);
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(first.finite) << "scene " << number;
  EXPECT_EQ(first.hash, second.hash) << "scene " << number;
  return first;
}

/// Upper bound of the unexplained energy, J: motors that change a part's speed by tens of rad/s in a step leave an
/// error of second order.
double allowed_excess(const RandomOutcome& o) { return 0.02 * o.most_kinetic + 2e-3 * o.worked + 1e-3; }

/// Plays scenes of a plan (by default the first 12). Of 200 scenes, one may gain energy or be unstable: chains of very
/// different masses that rotate by a radian in a step do.
void play_scenes(const RandomPlan& plan) {
  const std::uint64_t first = from_environment("LIMBER_RANDOM_FIRST", 1);
  const std::uint64_t count = from_environment("LIMBER_RANDOM_MODELS", 12);
  std::uint64_t missed = 0;
  std::string which;
  for (std::uint64_t n = first; n < first + count; n++) {
    const RandomOutcome o = play_twice(n, plan);
    if ((n - first + 1) % 1000 == 0) std::printf("%llu scenes\n", static_cast<unsigned long long>(n - first + 1));
    // the iterative solver can't hold all loops together: those are unstable, and reported
    if (o.iterative || (o.excess <= allowed_excess(o) && o.health_events == 0)) continue;
    missed++;
    which += fmt::format("\nscene {}: {:.3g} J of {:.3g} J unexplained at {:.3f} s, {} instabilities", n, o.excess,
                         o.most_kinetic, o.created_at, o.health_events);
  }
  EXPECT_LE(missed, count / 200) << which;
  if (missed > 0) std::printf("%s\n", which.c_str());
}

TEST(RandomModels, TreesWithoutContactsGainNoEnergy) {
  play_scenes({.contacts = false, .loops = false, .iterative = false});
}

TEST(RandomModels, TreesInContactGainNoEnergy) { play_scenes({.loops = false, .iterative = false}); }

TEST(RandomModels, AnythingGainsNoEnergy) { play_scenes({}); }

TEST(RandomModels, JointsOfTreesHoldTogether) {
  for (std::uint64_t n = 1; n <= 12; n++) {
    const RandomOutcome o = play_random_scene(n, 0, 2, {.contacts = false, .loops = false, .iterative = false});
    EXPECT_LE(o.created, 0.1 * o.most_kinetic + 1e-3) << "scene " << n << " at " << o.created_at << " s";
    EXPECT_LE(o.gap, 0.002) << "scene " << n;
    EXPECT_EQ(o.fallbacks, 0u) << "scene " << n;
  }
}

/// Scenes that once failed: 2, by an account that took a motor at its stop for one that works; 26, 77, 93, 157, 282 and
/// 400, with fallbacks or instabilities in contact; 66 and 186, by uninitialized variables; 1176, by bends that grew.
class FormerFailure : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(FormerFailure, Passes) {
  const RandomOutcome o = play_twice(GetParam(), {.iterative = false});
  EXPECT_LE(o.excess, allowed_excess(o));
  EXPECT_EQ(o.health_events, 0u);
  EXPECT_EQ(o.fallbacks, 0u);
}

INSTANTIATE_TEST_SUITE_P(RandomModels, FormerFailure, ::testing::Values(2, 26, 66, 77, 93, 157, 186, 282, 400, 1176));

// A servo of 10 N·m drops what it lifts: the account sees the work of neither motor nor weight as gain, and that of a
// hidden impulse.
TEST(RandomModels, AccountSeesWhatNoMotorDid) {
  Stage s;
  s.set(s.world.id(), "timestep", {1.0 / 240});
  s.substeps(1);
  s.gravity({0, 0, -9.81});
  Body& robot = s.body("robot");
  Part& base = s.part(robot, sphere_model(0.05), 0);
  Part& link = s.part(robot, box_model({0.4, 0.1, 0.1}), 1, {{0.3, 0, 0}, quat_identity()});
  Joint& joint = *robot.add_joint("joint", base, link, JointType::revolute, Vec3(0), Vec3(0, 1, 0)).value();
  Motor& motor = *robot.add_motor(joint).value();
  s.set(motor.id(), "max_angular_force", {10, 10, 10});
  s.set(motor.id(), "target", {-1});
  s.world.settle();
  EnergyAccount energy(s);
  const auto steps = [&](int count) {
    for (int i = 0; i < count; i++) {
      energy.before();
      s.ticks(1);
      energy.after();
    }
  };
  steps(240);
  EXPECT_GT(energy.worked(), 1);
  EXPECT_LE(energy.created(), 1e-3 * energy.worked());
  s.set(motor.id(), "mode", {0});
  steps(60);
  EXPECT_LE(energy.created(), 1e-3 * energy.worked());
  link.apply_impulse({0, 0, 5});
  energy.before();
  s.ticks(1);
  energy.after();
  EXPECT_GT(energy.created(), 1);
}

}  // namespace
}  // namespace limber::test

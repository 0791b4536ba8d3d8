// The behaviors in behaviors_lua/ that have no built-in twin: each does as its first lines describe.
#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>

#include "player.h"
#include "sim/behavior/behavior_list.h"
#include "support/skip.h"

namespace limber {
namespace {

constexpr double kTick = 1.0 / 60;

// Plays a scene with the behaviors in behaviors_lua/; expects no faults.
struct BehaviorPlayer {
  explicit BehaviorPlayer(const std::string& scene) : player(show.write("scripts/scene.lua", scene)) {}
  ~BehaviorPlayer() { EXPECT_EQ(player.engine->faults(), 0u); }
  ShowFolder show;
  Player player;
};

TEST(Breathe, TargetsFollowTheSineWithIncreasingPhase) {
  BehaviorPlayer lua_scene(R"(
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("breathe", "breath", { rate = 0.3, depth = 0.4, lag = 0.7, offset = 0.2 })
)");
  Player& player = lua_scene.player;
  const sim::Body& arm = player.body("arm");
  for (int tick = 1; tick <= 240; tick++) {
    player.engine->tick();
    for (std::size_t i = 0; i < arm.motors().size(); i++) {
      const double phase = 2 * kPi * 0.3 * tick * kTick - 0.2 - static_cast<double>(i + 1) * 0.7;
      ASSERT_NEAR(player.value("/physics/body/arm/motor/" + arm.motors()[i]->name() + "/target"), 0.4 * std::sin(phase),
                  1e-9)
          << "motor " << i + 1 << " at tick " << tick;
    }
  }
  // a new rate continues from the current phase: no target jumps further than it moves in a tick
  const double before = player.value("/physics/body/arm/motor/joint_1/target");
  player.send("/physics/body/arm/behavior/breath/rate", {Arg::of(2.0)});
  player.engine->tick();
  EXPECT_LT(std::abs(player.value("/physics/body/arm/motor/joint_1/target") - before),
            0.4 * 2 * kPi * 2 * kTick + 1e-9);
}

TEST(Breathe, JointsSwingAsOftenAndAsDeep) {
  BehaviorPlayer lua_scene(R"(
sim.gravity = vec3()
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("breathe", "breath", { rate = 0.4, depth = 0.35, motors = "joint_2" })
)");
  Player& player = lua_scene.player;
  const sim::Joint& joint = *player.body("arm").find_joint("joint_2");
  player.play(2.5);
  double max_angle = 0, before = joint.value();
  std::vector<double> rises;  // times of its upward crossings of the middle, s
  for (int tick = 0; tick < 900; tick++) {
    player.engine->tick();
    const double now = joint.value();
    if (before < 0 && now >= 0) rises.push_back((tick - now / (now - before)) * kTick);
    max_angle = std::max(max_angle, std::abs(now));
    before = now;
  }
  ASSERT_EQ(rises.size(), 6u);
  EXPECT_NEAR((rises.back() - rises.front()) / 5, 1 / 0.4, 0.01);
  EXPECT_NEAR(max_angle, 0.35, 0.01);
}

// Returns the phase lag, rad, of a joint's oscillation at this frequency behind a cosine, from its angles at each tick.
double lag_of(const std::vector<double>& angles, double frequency) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < angles.size(); i++) {
    sum += angles[i] * std::polar(1.0, -2 * kPi * frequency * static_cast<double>(i) * kTick);
  }
  return -std::arg(sum);
}

TEST(Wave, CrestsTravelRateTimesLengthMotorsPerSecond) {
  BehaviorPlayer lua_scene(R"(
sim.gravity = vec3()
local arm = sim:load_urdf("urdf/arm17.urdf", { name = "arm" })
arm:add_behavior("wave", "crawl", { rate = 0.5, length = 8, depth = 0.2 })
)");
  Player& player = lua_scene.player;
  const sim::Body& arm = player.body("arm");
  player.play(4);  // until it swings evenly
  std::vector<std::vector<double>> angles(arm.joints().size());
  for (int i = 0; i < 480; i++) {  // four swings
    player.engine->tick();
    for (std::size_t k = 0; k < angles.size(); k++) angles[k].push_back(arm.joints()[k]->value());
  }
  // the phase lag from one joint to the next gives the speed of the wave
  double turned = 0;
  for (std::size_t k = 1; k < angles.size(); k++) {
    const double step = lag_of(angles[k], 0.5) - lag_of(angles[k - 1], 0.5);
    turned += step - 2 * kPi * std::floor(step / (2 * kPi));
  }
  const double motors_a_second = 0.5 * 2 * kPi * static_cast<double>(angles.size() - 1) / turned;
  EXPECT_NEAR(motors_a_second, 0.5 * 8, 0.1);
}

TEST(Wave, GrowsTowardsTheTip) {
  BehaviorPlayer lua_scene(R"(
sim.gravity = vec3()
local arm = sim:load_urdf("urdf/arm17.urdf", { name = "arm" })
arm:add_behavior("wave", "crawl", { rate = 1, depth = 0.2, growth = 1 })
)");
  Player& player = lua_scene.player;
  double root = 0, tip = 0;
  for (int i = 0; i < 120; i++) {
    player.engine->tick();
    root = std::max(root, std::abs(player.value("/physics/body/arm/motor/joint_1/target")));
    tip = std::max(tip, std::abs(player.value("/physics/body/arm/motor/joint_17/target")));
  }
  EXPECT_EQ(root, 0);
  EXPECT_NEAR(tip, 0.2, 0.001);
}

TEST(Follow, TheTipReachesATargetSetByOsc) {
  // an arm with its motors off hangs; its tip is moved by force alone
  BehaviorPlayer lua_scene(R"(
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm", motors = "off", position = vec3(0, 0, 2),
  rotation = quat.euler(math.pi, 0, 0) })
for motor in arm:motors() do motor.damping = 0.2 end
arm:add_behavior("follow", "hand", { parts = "tip", target = arm:part("tip").center })
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 0.5, position = vec3(3, 0, 1) })
ball:add_behavior("follow", "ball")
)");
  Player& player = lua_scene.player;
  const sim::Part& tip = *player.body("arm").find_part("tip");
  const sim::Part& ball = *player.body("ball").root();
  player.play(2);
  const Vec3 ball_offset(0, 2, 0);  // to avoid collisions
  for (const Vec3 target : {Vec3(0.5, 0.3, 0.9), Vec3(-0.6, 0.2, 1.1)}) {
    const auto arguments = [](const Vec3& at) { return std::vector<Arg>{Arg::of(at.x), Arg::of(at.y), Arg::of(at.z)}; };
    player.send("/physics/body/arm/behavior/hand/target", arguments(target));
    player.send("/physics/body/ball/behavior/ball/target", arguments(target + ball_offset));
    double tip_before = glm::distance(tip.center(), target);
    double ball_before = glm::distance(ball.center(), target + ball_offset);
    EXPECT_GT(tip_before, 0.3);
    for (int i = 0; i < 4; i++) {
      player.play(2);
      const double tip_now = glm::distance(tip.center(), target);
      const double ball_now = glm::distance(ball.center(), target + ball_offset);
      EXPECT_LT(tip_now, 0.7 * tip_before) << "after " << 2 * i + 2 << " s";
      EXPECT_LT(ball_now, 0.7 * ball_before) << "after " << 2 * i + 2 << " s";
      tip_before = tip_now;
      ball_before = ball_now;
    }
    EXPECT_LT(tip_before, 0.05);
    EXPECT_LT(ball_before, 0.05) << "although it has a weight";
  }
}

TEST(Orbit, ReachesItsRadiusAndSpeed) {
  BehaviorPlayer lua_scene(R"(
local ball = sim:add_sphere_shape("ball", 0.05)
for i, place in ipairs { vec3(0.1, 0, 1), vec3(3, 0, 2), vec3(0, 0, 1) } do
  local moon = sim:add_body("moon" .. i)
  moon:add_part("moon", ball, { mass = 0.2 * i, position = place })
  moon:add_behavior("orbit", "round", { center = vec3(0, 0, 1), axis = vec3(0, 1, 4), radius = 0.8, speed = -1.5 })
end
)");
  Player& player = lua_scene.player;
  player.play(8);
  const Vec3 axis = normalized(Vec3(0, 1, 4));
  for (int tick = 0; tick < 240; tick++) {
    player.engine->tick();
    for (const char* name : {"moon1", "moon2", "moon3"}) {
      const sim::Part& moon = *player.body(name).root();
      const Vec3 from = moon.center() - Vec3(0, 0, 1);
      const double height = glm::dot(from, axis);
      const Vec3 flat = from - axis * height;
      ASSERT_NEAR(glm::length(flat), 0.8, 0.04) << name;
      ASSERT_NEAR(height, 0, 0.04) << name;
      ASSERT_NEAR(glm::dot(moon.linear_velocity(), glm::cross(axis, flat / glm::length(flat))), -1.5, 0.075) << name;
    }
  }
}

TEST(Balance, APushedPoleReturns) {
  BehaviorPlayer lua_scene(R"(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
local pole = sim:add_body("pole")
pole:add_part("pole", sim:add_cylinder_shape("pole", 0.08, 1), { mass = 1, position = vec3(0, 0, 0.5) })
pole:add_behavior("balance", "upright")
osc:on("/push", function(angle)
  pole.rotation = quat.axis(vec3(1, 1, 0), math.rad(angle))
  pole.position = vec3(0, 0, 0.6)
end)
)");
  Player& player = lua_scene.player;
  const sim::Part& pole = *player.body("pole").root();
  const auto off_upright = [&] {
    return std::acos(std::clamp((pole.pose().rotation * Vec3(0, 0, 1)).z, -1.0, 1.0)) * 180 / kPi;
  };
  player.play(0.5);
  for (const double angle : {20.0, 80.0}) {
    player.send("/push", {Arg::of(angle)});
    player.engine->tick();
    EXPECT_GT(off_upright(), angle - 5);
    player.play(4);
    EXPECT_LT(off_upright(), 2);
  }
  // without it, it falls
  player.send("/physics/body/pole/behavior/upright/active", {Arg::of(0.0)});
  player.send("/push", {Arg::of(20.0)});
  player.play(4);
  EXPECT_GT(off_upright(), 60);
}

// Statistics of sixty birds that start with random headings.
struct Birds {
  double polarization = 0;  // 1: all fly in one direction; about 0.1: random directions
  double speed = 0;         // mean, m/s
  double nearest = 1e9;     // of any two, m
  double spread = 0;        // mean distance from their center, m
};

Birds simulate_birds(const std::string& opts, double seconds) {
  BehaviorPlayer lua_scene(R"(
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.05)
local birds = {}
for i = 1, 60 do
  birds[i] = sim:add_body("bird" .. i)
  birds[i]:add_part("bird", ball, { mass = 0.1, position = rng:uniform(vec3(-1, -1, -1), vec3(1, 1, 1)) * 1.5 })
end
sim:add_group_behavior("flock", "swarm", { bodies = "bird*", )" +
                           opts + R"( })
sim:on_start(function() for _, bird in ipairs(birds) do bird.linear_velocity = rng:direction() end end)
)");
  lua_scene.player.play(seconds);
  Birds now;
  const auto& bodies = lua_scene.player.world().bodies();
  Vec3 mean_direction(0), middle(0);
  for (const auto& bird : bodies) {
    mean_direction += normalized(bird->root()->linear_velocity()) / 60.0;
    middle += bird->root()->center() / 60.0;
    now.speed += glm::length(bird->root()->linear_velocity()) / 60;
  }
  now.polarization = glm::length(mean_direction);
  for (const auto& a : bodies) {
    now.spread += glm::distance(a->root()->center(), middle) / 60;
    for (const auto& b : bodies) {
      if (a != b) now.nearest = std::min(now.nearest, glm::distance(a->root()->center(), b->root()->center()));
    }
  }
  return now;
}

TEST(Flock, BirdsAlignTheirHeadings) {
  const Birds at_first = simulate_birds("", 0.02), later = simulate_birds("", 20);
  EXPECT_LT(at_first.polarization, 0.35);
  EXPECT_GT(later.polarization, 0.9);
  EXPECT_NEAR(later.speed, 1, 0.1);
  EXPECT_GT(later.nearest, 0.1);
  EXPECT_LT(later.spread, 2 * at_first.spread);
}

// Each rule of the flock is needed for its effect.
TEST(Flock, WithoutAlignmentHeadingsDiffer) {
  LIMBER_SKIP_IF(kAddressSanitizer, "BirdsAlignTheirHeadings executes the same code");
  const Birds birds = simulate_birds("alignment = 0", 20);
  EXPECT_LT(birds.polarization, 0.6);
}

TEST(Flock, WithoutCohesionTheyScatter) {
  LIMBER_SKIP_IF(kAddressSanitizer, "BirdsAlignTheirHeadings executes the same code");
  const Birds with = simulate_birds("", 20), without = simulate_birds("cohesion = 0", 20);
  EXPECT_GT(without.spread, 3 * with.spread);
}

TEST(Flock, WithoutSeparationTheyHuddle) {
  LIMBER_SKIP_IF(kAddressSanitizer, "BirdsAlignTheirHeadings executes the same code");
  const Birds with = simulate_birds("", 20), without = simulate_birds("separation = 0", 20);
  EXPECT_LT(without.spread, 0.5 * with.spread);
  EXPECT_LT(without.nearest, with.nearest);
}

// Each behavior documents its purpose and its parameters.
TEST(BehaviorsLua, AreDocumented) {
  std::string scene = "local arm = sim:load_urdf('urdf/arm6.urdf', { name = 'arm' })\n";
  std::vector<std::string> types;
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/behaviors_lua")) {
    if (entry.path().extension() != ".lua") continue;
    types.push_back(entry.path().stem().string());
    std::ifstream in(entry.path());
    std::string first;
    std::getline(in, first);
    EXPECT_TRUE(first.starts_with("-- ")) << entry.path();
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    scene += text.find("group = true") != std::string::npos
                 ? "sim:add_group_behavior('" + types.back() + "', '" + types.back() + "')\n"
                 : "arm:add_behavior('" + types.back() + "', '" + types.back() + "')\n";
  }
  EXPECT_GE(types.size(), 18u);
  BehaviorPlayer lua_scene(scene);
  for (const std::string& name : types) {
    const auto type = lua_scene.player.world().behaviors().types().find(name);
    ASSERT_NE(type, nullptr) << name;
    EXPECT_GT(type->doc.size(), 20u) << name;
    for (const Property& property : type->table->properties())
      EXPECT_GT(property.doc.size(), 5u) << name << " " << property.name;
  }
  lua_scene.player.play(2);
}

// A ball of 1 kg without gravity: its velocity changes by force·dt in each tick.
struct QualityBall {
  explicit QualityBall(const std::string& opts)
      : lua_scene(R"(
sim.gravity = vec3()
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("s", 0.1), { mass = 1 })
ball:add_behavior("movement_quality", "quality", )" +
                  opts + ")") {}
  Vec3 velocity() { return lua_scene.player.body("ball").find_part("ball")->linear_velocity(); }
  // Returns the force of the next tick.
  Vec3 force() {
    const Vec3 before = velocity();
    lua_scene.player.engine->tick();
    return (velocity() - before) / kTick;
  }
  BehaviorPlayer lua_scene;
};

TEST(MovementQuality, ForcesKeepTheirDirectionForTheInterval) {
  QualityBall ball("{ quality = 'particles', force = 2 }");
  Vec3 direction = ball.force();
  int changes = 0;
  for (int tick = 1; tick < 180; tick++) {
    const Vec3 force = ball.force();
    EXPECT_NEAR(glm::length(force), 2, 1e-3);
    if (glm::distance(force, direction) > 1e-2) changes++;
    direction = force;
  }
  EXPECT_EQ(changes, 9) << "every 0.3 s within 3 s";
  QualityBall floating("{ quality = 'levitation' }");
  floating.lua_scene.player.play(4.9);
  EXPECT_NEAR(glm::length(floating.velocity()), 4.9, 0.05) << "one direction for 5 s";
}

// The force falls linearly to 0 during the morph, so the ball gets half of force·morph.
TEST(MovementQuality, AMorphFadesTheOldQualityOut) {
  QualityBall ball("{ quality = 'levitation', morph = 2 }");
  ball.lua_scene.player.play(1);
  ball.lua_scene.player.send("/physics/body/ball/behavior/quality/quality", {Arg::of("none")});
  ball.lua_scene.player.play(2.5);
  EXPECT_NEAR(glm::length(ball.velocity()), 1 + 1, 0.03);
  EXPECT_NEAR(glm::length(ball.force()), 0, 1e-9);
}

TEST(MovementQuality, ThrustingMovesTheTwoMotorsNextToTheRoot) {
  BehaviorPlayer lua_scene(R"(
sim.gravity = vec3()
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("movement_quality", "quality", { quality = "thrusting", reach = 0.8 })
)");
  Player& player = lua_scene.player;
  double farthest = 0;
  for (int tick = 0; tick < 300; tick++) {
    player.engine->tick();
    for (int motor = 1; motor <= 6; motor++) {
      const double target = player.value(fmt::format("/physics/body/arm/motor/joint_{}/target", motor));
      EXPECT_LE(std::abs(target), 0.8 + 1e-6);
      if (motor > 2) {
        EXPECT_EQ(target, 0) << motor;
      }
      farthest = std::max(farthest, std::abs(target));
    }
  }
  EXPECT_GT(farthest, 0.2);
}

}  // namespace
}  // namespace limber

// The scenes with mechanisms move as their geometry and their forces predict.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "app/program.h"
#include "player.h"
#include "sim/world/joint.h"
#include "support/skip.h"

namespace limber {
namespace {

struct Point {
  double x, z;
};

// The point at the distances r from p and s from q, on the left (side 1) or right (-1) of the way from p to q.
Point meet(Point p, double r, Point q, double s, int side) {
  const double dx = q.x - p.x, dz = q.z - p.z, length = std::hypot(dx, dz);
  const double along = (r * r - s * s + length * length) / (2 * length);
  const double aside = side * std::sqrt(r * r - along * along);
  return {p.x + (along * dx - aside * dz) / length, p.z + (along * dz + aside * dx) / length};
}

// The toe of Jansen's leg for an angle of its crank, in cm.
Point toe_of(double angle) {
  const Point pivot{38, -7.8}, pin{15 * std::cos(angle), 15 * std::sin(angle)};
  const Point knee = meet(pin, 50, pivot, 41.5, 1), ankle = meet(pin, 61.9, pivot, 39.3, -1);
  const Point hip = meet(pivot, 40.1, knee, 55.8, -1);
  return meet(ankle, 49, meet(hip, 39.4, ankle, 36.7, 1), 65.7, -1);
}

// How far the lowest of six toes, in phases of a sixth, carries the body per turn of the crank, in m.
double way_per_turn() {
  constexpr int kSteps = 3600;
  const auto toes = [](int step) {
    std::array<Point, 6> list{};
    for (std::size_t n = 0; n < 3; n++) {
      const double angle = 2 * kPi * (step / double{kSteps} + static_cast<double>(n) / 3);
      const Point back = toe_of(kPi - angle);
      list[2 * n] = toe_of(angle);
      list[2 * n + 1] = {-back.x, back.z};
    }
    return list;
  };
  double way = 0;
  for (int step = 0; step < kSteps; step++) {
    const std::array<Point, 6> now = toes(step), next = toes(step + 1);
    const auto lowest = std::min_element(now.begin(), now.end(), [](Point a, Point b) { return a.z < b.z; });
    way += next[static_cast<std::size_t>(lowest - now.begin())].x - lowest->x;
  }
  return std::abs(way) / 100;
}

double largest_gap(const Player& player, const std::string& body) {
  double largest = 0;
  for (const auto& joint : player.body(body).joints()) {
    double gap[3] = {};
    const sim::Joint& each = *joint;
    player.engine->store().get(each.id(), sim::Joint::table().at("offsets"), gap);
    largest = std::max(largest, std::hypot(gap[0], gap[1], gap[2]));
  }
  return largest;
}

// 0.4 turns per second; feet slip a little
TEST(Mechanisms, TheStrandbeestWalksAsFarAsItsGeometrySays) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  Player player("strandbeest.lua");
  const sim::Part& frame = *player.body("beest").root();
  player.play(2);
  const double start = frame.pose().position.x;
  double gap = 0;
  for (int tick = 0; tick < 60 * 10; tick++) {
    player.engine->tick();
    gap = std::max(gap, largest_gap(player, "beest"));
    ASSERT_GT(frame.pose().position.z, 0.9);
    ASSERT_GT((frame.pose().rotation * Vec3(0, 0, 1)).z, 0.999) << "at " << player.world().time() << " s";
  }
  const double turns = 0.4 * 10;
  EXPECT_NEAR((frame.pose().position.x - start) / turns, way_per_turn(), 0.05 * way_per_turn());
  EXPECT_NEAR(frame.pose().position.y, 0, 0.05);
  EXPECT_LT(gap, 1e-4);
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Mechanisms, TheStrandbeestTurnsToTheLeft) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  Player player("strandbeest.lua");
  player.send("/scene/turn", {Arg::of(0.5)});
  player.play(6);
  const sim::Part& frame = *player.body("beest").root();
  const Vec3 ahead = frame.pose().rotation * Vec3(1, 0, 0);
  EXPECT_GT(std::atan2(ahead.y, ahead.x), 0.7);
  EXPECT_GT(frame.pose().position.z, 0.9);
}

Vec3 pen_of(const Player& player) {
  return player.body("delta").find_part("platform")->pose().position - Vec3(0, 0, 0.1);
}

TEST(Mechanisms, TheDeltaRobotFollowsACircleAndStaysLevel) {
  Player player("delta.lua");
  player.send("/scene/figure", {Arg::of(std::string("circle"))});
  player.play(1);
  double error = 0, tilt = 0, gap = 0;
  for (int tick = 61; tick <= 360; tick++) {
    player.engine->tick();
    const double phase = 2 * kPi * 0.2 * tick / 60;
    const Vec3 place{0.28 * std::cos(phase), 0.28 * std::sin(phase), 0.62};
    error = std::max(error, glm::length(pen_of(player) - place));
    const Quat rotation = player.body("delta").find_part("platform")->pose().rotation;
    tilt = std::max(tilt, std::hypot(rotation.x, rotation.y, rotation.z));
    gap = std::max(gap, largest_gap(player, "delta"));
  }
  EXPECT_LT(error, 1e-4);
  EXPECT_LT(tilt, 1e-5);
  EXPECT_LT(gap, 1e-4);
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Mechanisms, TheDeltaRobotGoesToATarget) {
  Player player("delta.lua");
  player.play(0.5);
  player.send("/target", {Arg::of(0.2), Arg::of(-0.1), Arg::of(0.5)});
  player.play(0.5);
  EXPECT_LT(glm::length(pen_of(player) - Vec3(0.2, -0.1, 0.5)), 1e-4);
  // beyond the range, to its limit
  player.send("/target", {Arg::of(0.0), Arg::of(0.0), Arg::of(9.0)});
  player.play(0.5);
  EXPECT_LT(glm::length(pen_of(player) - Vec3(0, 0, 0.8)), 1e-4);
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Mechanisms, TheDeltaRobotReportsItsError) {
  Player player("delta.lua");
  player.play(1.5);
  player.sent();
  player.play(5);
  int reports = 0;
  for (const Message& message : player.sent()) {
    if (message.address != "/pen") continue;
    reports++;
    EXPECT_LT(message.args.at(3).number, 2e-4);
  }
  EXPECT_NEAR(reports, 100, 1);
}

const std::map<std::string, double> kThings = {{"cube", 0.2}, {"ball", 0.5}, {"block", 1.2}, {"can", 0.35}};  // kg

// A finger presses with safety·m·g/(2µ) while the thing hangs still, but with 3 N at least.
TEST(Mechanisms, TheGripperPressesAsTheWeightDemands) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  Player player("gripper.lua");
  std::map<std::string, int> held;
  std::map<std::string, double> rest, highest;
  for (int tick = 0; tick < 60 * 30; tick++) {
    player.engine->tick();
    const double force = player.value("/physics/body/gantry/part/left/contact_normal_force");
    for (const auto& [name, mass] : kThings) {
      const sim::Part& thing = *player.body(name).root();
      const double height = thing.pose().position.z;
      if (rest[name] == 0 && tick == 60) rest[name] = height;
      highest[name] = std::max(highest[name], height);
      if (tick <= 60 || height < rest[name] + 0.1 || glm::length(thing.linear_velocity()) > 0.005) continue;
      EXPECT_NEAR(force, std::max(3.0, 2 * mass * 9.81 / 2 / 0.5), 0.1 * force) << name << " at tick " << tick;
      held[name]++;
    }
  }
  for (const auto& [name, mass] : kThings) {
    EXPECT_GE(held[name], 5) << name << " is lifted";
    EXPECT_NEAR(highest[name] - rest[name], 0.25, 0.01) << name;
  }
  EXPECT_EQ(player.engine->faults(), 0u);
}

// Below 1, friction is at its limit and each force is smaller than the one before.
TEST(Mechanisms, AGripThatIsTooWeakSlips) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  Player player("gripper.lua");
  player.send("/scene/safety", {Arg::of(0.9)});
  player.play(1);
  const double rest = player.body("ball").root()->pose().position.z;
  double highest = 0, light = 0;
  for (int tick = 0; tick < 60 * 20; tick++) {
    player.engine->tick();
    highest = std::max(highest, player.body("ball").root()->pose().position.z);
    light = std::max(light, player.body("cube").root()->pose().position.z);
  }
  EXPECT_LT(highest, rest + 0.02);
  EXPECT_GT(light, 0.5) << "3 N hold the cube";
}

// twice with one thread, and with two
TEST(Mechanisms, TheirStateIsTheSameInEveryRun) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "golden scenes cover the same code");
  for (const std::string scene : {"strandbeest", "delta", "gripper"}) {
    const auto hash = [&](const char* threads) {
      const std::string file = LIMBER_SOURCE_DIR "/scripts/" + scene + ".lua";
      return app::test::run({file, "--fast", "--duration", "3", "--hash", "--quiet", "--threads", threads}).out;
    };
    const std::string first = hash("1");
    EXPECT_EQ(first.substr(0, 5), "hash ");
    EXPECT_EQ(hash("1"), first) << scene;
    EXPECT_EQ(hash("2"), first) << scene;
  }
}

}  // namespace
}  // namespace limber

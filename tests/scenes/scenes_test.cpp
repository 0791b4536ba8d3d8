// The scenes that ship with Limber behave as their first lines describe.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "player.h"
#include "sim/behavior/behavior_group.h"
#include "sim/world/joint.h"
#include "support/skip.h"

namespace limber {
namespace {

TEST(Scenes, TheQuadrupedStandsThenTrotsAtTheSpeedOfItsStride) {
  Player player("quadruped.lua");
  const sim::Part& trunk = *player.engine->world().find_body("dog")->root();
  // it stays upright in the first second, its trunk 0.35 m and the foot's radius of 0.032 m above the ground
  player.play(1);
  EXPECT_NEAR(trunk.pose().position.z, 0.382, 0.01);
  EXPECT_NEAR(trunk.pose().position.x, 0, 0.02);
  player.play(1);
  double distance = 0;  // summed over steps, because it may drift off its heading
  Vec3 before = trunk.pose().position;
  while (player.engine->world().time() < 10) {
    for (int tick = 0; tick < 30; tick++) {
      player.engine->tick();
      ASSERT_GT(trunk.pose().position.z, 0.35) << "at " << player.engine->world().time() << " s";
      ASSERT_GT((trunk.pose().rotation * Vec3(0, 0, 1)).z, 0.966) << "more than 15 degrees off upright";
    }
    distance += glm::length(trunk.pose().position - before);
    before = trunk.pose().position;
  }
  EXPECT_NEAR(distance / 8, 0.12 * 2 / 0.6, 0.08)
      << "stride times pace, per fraction of a step with the foot on the ground";
  EXPECT_GT(trunk.pose().position.x, 2);
  EXPECT_LT(std::abs(trunk.pose().position.y), 1);
  EXPECT_EQ(player.engine->faults(), 0u);
}

// Returns the speed over ground from second 2 to second 12 in m/s, with the path summed over half seconds.
double dog_speed(const std::string& scene, std::uint64_t seed) {
  Player player(scene, seed);
  const sim::Part& trunk = *player.engine->world().find_body("dog")->root();
  player.play(2);
  double path = 0;
  for (int i = 0; i < 20; i++) {
    const Vec3 before = trunk.pose().position;
    player.play(0.5);
    const Vec3 moved = trunk.pose().position - before;
    path += std::hypot(moved.x, moved.y);
    EXPECT_GT((trunk.pose().rotation * Vec3(0, 0, 1)).z, 0.7) << "more than 45 degrees off upright, " << scene;
  }
  return path / 10;
}

TEST(Scenes, TheGaitThatASearchFoundIsTwiceAsFastAsTheWrittenOne) {
  const double written = dog_speed("quadruped.lua", 1);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) EXPECT_GT(dog_speed("gait.lua", seed), 2 * written) << seed;
}

// Wild movements press the dancer's limbs against their limits, which hold within half a degree.
TEST(Scenes, TheDancerDancesWithinItsLimits) {
  Player player("dancer.lua");
  player.send("/scene/vigor", {Arg::of(1.6)});
  player.play(2);
  constexpr double kHeld = 0.5 * kPi / 180;
  double highest = 0, lowest = 10, turned = 0;
  int at_limits = 0;
  double heading = euler_of(player.body("dancer").find_part("chest")->pose().rotation).z;
  for (int tick = 0; tick < 60 * 12; tick++) {
    player.engine->tick();
    for (const auto& joint : player.body("dancer").joints()) {
      if (joint->type() != model::JointType::spherical) continue;
      const std::string path = "/physics/body/dancer/joint/" + joint->name() + "/";
      const double excess = player.value(path + "swing") - player.value(path + "cone_limit");
      const double twist = player.value(path + "twist");
      ASSERT_LT(excess, kHeld) << path << " at " << tick;
      ASSERT_GT(twist, player.value(path + "twist_lower") - kHeld) << path << " at " << tick;
      ASSERT_LT(twist, player.value(path + "twist_upper") + kHeld) << path << " at " << tick;
      if (excess > -kHeld) at_limits++;
    }
    const double hand = player.body("dancer").find_part("left_hand")->pose().position.z;
    highest = std::max(highest, hand);
    lowest = std::min(lowest, hand);
    const double now = euler_of(player.body("dancer").find_part("chest")->pose().rotation).z;
    turned += std::remainder(now - heading, 2 * kPi);
    heading = now;
  }
  EXPECT_GT(at_limits, 60);
  EXPECT_GT(highest - lowest, 0.5);
  EXPECT_NEAR(turned, 2 * kPi * 0.15 * 12, 1);
  EXPECT_GT(player.body("dancer").find_part("head")->pose().position.z, 1.3);
  EXPECT_EQ(player.engine->faults(), 0u);
}

// Left and right, while walking and on the spot, it turns at the commanded rate, a little slower when feet slip, and
// stays on its feet.
TEST(Scenes, TheQuadrupedTurnsAtTheCommandedRate) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "golden scenes cover the same code");
  for (const auto& [turn, stride] : {std::pair(0.6, 0.12), std::pair(-1.0, 0.12), std::pair(1.0, 0.0)}) {
    Player player("quadruped.lua");
    const sim::Part& trunk = *player.engine->world().find_body("dog")->root();
    player.send("/scene/stride", {Arg::of(stride)});
    player.play(2);
    player.send("/scene/turn", {Arg::of(turn)});
    double turned = 0;
    double heading = euler_of(trunk.pose().rotation).z;
    constexpr int kSeconds = 24;  // feet slip irregularly
    for (int tick = 0; tick < 60 * kSeconds; tick++) {
      player.engine->tick();
      const double now = euler_of(trunk.pose().rotation).z;
      turned += std::remainder(now - heading, 2 * kPi);
      heading = now;
      ASSERT_GT((trunk.pose().rotation * Vec3(0, 0, 1)).z, 0.94) << "more than 20 degrees off upright, turn " << turn;
    }
    EXPECT_NEAR(turned / kSeconds, turn, 0.5 * std::abs(turn)) << stride;
  }
}

TEST(Scenes, SixteenArmsStandInTwoRingsAndSway) {
  Player player("arms.lua");
  sim::World& world = player.engine->world();
  ASSERT_EQ(world.bodies().size(), 16u);
  for (int i = 1; i <= 16; i++) {
    const sim::Body* body = world.find_body("arm" + std::to_string(i));
    ASSERT_NE(body, nullptr) << i;
    const Vec3 at = body->pose().position;
    EXPECT_NEAR(std::hypot(at.x, at.y), 2.5, 1e-5);
    EXPECT_NEAR(at.z, i <= 8 ? 0 : 5, 1e-5);
    // the lower ring points up, the upper one down
    EXPECT_NEAR((body->pose().rotation * Vec3(0, 0, 1)).z, i <= 8 ? 1 : -1, 1e-5);
  }
  // every tip moves, none is disabled
  const auto tip = [&](std::size_t i) { return world.bodies()[i]->parts().back()->pose().position; };
  std::vector<Vec3> before;
  for (std::size_t i = 0; i < world.bodies().size(); i++) before.push_back(tip(i));
  std::vector<double> farthest(before.size(), 0);
  for (int tick = 0; tick < 240; tick++) {
    player.engine->tick();
    for (std::size_t i = 0; i < before.size(); i++)
      farthest[i] = std::max(farthest[i], glm::distance(before[i], tip(i)));
  }
  for (std::size_t i = 0; i < before.size(); i++) EXPECT_GT(farthest[i], 0.2) << "arm " << i + 1;
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Scenes, HelloPlaysWithoutAFault) {
  Player player("hello.lua");
  EXPECT_FALSE(player.engine->world().bodies().empty());
  player.play(5);
  EXPECT_EQ(player.engine->faults(), 0u);
}

const std::vector<std::pair<std::string, std::string>> kArmBehaviors = {{"random_tip", "random_force"},
                                                                        {"random_all", "random_force"},
                                                                        {"force_tip", "force"},
                                                                        {"rotation_0", "rotation_target"},
                                                                        {"rotation_1", "rotation_target"},
                                                                        {"rotation_2", "rotation_target"},
                                                                        {"rotation_3", "rotation_target"},
                                                                        {"rotation_4", "rotation_target"},
                                                                        {"rotation_5", "rotation_target"},
                                                                        {"speed_tip", "speed"},
                                                                        {"speed_all", "speed"},
                                                                        {"targetpos_tip", "target_attraction"},
                                                                        {"targetpos_all", "target_attraction"},
                                                                        {"levitation", "random_force"},
                                                                        {"particles", "random_force"},
                                                                        {"thrusting", "random_rotation_target"},
                                                                        {"staccato", "random_rotation_target"},
                                                                        {"fluidity", "random_rotation_target"},
                                                                        {"cohesion", "cohesion"},
                                                                        {"evasion", "cohesion"},
                                                                        {"alignment", "alignment"}};

TEST(Scenes, EachArmHasTwentyOneInactiveBehaviors) {
  Player player("arms.lua");
  ASSERT_EQ(kArmBehaviors.size(), 21u);
  for (const auto& body : player.world().bodies()) {
    for (const auto& [name, type] : kArmBehaviors) {
      const sim::Behavior* behavior = body->behaviors().find(name);
      ASSERT_NE(behavior, nullptr) << body->name() << " " << name;
      EXPECT_EQ(behavior->type().name, type) << name;
      EXPECT_FALSE(behavior->active()) << name;
      const bool of_tip =
          name.ends_with("_tip") || name == "levitation" || name == "particles" || behavior->group() != nullptr;
      if (of_tip) {
        ASSERT_EQ(behavior->parts().size(), 1u) << name;
        EXPECT_EQ(behavior->parts()[0]->name(), "tip") << name;
      }
    }
    EXPECT_EQ(body->behaviors().list().size(), 23u) << "and the two that breathe";
    EXPECT_EQ(body->behaviors().find("rotation_3")->motors().size(), 1u);
    EXPECT_EQ(body->behaviors().find("rotation_3")->motors()[0]->name(), "joint_4");
    EXPECT_EQ(body->behaviors().find("thrusting")->motors().size(), 2u);
    EXPECT_EQ(body->behaviors().find("staccato")->motors().size(), 6u);
  }
  EXPECT_LT(player.value("/physics/body/arm7/behavior/evasion/amount"), 0) << "or it would not evade";
}

// maximum distance of each tip from its start within a number of seconds
std::vector<double> travel(Player& player, double seconds) {
  std::vector<Vec3> before;
  for (const auto& body : player.world().bodies()) before.push_back(body->parts().back()->center());
  std::vector<double> farthest(before.size(), 0);
  for (int tick = 0; tick < static_cast<int>(60 * seconds); tick++) {
    player.engine->tick();
    for (std::size_t i = 0; i < before.size(); i++) {
      farthest[i] =
          std::max(farthest[i], glm::distance(before[i], player.world().bodies()[i]->parts().back()->center()));
    }
  }
  return farthest;
}

TEST(Scenes, ABehaviorOfAnArmIsSwitchedOnOverOsc) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  Player player("arms.lua");
  player.send("/physics/body/*/behavior/{bend,twist}/active", {Arg::of(0.0)});
  player.play(4);
  const std::vector<double> still = travel(player, 1);
  player.send("/physics/body/arm3/behavior/thrusting/active", {Arg::of(1.0)});
  const std::vector<double> moved = travel(player, 3);
  for (std::size_t i = 0; i < moved.size(); i++) {
    EXPECT_LT(still[i], 0.02) << "arm " << i + 1 << " rests";
    if (i == 2) {
      EXPECT_GT(moved[i], 0.2);
    } else {
      EXPECT_LT(moved[i], 0.02) << "arm " << i + 1;
    }
  }
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Scenes, AGustBendsTheArmsAndDiesDown) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  Player player("arms.lua");
  player.play(2);
  const auto depth = [&](int arm) {
    return player.value("/physics/body/arm" + std::to_string(arm) + "/behavior/bend/depth");
  };
  EXPECT_NEAR(depth(3), 0.6, 1e-9);
  player.send("/sway", {Arg::of(0.5), Arg::of("arm3")});
  player.engine->tick();
  EXPECT_NEAR(depth(3), 0.9, 0.01);
  EXPECT_NEAR(depth(4), 0.6, 1e-9);
  player.play(1.5);
  EXPECT_NEAR(depth(3), 0.6 * (1 + 0.5 * std::exp(-1)), 0.01);
  player.play(8);
  EXPECT_NEAR(depth(3), 0.6, 1e-9);
  // a slider applies to all
  player.send("/scene/depth", {Arg::of(0.3)});
  player.engine->tick();
  EXPECT_NEAR(depth(1), 0.3, 1e-9);
  EXPECT_NEAR(depth(16), 0.3, 1e-9);
}

TEST(Scenes, TheSwarmAlignsAndStaysInItsArena) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  Player player("swarm.lua");
  std::vector<const sim::Part*> heads;
  for (const auto& body : player.world().bodies()) {
    if (body->name().starts_with("bug")) heads.push_back(body->root());
  }
  ASSERT_EQ(heads.size(), 100u);
  // mean over the neighborhoods of all heads, because a swarm that turns back at the edge has no common heading
  const auto local_polarization = [&] {
    double sum = 0;
    for (const sim::Part* a : heads) {
      Vec3 distance(0);
      double near = 0;
      for (const sim::Part* b : heads) {
        if (glm::distance(a->center(), b->center()) > 1) continue;
        distance += normalized(b->linear_velocity());
        near++;
      }
      sum += glm::length(distance) / near;
    }
    return sum / static_cast<double>(heads.size());
  };
  player.engine->tick();
  const double before = local_polarization();
  double later = 0;
  for (int second = 0; second < 30; second++) {
    player.play(1);
    if (second >= 15) later += local_polarization() / 15;
    for (const sim::Part* head : heads) {
      ASSERT_LT(std::hypot(head->center().x, head->center().y), 7) << "after " << second << " s";
      ASSERT_GT((head->pose().rotation * Vec3(0, 0, 1)).z, 0.7) << "after " << second << " s";
    }
  }
  EXPECT_LT(before, 0.5);
  EXPECT_GT(later, 0.8);
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Scenes, LivePlaysAMinuteWithoutAFault) {
  Player player("live.lua");
  player.play(60);
  EXPECT_EQ(player.engine->faults(), 0u);
  // the arm breathes, balls are thrown up at each interval
  double highest = 0;
  for (int tick = 0; tick < 240; tick++) {
    player.engine->tick();
    for (int i = 1; i <= 8; i++) {
      highest = std::max(highest, player.body("ball" + std::to_string(i)).root()->center().z);
    }
  }
  EXPECT_GT(highest, 0.13);
  EXPECT_NEAR(player.value("/physics/body/arm/behavior/breath/rate"), 0.2, 1e-12);
}

}  // namespace
}  // namespace limber

// scripts/duet.lua: the dancer is where her file says, and arm, beads and lamps follow her.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "app/program.h"
#include "model/mocap/bvh.h"
#include "player.h"
#include "support/skip.h"

namespace limber {
namespace {

Vec3 place_of(const Player& player, const std::string& joint) {
  const std::string path = "/physics/mocap/dancer/joint/" + joint + "/position";
  return {player.value(path, 0), player.value(path, 1), player.value(path, 2)};
}

TEST(Duet, TheDancerIsWhereHerFileSays) {
  std::ifstream in(LIMBER_SOURCE_DIR "/scripts/motion/dancer.bvh");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto clip = *model::parse_bvh(text, "dancer.bvh");
  Player player("duet.lua");
  for (const double time : {1.0, 2.5}) {
    player.play(time - player.world().time());
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < clip->joints.size(); i++) {
      const Pose local = clip->local_pose_at(i, time);
      const int parent = clip->joints[i].parent;
      poses.push_back(parent < 0 ? local : poses[static_cast<std::size_t>(parent)] * local);
      const Vec3 at = poses[i].position;  // cm, Y up
      EXPECT_LT(glm::length(place_of(player, clip->joints[i].name) - Vec3(at.x, -at.z, at.y) / 100.0), 1e-6)
          << clip->joints[i].name;
    }
  }
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Duet, HerBodyCoversHerBones) {
  Player player("duet.lua");
  player.play(2);
  // a part is moved to its bone within the tick in which the joints move
  const Vec3 elbow = place_of(player, "left_forearm");
  const Vec3 hand = place_of(player, "left_hand");
  const Pose bone = player.body("figure").find_part("left_hand")->pose();
  EXPECT_LT(glm::length(bone.position - (elbow + hand) / 2.0), 1e-4);
  EXPECT_NEAR(std::abs(glm::dot(bone.rotation * Vec3(0, 0, 1), normalized(hand - elbow))), 1, 1e-6);
}

TEST(Duet, BeadsCoilAroundHerForearm) {
  Player player("duet.lua");
  player.play(5);
  const Vec3 elbow = place_of(player, "right_forearm");
  const Vec3 along = normalized(place_of(player, "right_hand") - elbow);
  for (const auto& bead : player.body("beads").parts()) {
    const Vec3 from = bead->pose().position - elbow;
    EXPECT_LT(glm::length(from - along * glm::dot(from, along)), 0.3) << bead->name();
    EXPECT_LT(std::abs(glm::dot(from, along) - 0.125), 0.35) << bead->name();
  }
}

TEST(Duet, TheArmCopiesHerElbow) {
  Player player("duet.lua");
  double low = 1e9, high = -1e9;
  for (int i = 0; i < 80; i++) {
    player.play(0.1);
    const double target = player.value("/physics/body/arm/motor/joint_2/target");
    low = std::min(low, target);
    high = std::max(high, target);
  }
  // offset + gain · bend, with a bend of 0 .. π
  EXPECT_GE(low, -0.7 - 1e-6);
  EXPECT_LE(high, -0.7 + 0.9 * kPi);
  EXPECT_GT(high - low, 0.1);
}

TEST(Duet, ItsStateIsTheSameInEveryRun) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "golden scenes cover the same code");
  const auto hash = [&](const char* threads) {
    return app::test::run({LIMBER_SOURCE_DIR "/scripts/duet.lua", "--fast", "--duration", "3", "--hash", "--quiet",
                           "--threads", threads})
        .out;
  };
  const std::string first = hash("1");
  EXPECT_EQ(first.substr(0, 5), "hash ");
  EXPECT_EQ(hash("2"), first);
}

}  // namespace
}  // namespace limber

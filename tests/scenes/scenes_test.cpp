// The scenes that come with Limber do what their first lines say.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "player.h"

namespace limber {
namespace {

TEST(Scenes, TheQuadrupedStandsThenWalksAMetreInTenSecondsAndNeverFalls) {
  Player player("quadruped.lua");
  const Part& trunk = *player.engine->world().find_body("dog")->root();
  // it stands for the first second, its trunk 0.35 m and the foot's radius of 0.032 m above the ground
  player.play(1);
  EXPECT_NEAR(trunk.pose().position.z, 0.382, 0.01);
  EXPECT_NEAR(trunk.pose().position.x, 0, 0.02);
  while (player.engine->world().time() < 10) {
    player.engine->tick();
    ASSERT_GT(trunk.pose().position.z, 0.3) << "at " << player.engine->world().time() << " s";
    ASSERT_GT((trunk.pose().rotation * Vec3(0, 0, 1)).z, 0.94) << "more than 20 degrees off upright";
  }
  EXPECT_GT(trunk.pose().position.x, 1);
  EXPECT_LT(std::abs(trunk.pose().position.y), 0.5);
  EXPECT_EQ(player.engine->faults(), 0u);
}

TEST(Scenes, TheQuadrupedTurnsWhereItIsTold) {
  Player player("quadruped.lua");
  const Part& trunk = *player.engine->world().find_body("dog")->root();
  player.play(2);
  player.send("/scene/turn", {Arg::of(0.6)});
  player.play(5);
  EXPECT_GT(euler_of(trunk.pose().rotation).z, 0.3) << "left is positive";
  EXPECT_GT((trunk.pose().rotation * Vec3(0, 0, 1)).z, 0.94);
}

TEST(Scenes, SixteenArmsStandInTwoRingsAndSway) {
  Player player("arms.lua");
  World& world = player.engine->world();
  ASSERT_EQ(world.bodies().size(), 16u);
  for (int i = 1; i <= 16; i++) {
    const Body* body = world.find_body("arm" + std::to_string(i));
    ASSERT_NE(body, nullptr) << i;
    const Vec3 at = body->pose().position;
    EXPECT_NEAR(std::hypot(at.x, at.y), 2.5, 1e-5);
    EXPECT_NEAR(at.z, i <= 8 ? 0 : 5, 1e-5);
    // the lower ring points up, the upper one down
    EXPECT_NEAR((body->pose().rotation * Vec3(0, 0, 1)).z, i <= 8 ? 1 : -1, 1e-5);
  }
  // every tip travels, none breaks
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

}  // namespace
}  // namespace limber

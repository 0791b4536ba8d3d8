// scripts/lights.lua: the moving heads follow the weights.
#include <cmath>
#include <string>

#include "player.h"

namespace limber {
namespace {

TEST(Lights, HeadsFollowTheWeightsOfThePendulums) {
  Player player("lights.lua");
  player.play(2);
  const std::string fixture = "/lighting/fixture/head_";
  for (int tick = 0; tick < 300; tick++) {
    player.engine->tick();
    for (int i = 1; i <= 4; i++) {
      const std::string path = fixture + std::to_string(i);
      const auto vec = [&](const std::string& of) {
        return Vec3(player.value(of, 0), player.value(of, 1), player.value(of, 2));
      };
      const std::string body = i <= 2 ? "/physics/body/pendulum_1" : "/physics/body/pendulum_2";
      const Vec3 wanted = normalized(vec(body + "/part/weight/position") - vec(path + "/origin"));
      // at most as far behind as the limits of its motors demand: speed² / (2 · acceleration), and a tick
      ASSERT_LT(glm::degrees(std::acos(std::min(1.0, glm::dot(wanted, vec(path + "/direction"))))), 25) << i;
      ASSERT_LE(std::abs(player.value(path + "/pan_velocity")), 240 + 1e-9);
    }
  }
  EXPECT_EQ(player.engine->faults(), 0u);
}

}  // namespace
}  // namespace limber

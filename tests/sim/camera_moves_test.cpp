// Camera moves: the course and the end of a glide, and following. Expected angles and lengths are computed here from
// the camera's properties.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "stage.h"

namespace limber::sim {
namespace {

using namespace test;

struct CameraFixture : WorldFixture {
  Camera& camera = world.visuals().camera();
  CameraMoves& moves = world.visuals().camera_moves();

  void expect_view(const Vec3& eye, const Vec3& target) const {
    EXPECT_LT(glm::distance(camera.eye(), eye), 1e-9);
    EXPECT_LT(glm::distance(camera.target(), target), 1e-9);
  }
};

TEST(CameraMoves, GlideRotatesAroundTheTargetWithEasing) {
  CameraFixture s;
  s.camera.look_at({4, 0, 1}, {0, 0, 1});
  s.moves.glide({0, 2, 1}, {0, 0, 1}, 1);  // a quarter turn, and to half the distance
  for (int tick = 1; tick <= 60; tick++) {
    s.ticks(1);
    const double elapsed = tick / 60.0;
    const double share = elapsed * elapsed * (3 - 2 * elapsed);
    const double heading = share * std::numbers::pi / 2;
    const double length = 4 - 2 * share;
    s.expect_view({length * std::cos(heading), length * std::sin(heading), 1}, {0, 0, 1});
  }
  EXPECT_FALSE(s.moves.is_active());
}

TEST(CameraMoves, GlideTakesTheShortWayAndStartsFromStraightAbove) {
  CameraFixture s;
  const Vec3 origin(0);
  s.camera.look_at({-1, 0.1, 0}, origin);
  s.moves.glide({-1, -0.1, 0}, origin, 0.5);
  for (int tick = 0; tick < 29; tick++) {
    s.ticks(1);
    EXPECT_LT(s.camera.eye().x, -0.99) << "it turned the long way";
  }
  s.camera.look_at({0, 0, 3}, origin);
  s.moves.glide({3, 0, 0}, origin, 0.5);
  for (int tick = 0; tick < 29; tick++) {
    s.ticks(1);
    EXPECT_NEAR(s.camera.eye().y, 0, 1e-9) << "straight above has no heading of its own";
    EXPECT_NEAR(glm::length(s.camera.eye()), 3, 1e-9);
  }
}

TEST(CameraMoves, SettingTheCameraEndsAGlide) {
  CameraFixture s;
  s.camera.look_at({4, 0, 1}, {0, 0, 1});
  s.moves.glide({0, 4, 1}, {0, 0, 1}, 1);
  s.ticks(10);
  EXPECT_TRUE(s.moves.is_active());
  s.camera.look_at({5, 5, 5}, {1, 0, 0});
  s.ticks(10);
  EXPECT_FALSE(s.moves.is_active());
  s.expect_view({5, 5, 5}, {1, 0, 0});
}

TEST(CameraMoves, FollowsAFallingPartUntilItIsRemoved) {
  CameraFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1, {{1, 2, 10}, quat_identity()});
  s.gravity({0, 0, -10});
  s.ticks(1);
  s.camera.look_at({0, -5, 1}, {0, 0, 1});
  s.moves.follow(ball.body().id());
  const Vec3 offset(0, -5, 0);
  s.expect_view(ball.pose().position + offset, ball.pose().position);
  const double height = ball.pose().position.z;
  s.ticks(30);
  EXPECT_LT(ball.pose().position.z, height - 1) << "half a second's fall";
  s.expect_view(ball.pose().position + offset, ball.pose().position);
  // a change of the distance doesn't end the following
  s.camera.look_at(ball.pose().position + offset / 2.0, ball.pose().position);
  s.ticks(5);
  s.expect_view(ball.pose().position + offset / 2.0, ball.pose().position);
  const Vec3 last = ball.pose().position;
  s.world.remove_body(ball.body());
  s.ticks(5);
  EXPECT_FALSE(s.moves.is_active());
  s.expect_view(last + offset / 2.0, last);
}

TEST(CameraMoves, FailedCallRestoresTheCamera) {
  CameraFixture s;
  Part& ball = s.add_single_part(sphere_model(0.1), 1);
  s.ticks(1);
  s.moves.follow(ball.id());
  const Vec3 eye = s.camera.eye();
  s.world.transaction().begin();
  s.moves.follow({});
  s.moves.glide({0, 4, 1}, {0, 0, 1}, 1);
  s.world.transaction().rollback();
  EXPECT_TRUE(s.moves.is_active());
  EXPECT_EQ(s.camera.eye(), eye);
  s.ticks(20);
  EXPECT_LT(glm::distance(s.camera.target(), ball.pose().position), 1e-9) << "it follows the ball as before";
  s.world.clear();
  EXPECT_FALSE(s.moves.is_active());
}

}  // namespace
}  // namespace limber::sim

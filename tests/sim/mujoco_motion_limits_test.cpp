// Compares the range of ball joints with MuJoCo: the angle from which its limit acts, and the one at which ours holds.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "../model/files.h"
#include "model/import.h"
#include "sim/bullet/joints/swing_twist.h"
#include "stage.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kLimitTolerance = 0.5 * kPi / 180;

std::string ball_text(const std::string& range) {
  return fmt::format(
      R"(<mujoco><compiler autolimits="true"/><worldbody><body name="base"><geom size=".05" contype="0" conaffinity="0"/>
<body name="arm"><joint name="ball" type="ball" range="{}" damping="0.2"/>
<geom type="box" size=".1 .05 .2" contype="0" conaffinity="0"/></body></body></worldbody></mujoco>)",
      range);
}

// The smallest angle about `axis` at which MuJoCo has a row for the limit, rad.
double mujoco_limit(const std::string& path, const Vec3& axis) {
  char error[1000] = "";
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> m(mj_loadXML(path.c_str(), nullptr, error, sizeof error),
                                                              mj_deleteModel);
  if (m == nullptr) {
    ADD_FAILURE() << error;
    return 0;
  }
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> d(mj_makeData(m.get()), mj_deleteData);
  double free = 0;
  double limited = kPi;
  while (limited - free > 1e-6) {
    const double angle = (free + limited) / 2;
    const Quat q = quat_axis(axis, angle);
    const double values[] = {q.w, q.x, q.y, q.z};
    std::copy(values, values + 4, d->qpos);
    mj_forward(m.get(), d.get());
    (d->nefc > 0 ? limited : free) = angle;
  }
  return limited;
}

TEST(MujocoLimits, BallJointsStopAtTheSameAngle) {
  const model::test::Files files;
  for (const char* const range : {"0 30", "0 75", "0 150"}) {
    const std::string path = files.write("ball.xml", ball_text(range));
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), normalized(Vec3(0.5, -0.3, 0.8))}) {
      WorldFixture s;
      const auto imported = model::import_model(path);
      ASSERT_TRUE(imported) << imported.error();
      Body& body = *s.world.add_body(*imported, "body", BuildOptions{}).value();
      Part& arm = *body.find_part("arm");
      const Joint& joint = *body.joints().front();
      for (int i = 0; i < 600; i++) {
        arm.apply_torque(3.0 * axis);
        s.ticks(1);
      }
      const double angle = bullet::swing_twist(joint.constraint().pose().rotation()).angle;
      EXPECT_NEAR(angle, mujoco_limit(path, axis), kLimitTolerance) << range;
    }
  }
}

}  // namespace
}  // namespace limber::sim

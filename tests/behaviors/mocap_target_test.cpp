// mocap_target: target = offset + confidence · gain · angle, limited to a range, a speed, and smoothed.
#include "behaviors/mocap_dancer.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"

namespace limber::sim {
namespace {

using namespace test;

struct Follower : Dancer {
  explicit Follower(std::initializer_list<Vec3> joints) : Dancer(joints) {
    Body& arm = body("arm");
    Part& base = part(arm, box_model({0.1, 0.1, 0.1}), 0);
    Part& link = part(arm, box_model({0.1, 0.1, 0.1}), 1, {{0, 0, 0.2}, quat_identity()});
    Joint& hinge = **arm.add_joint("hinge", base, link, model::JointType::revolute, {0, 0, 0.1}, {0, 0, 1});
    motor = *arm.add_motor(hinge);
    behavior = &add(arm, "mocap_target");
    set("joint", 2);
    set("smoothing", 0);
    set("max_speed", 1e4);
  }
  void set(const char* property, double value) { WorldFixture::set(behavior->id(), property, {value}); }
  double target() {
    step_behaviors();
    double out = 0;
    motor->read_target(&out);
    return out;
  }
  Motor* motor = nullptr;
  Behavior* behavior = nullptr;
};

TEST(MocapTarget, FollowsTheBendOfALimb) {
  // a right angle at the elbow
  Follower s({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}});
  EXPECT_NEAR(s.target(), kPi / 2, 1e-9);
  s.set("gain", -0.5);
  s.set("offset", 0.25);
  EXPECT_NEAR(s.target(), 0.25 - kPi / 4, 1e-9);
  s.set("low", -0.1);
  EXPECT_NEAR(s.target(), -0.1, 1e-9);
}

TEST(MocapTarget, FollowsATurnBeyondHalfATurnWithoutAJump) {
  Follower s({{0, 0, 0}, {0, 0, 1}});
  s.set("measure", 2);  // turn_z
  WorldFixture& world = s;
  world.set(s.source.id(), "max_turn", {1e4});
  double before = 0;
  for (int i = 1; i <= 40; i++) {
    s.turn(quat_axis({0, 0, 1}, 0.1 * i));
    s.place({{0, 0, 0}, {0, 0, 1}});
    s.advance(3);
    const double now = s.target();
    EXPECT_NEAR(now, 0.1 * i, 1e-6);
    EXPECT_LT(std::abs(now - before), 0.11);
    before = now;
  }
}

TEST(MocapTarget, IsLimitedInSpeedAndSmoothed) {
  Follower s({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}});
  s.set("max_speed", 3);
  for (int i = 1; i <= 5; i++) EXPECT_NEAR(s.target(), 3 * i * s.world.timestep(), 1e-9);
  Follower smooth({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}});
  smooth.set("smoothing", 0.1);
  const double kept = 1 - smooth.world.timestep() / (0.1 + smooth.world.timestep());
  for (int i = 1; i <= 5; i++) EXPECT_NEAR(smooth.target(), kPi / 2 * (1 - std::pow(kept, i)), 1e-9);
}

}  // namespace
}  // namespace limber::sim

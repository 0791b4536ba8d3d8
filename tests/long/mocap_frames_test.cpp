// A million frames of motion capture, lost, late, in bursts, reordered and wrong: no moving head exceeds its speed and
// acceleration, and the target of a motor its speed.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/show.h"

namespace limber {
namespace {

using engine::test::SceneFile;
using engine::test::Show;

constexpr int kFrames = 1'000'000;
constexpr int kFixtures = 16;

constexpr const char* kScene = R"lua(
sim.gravity = vec3()
local dancer = sim:add_mocap("dancer", {
  source = "osc", joints = { "shoulder", "elbow", "hand" }, bones = { { "shoulder", "elbow" }, { "elbow", "hand" } },
})
local box = sim:add_box_shape("box", vec3(0.1, 0.1, 0.1))
local arm = sim:add_body("arm")
arm:add_part("base", box, { mass = 0 })
arm:add_part("link", box, { position = vec3(0, 0, 0.3) })
arm:add_motor(arm:add_joint("hinge", "base", "link", { position = vec3(0, 0, 0.15), axis = vec3(0, 1, 0) }))
arm:add_behavior("mocap_target", "copy", {
  source = dancer.number, joint = dancer:joint("elbow").number, max_speed = 3,
})
local spots = {}
for i = 1, 16 do
  spots[i] = sim:add_fixture("spot" .. i, {
    profile = "moving_spot", universe = i < 9 and 1 or 2, address = 1 + 30 * ((i - 1) % 8), aim = "point",
    position = vec3(i - 8, 3, 4),
  })
end
sim:on_step(function()
  for i, spot in ipairs(spots) do spot.point = dancer:joint(i % 2 == 0 and "hand" or "elbow").position end
end)
)lua";

using Frame = std::array<double, 9>;

// The frames of a dancer's arm as a network delivers them.
class Deliveries {
 public:
  // Returns what arrives in this tick.
  std::vector<Frame> next(int tick) {
    // 6 a tick; in a twentieth of the ticks a pause, after which all arrive at once
    for (int i = 0; i < 6; i++) {
      if (draw() < 0.05) continue;  // lost
      waiting_.push_back(frame(tick + i / 6.0));
    }
    if (draw() < 0.05 && waiting_.size() < 100) return {};
    std::vector<Frame> arrived(waiting_.begin(), waiting_.end());
    waiting_.clear();
    for (std::size_t i = 1; i < arrived.size(); i++) {
      if (draw() < 0.1) std::swap(arrived[i], arrived[i - 1]);
      if (draw() < 0.02) arrived[i] = arrived[i - 1];
    }
    return arrived;
  }

 private:
  double draw() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  // The hand circles; one frame in a hundred is somewhere else.
  Frame frame(double tick) {
    const double angle = 0.05 * tick;
    Frame f{
        0, 0, 1.5, 0.3, 0, 1.5, 0.3 + 0.3 * std::cos(angle), 0.3 * std::sin(0.7 * angle), 1.5 + 0.3 * std::sin(angle)};
    if (draw() < 0.01) {
      for (double& number : f) number = 20 * draw() - 10;
    }
    return f;
  }

  std::mt19937 random_{11};
  std::deque<Frame> waiting_;
};

// A value whose speed and acceleration are limited.
struct Limited {
  PropertyRef ref;
  double max_speed = 0, max_acceleration = 0;
  double value = 0, speed = 0;
  double largest_speed = 0, largest_acceleration = 0;

  void accept(double now, double dt) {
    const double speed_now = (now - value) / dt;
    largest_speed = std::max(largest_speed, std::abs(speed_now));
    largest_acceleration = std::max(largest_acceleration, std::abs(speed_now - speed) / dt);
    value = now;
    speed = speed_now;
  }
};

TEST(LongMocap, AMillionBrokenFramesKeepAllLimits) {
  const SceneFile file(kScene);
  Show show(file.path());
  std::vector<Limited> limited{{*find_property(show.engine.store(), "/physics/body/arm/motor/hinge/target"), 3, 1e9}};
  for (int i = 1; i <= kFixtures; i++) {
    for (const char* axis : {"pan", "tilt"})
      limited.push_back(
          {*find_property(show.engine.store(), fmt::format("/lighting/fixture/spot{}/{}", i, axis)), 240, 800});
  }
  const double dt = show.engine.world().timestep();
  Deliveries deliveries;
  int frames = 0;
  for (int tick = 0; frames < kFrames; tick++) {
    for (const Frame& f : deliveries.next(tick)) {
      show.send("/mocap/joint/pos_world", f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]);
      frames++;
    }
    show.ticks(1);
    for (Limited& one : limited) {
      double now[4] = {};
      show.engine.store().get(one.ref.node, *one.ref.property, now);
      one.accept(now[0], dt);
    }
  }
  for (const Limited& one : limited) {
    EXPECT_GT(one.largest_speed, 0.1 * one.max_speed) << "it moves";
    EXPECT_LE(one.largest_speed, one.max_speed * (1 + 1e-6));
    EXPECT_LE(one.largest_acceleration, one.max_acceleration * (1 + 1e-6));
  }
  EXPECT_GT(show.read("/physics/mocap/dancer/frames"), 0.99 * kFrames);
}

}  // namespace
}  // namespace limber

// A trot on the beat: legs that follow the phase of the clock take one step per beat while the tempo rises, and no
// motor exceeds its effort limit.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/show.h"

namespace limber::engine::test {
namespace {

constexpr const char* kTrot = R"lua(
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
local dog = sim:load_urdf(")lua" LIMBER_SOURCE_DIR
                              R"lua(/urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 0.40) })
local legs = { { "front_left", 0 }, { "back_right", 0 }, { "front_right", 0.5 }, { "back_left", 0.5 } }
sim:on_step(function()
  for _, leg in ipairs(legs) do
    local angle = 2 * math.pi * (sim.clock.beat + leg[2])
    dog:motor(leg[1] .. "_thigh").target = 0.25 * math.sin(angle)
    dog:motor(leg[1] .. "_knee").target = 0.2 * (1 - math.cos(angle))
  end
end)
)lua";

TEST(BeatGait, StaysOnTheBeatThroughATempoRampWithinTheEffortLimits) {
  const SceneFile file(kTrot);
  Show show(file.path());
  const std::string thigh = "/physics/body/dog/motor/front_left_thigh";
  show.send("/clock/tempo", 60.0);
  show.ticks(120);
  const double begin = show.read("/clock/beat");
  double before = 0, largest = 0;
  std::vector<double> steps;  // beats at which the thigh swings through its middle
  for (int tick = 0; tick < 1200; tick++) {
    show.send("/clock/tempo", 60 + 120 * tick / 1200.0);
    show.ticks(1);
    const double angle = show.read("/physics/body/dog/joint/front_left_thigh/value");
    if (before < 0 && angle >= 0) steps.push_back(show.read("/clock/beat"));
    before = angle;
    for (const char* leg : {"front_left", "front_right", "back_left", "back_right"}) {
      for (const char* joint : {"hip", "thigh", "knee"}) {
        const std::string motor = fmt::format("/physics/body/dog/motor/{}_{}", leg, joint);
        for (std::size_t axis = 0; axis < 3; axis++) {
          const double limit = show.read(motor + "/max_angular_force", axis);
          const double torque = std::abs(show.read(motor + "/applied_torque", axis));
          ASSERT_LE(torque, limit * (1 + 1e-6)) << motor << " at tick " << tick;
          largest = std::max(largest, torque);
        }
      }
    }
  }
  const double beats = show.read("/clock/beat") - begin;
  EXPECT_NEAR(beats, 20 * 2, 0.5) << "the mean tempo is 120";
  EXPECT_NEAR(static_cast<double>(steps.size()), beats, 1.5) << "one step per beat";
  for (std::size_t i = 1; i < steps.size(); i++) EXPECT_NEAR(steps[i] - steps[i - 1], 1, 0.15) << "step " << i;
  EXPECT_GT(largest, 1) << "the motors work";
}

}  // namespace
}  // namespace limber::engine::test

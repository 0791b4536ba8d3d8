// mocap_target: moves the targets of motors by a rotation of a dancer's joint.
#include <algorithm>
#include <cmath>

#include "base/memory/archive.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/common_properties.h"
#include "sim/mocap/mocap_behavior.h"
#include "sim/world/motor.h"

namespace limber::sim {
namespace {

using namespace properties;

class MocapTarget final : public Behavior {
 public:
  enum Parameter : std::uint32_t { source, joint, measure, gain, offset, low, high, smoothing, max_speed };
  enum Measure : std::uint8_t { turn_x, turn_y, turn_z, bend };

  void start() override { state_ = {}; }

  void step(double dt) override {
    const MocapJoint* const from = mocap_joint(world(), number(source), number(joint));
    if (from == nullptr) return;
    const int kind = static_cast<int>(number(measure));
    const double angle = kind == bend ? mocap_bend(*from) : mocap_turn(*from, kind);
    // the shorter way from the previous angle, so that it doesn't jump after half a turn
    state_.angle += std::remainder(angle - state_.angle, 2 * kPi);
    const double wanted = number(offset) + from->confidence() * number(gain) * state_.angle;
    const double target = std::clamp(wanted, std::min(number(low), number(high)), std::max(number(low), number(high)));
    const double most = number(max_speed) * dt;
    if (!state_.begun) {
      state_.target = motors().empty() ? target : motors().front()->joint().value();
      state_.begun = true;
    }
    state_.target += std::clamp((target - state_.target) * dt / (number(smoothing) + dt), -most, most);
    for (Motor* motor : motors()) motor->set_target(state_.target);
  }

  void serialize(Archive& archive) override { archive.serialize(state_); }

 private:
  struct State {
    double angle = 0;
    double target = 0;
    bool begun = false;
  } state_;
};

const BuiltInBehavior registered([] {
  return BehaviorType::create<MocapTarget>(
      "mocap_target", "Moves the targets of motors by a rotation of a dancer's joint.", BehaviorTargets::motors,
      {mocap_source_number(), mocap_joint_number("joint", 1, "Number of the joint."),
       choice("measure", {"turn_x", "turn_y", "turn_z", "bend"}, 3,
              "The joint's turn about an axis of its parent, or the angle by which it bends the limb."),
       number("gain", "", 1, -1e4, 1e4, "Motion of the target per angle; 1: the same angle."),
       number("offset", "", 0, -1e4, 1e4, "Target at an angle of 0, rad or m."),
       number("low", "", -1e4, -1e4, 1e4, "Smallest target, rad or m."),
       number("high", "", 1e4, -1e4, 1e4, "Largest target, rad or m."),
       number("smoothing", "s", 0.05, 0, 60, "Time constant with which the target follows."),
       number("max_speed", "", 5, 0, 1e4, "Largest speed of the target, rad/s or m/s.")});
});

}  // namespace
}  // namespace limber::sim

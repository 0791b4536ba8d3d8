// MuJoCo as the reference of the motion of MJCF models.
#pragma once

#include <string>

namespace limber::sim::test {

struct MotionComparison {
  std::string left_out;   ///< The reason why the file can't be compared; empty: it was.
  double difference = 0;  ///< Largest distance of a body's frame from MuJoCo's, m.
  std::string body;       ///< Body of the largest difference.
  double distance = 0;    ///< Largest distance that a body's frame has moved in MuJoCo, m.
  double end = 0;         ///< Time until which the motions were compared, s.
};

/// Lets the model move under gravity for 0.5 s in both programs, without contacts, actuators, passive forces, limits,
/// equalities and armature, in steps of 0.5 ms. It starts where its hinges and slides are 0.2 (as far as their limits
/// allow) away from home. The comparison ends where a tenth of the step changes MuJoCo's own motion by more than 1.3 mm
/// (in free fall: by 1.1 mm), since it depends on rounding from there on.
/// `with_tendons`: with the springs and dampers of tendons.
MotionComparison compare_motion_with_mujoco(const std::string& path, bool with_tendons = false);

}  // namespace limber::sim::test

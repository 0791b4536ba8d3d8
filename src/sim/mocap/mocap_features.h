// Motion features of a dancer: formulas over the joints that have a place on stage. docs/howto/mocap.md has them.
// [sim]
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "sim/mocap/mocap_joint.h"

namespace limber::sim {

struct MocapFeatures {
  Vec3 center{0};        ///< Mean place, m.
  double speed = 0;      ///< Mean magnitude of the velocities, m/s.
  double jerk = 0;       ///< Mean magnitude of the change of acceleration, m/s³, smoothed.
  double expansion = 0;  ///< Root of the mean squared distance from the center, m.
  double symmetry = 0;   ///< 1: the left side mirrors the right one; 0: not at all.
  int contacts = 0;      ///< Number of joints on the floor.
};

/// Computes the features of a dancer from tick to tick.
class MocapFeatureExtractor {
 public:
  using Joints = std::span<const std::unique_ptr<MocapJoint>>;

  /// Finds the pairs of left and right joints by their names: "left_hand" and "right_hand", "LeftHand", "l_hand",
  /// "hand.L". Call it when joints were added.
  void find_pairs(Joints joints);
  /// `mean_jerk` and `previous_accelerations`: those of the previous tick.
  MocapFeatures extract(Joints joints, std::span<const Vec3> previous_accelerations, double mean_jerk, double dt) const;

  static constexpr double kJerkTime = 0.1;  ///< Time constant of the smoothing of the jerk, s.

 private:
  double symmetry(Joints joints, const Vec3& center, double expansion) const;

  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // left, right
};

}  // namespace limber::sim

// BallLimits: limits of the rotation of a joint as a whole: of the swing of its axis (a cone), of the twist about the
// axis, and of the angle of the rotation.
#pragma once

#include <array>

#include "sim/bullet/joints/joint_pose.h"
#include "sim/bullet/joints/joint_rows.h"
#include "sim/bullet/joints/limit_row.h"
#include "sim/bullet/joints/swing_twist.h"

namespace limber::sim::bullet {

/// Angles in rad; by default, nothing is limited.
struct BallLimitSettings {
  float cone = kFree;         ///< Largest swing.
  float twist_lower = kFree;  ///< lower == upper: locked; lower > upper: free.
  float twist_upper = -kFree;
  float angle = kFree;  ///< Largest angle of the whole rotation.

  static constexpr float kFree = 3.1415926f;  ///< From this value on, a cone or angle is free.
  bool any() const { return cone < kFree || angle < kFree || twist_lower <= twist_upper; }
  bool operator==(const BallLimitSettings&) const = default;
};

/// A planned row about a world axis: its rate is the dot product of the axis with the child's angular velocity relative
/// to the parent.
struct BallLimitRow {
  JointRow row;
  btVector3 axis;

  AxisJacobian jacobian() const { return {btVector3(0, 0, 0), -axis, axis}; }
};

/// In each substep: plan(), then set_impulse() for each row. [sim]
class BallLimits {
 public:
  /// Properties of the joint that its limits use.
  struct Stops {
    btScalar stop_erp;
    btScalar stop_cfm;
    btScalar bounce;
  };

  void set(const BallLimitSettings& settings) { settings_ = settings; }
  const BallLimitSettings& settings() const { return settings_; }
  /// Forgets impulses of earlier substeps.
  void reset() { repair_impulse_.fill(0); }

  /// Plans the rows of limits that may be reached within two steps of `h` s.
  void plan(const JointPose& pose, const Stops& stops, btScalar h);
  int count() const { return count_; }
  const BallLimitRow& operator[](int i) const { return rows_[at(i)]; }
  /// Stores the impulse of a row. `inverse_mobility`: its impulse per change of its rate.
  void set_impulse(int i, btScalar impulse, btScalar inverse_mobility);

 private:
  enum Slot : std::uint8_t { cone, twist_lower, twist_upper, angle };
  struct Step;

  void plan_all(const Step& step);
  void plan_cone(const Step& step);
  void plan_twist(const Step& step);
  void plan_angle(const Step& step);
  void add_limit(const Step& step, Slot slot, const btVector3& axis, double distance, btScalar bend);

  BallLimitSettings settings_;
  int count_ = 0;
  std::array<BallLimitRow, 4> rows_{};
  std::array<float, 4> repair_impulse_{};  // of the last substep, by slot
};

}  // namespace limber::sim::bullet

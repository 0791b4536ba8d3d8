// Posture: how a body stands and moves, by the names of its parts and joints, so that a body which is built anew can
// take it over. [sim]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/body.h"

namespace limber {

class Posture {
 public:
  explicit Posture(const Body& body);

  /// Gives it to a body that replaces the one it was taken from: the root's pose, every joint's position and speed
  /// where the joint is still there with its type. Parts on a way of unchanged joints from the root stand to the bit.
  /// `start_anew`: joints, by number, that stay as the body was made.
  void give_to(Body& body, const std::vector<bool>& start_anew) const;

 private:
  struct PartStance {
    std::string name;
    Pose frame;  ///< Of the centre of mass in the link's.
    Part::Stance stance;
  };
  struct JointStance {
    std::string name, parent, child;
    JointSpec spec;
    Pose motion;               ///< The child's joint frame in the parent's.
    Vec3 linear, angular;      ///< Speed of the child's joint frame in the parent's.
    std::vector<double> told;  ///< The joint's live numbers: angles with their turns.
  };
  class Giving;

  static const PartStance* find(const std::vector<PartStance>& list, std::string_view name);
  const JointStance* joint_like(const Joint& joint) const;

  std::vector<PartStance> parts_;
  std::vector<JointStance> joints_;
};

}  // namespace limber

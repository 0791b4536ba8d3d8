// BodyState: poses and velocities of a body, indexed by the names of its parts and joints, for transfer to a rebuilt
// body. [sim]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"

namespace limber::sim {

class BodyState {
 public:
  explicit BodyState(const Body& body);

  /// Transfers the state to a body that replaces the saved one: the root's pose, and position and velocity of every
  /// joint that still exists with the same type. Parts that only unchanged joints connect to the root get their exact
  /// previous state. `joints_to_reset`: flags, by index, of joints that keep their start position.
  void apply_to(Body& body, const std::vector<bool>& joints_to_reset) const;

 private:
  struct PartState {
    std::string name;
    Pose frame;  ///< of the center of mass in the link's frame
    Part::Motion motion;
  };
  struct JointState {
    std::string name, parent, child;
    JointSpec spec;
    Pose motion;                   ///< the child's joint frame in the parent's
    Vec3 linear, angular;          ///< velocity of the child's joint frame in the parent's
    std::vector<double> readouts;  ///< the joint's transient values, which contain the angles with full turns
  };
  class StateTransfer;

  static const PartState* find(const std::vector<PartState>& list, std::string_view name);
  const JointState* find_joint(const Joint& joint) const;

  std::vector<PartState> parts_;
  std::vector<JointState> joints_;
};

}  // namespace limber::sim

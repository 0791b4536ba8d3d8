// Increases the inertia of bodies whose geometric stiffness would make the explicit step unstable.
#include "sim/solver/geometric_stiffness.h"

namespace limber {
namespace {

/// Ratios of geometric stiffness, times the square of the step, to the moment of inertia. Above the first one, at which
/// an explicit step becomes unstable, the inertia is increased until the ratio is the second one.
constexpr double kMaxStiffnessRatio = 4;
constexpr double kTargetStiffnessRatio = 2;

}  // namespace

void add_geometric_inertia(TreeNode& node, const Island& island, int body, IndexedSpan<const int> links) {
  Sym3& moment = node.inertia.moment;
  const double mean_moment = (moment.xx + moment.yy + moment.zz) / 3;
  for (const int i : links) {
    const Island::Link& link = island.links[i];
    const bool child = link.body_b == body;
    const Vec3 arm = from_bt(child ? link.joint->arm_b() : link.joint->arm_a());
    // lock_impulse() is an impulse: times h it is the stiffness times the square of the step
    const double stiffness = (child ? island.h : -island.h) * glm::dot(from_bt(link.joint->lock_impulse()), arm);
    const double length = glm::length(arm);
    if (!(stiffness > kMaxStiffnessRatio * mean_moment && length > 0)) continue;
    const double added = stiffness / kTargetStiffnessRatio - mean_moment;
    moment.xx += added;
    moment.yy += added;
    moment.zz += added;
    moment.subtract_outer_product(arm / length, added);
  }
}

}  // namespace limber

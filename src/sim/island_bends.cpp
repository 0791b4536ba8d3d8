// Bends: the drift of joints within a step, predicted from the bodies' rotations and asked of the locks beforehand.
#include <algorithm>
#include <cmath>

#include "sim/island_direct.h"

namespace limber {
namespace {

/// Fastest bend, m/s: what flies apart is not pulled together in one step.
constexpr double kFastestBend = 20;
/// Partings below this are left alone, m.
constexpr double kLeastBend = 1e-4;
/// The same where bodies rotate fast: a top would lose energy.
constexpr double kLeastFastBend = 1e-6;

// A lock along an axis.
bool bends(const JointConstraint::Row& row) {
  return row.axis < 3 && row.softness == 0 && static_cast<double>(row.lower) <= -kTreeInfinity &&
         static_cast<double>(row.upper) >= kTreeInfinity;
}

}  // namespace

// Locked rows hold rates at the start of the step; bodies go round. What the two sides will have parted by its end is
// asked for beforehand, so that joints meet where bodies arrive. Returns the largest change, m; 0: nothing changed.
double IslandDirect::bend_locks(const IslandPools& pools, double h) {
  double most = 0;
  predict_turns(pools, h);
  for (Link& link : links_) {
    link.bend = bend_of(link, pools, h);
    for (const JointConstraint::Row& row : link.joint->planned()) {
      if (bends(row)) most = std::max(most, std::fabs(link.bend[row.axis] - link.bent[row.axis]));
    }
  }
  if (most <= (gyros_.empty() ? kLeastBend : kLeastFastBend)) return 0;
  for (Link& link : links_) ask_for_bend(link, h);
  return most;
}

// Takes all bends back.
void IslandDirect::straighten(double h) {
  for (Link& link : links_) {
    link.bend = Vec3(0);
    ask_for_bend(link, h);
  }
}

// Of the link's rows in a tree, or of those that close a loop.
void IslandDirect::ask_for_bend(Link& link, double h) {
  const std::span<const JointConstraint::Row> rows = link.joint->planned();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!bends(rows[r])) continue;
    const double change = (link.bend[rows[r].axis] - link.bent[rows[r].axis]) / h;
    if (link.node >= 0) {
      system_.rows(link.node)[r].velocity -= change;
    } else {
      outer_[at(link.outer) + r].target -= change;
    }
  }
  link.bent = link.bend;
}

// The motion of each body in the step, computed once, though most bodies have two joints.
void IslandDirect::predict_turns(const IslandPools& pools, double h) {
  way_.resize(body_of_.size());
  for (std::size_t i = 0; i < body_of_.size(); ++i) way_[i] = way_of(body_of_[i], pools, h);
}

IslandDirect::Way IslandDirect::way_of(int body, const IslandPools& pools, double h) const {
  const Spatial v = solved_velocity(body, pools);
  const Turn turn = turn_of(body, v.angular, pools, h);
  return {v, turn.shift(v.linear, h), turn.rotation(h), turn.clamped(h) > 0};
}

// How far the two sides of a joint will part in this step, beyond what its rows know, along the parent-side axes, m.
Vec3 IslandDirect::bend_of(const Link& link, const IslandPools& pools, double h) {
  const JointConstraint& joint = *link.joint;
  const auto way = [&](int body) {
    const int node = node_of_[at(body)];
    return node < 0 ? way_of(body, pools, h) : way_[at(node)];
  };
  const Way a = way(link.body_a);
  const Way b = way(link.body_b);
  if (a.clamped || b.clamped) {
    gapes_ = true;
    return link.bent;
  }
  const Vec3 arm_a = from_bt(joint.arm_a());
  const Vec3 arm_b = from_bt(joint.arm_b());
  Vec3 gap(0);
  for (int k = 0; k < 3; ++k) gap += from_bt(joint.linear_axis(k)) * joint.value(k);
  const Vec3 own_arm = arm_a - gap;
  const Vec3 parted = gap + b.shift - a.shift + (b.rotation * arm_b - arm_b) - (a.rotation * own_arm - own_arm);
  const Vec3 drift = carried(b.velocity, arm_b).linear - carried(a.velocity, arm_a).linear;
  Vec3 bend(0);
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = from_bt(joint.linear_axis(k));
    bend[k] = std::clamp(glm::dot(a.rotation * axis, parted) - glm::dot(axis, gap + drift * h), -kFastestBend * h,
                         kFastestBend * h);
  }
  return bend;
}

}  // namespace limber

// Poses: where joints would gape at a step's end by more than their rows allow (a body whips, or bends have not
// settled), bodies are moved together, by the least way as weighed by mass, without leaving them a velocity.
#include <algorithm>
#include <cmath>

#include "sim/island_direct.h"

namespace limber {
namespace {

/// What a joint may gape by beyond its goal before it is worth the work, m; and what is as good as closed.
constexpr double kWorthClosing = 2e-4;
constexpr double kClosed = 1e-4;
/// So often the way there is taken, each time from where the one before led.
constexpr int kClosings = 8;
/// No body turns further than this on one such way, rad.
constexpr double kFarthestTurn = 0.7;

bool locks(const JointConstraint::Row& row) {
  return row.softness == 0 && static_cast<double>(row.lower) <= -kTreeInfinity &&
         static_cast<double>(row.upper) >= kTreeInfinity;
}

btTransform integrated(const btTransform& from, const btVector3& linear, const btVector3& angular, btScalar h) {
  btTransform to;
  btTransformUtil::integrateTransform(from, linear, angular, h, to);
  return to;
}

double error_of(const JointConstraint& joint, int axis, double goal) {
  const double error = goal - joint.value(axis);
  return axis < 3 ? error : std::remainder(error, 2 * kPi);
}

// What Bullet, to which a turn of more than pi/4 is a little less, has to be told so that it turns a body by this.
Vec3 told(const Quat& turn) {
  const Quat q = turn.w < 0 ? -turn : turn;
  const Vec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return Vec3(0);
  const double angle = 2 * fixed::atan2(sine, q.w);
  const double most = kPi / 4;
  const double way = angle <= most ? angle : most * fixed::tan(angle / 2) / fixed::tan(most / 2);
  return axis / sine * way;
}

}  // namespace

// Where the step will take every body, and where locked axes are meant to be then.
void IslandDirect::foresee(const IslandPools& pools, const btContactSolverInfo& info) {
  const btScalar h = info.m_timeStep;
  ends_.clear();
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const btSolverBody& b = pools.bodies[body_of_[i]];
    const btTransform pushed =
        integrated(b.m_worldTransform, b.m_pushVelocity, b.m_turnVelocity * info.m_splitImpulseTurnErp, h);
    const Spatial v = velocity(body_of_[i], pools) + system_.change(static_cast<int>(i));
    const Turn turn = turn_of(body_of_[i], v.angular, pools, static_cast<double>(h));
    Pose end = from_bt(pushed);
    end.position += turn.shift(v.linear, static_cast<double>(h));
    end.rotation = turn.rotation(static_cast<double>(h)) * end.rotation;
    ends_.push_back(end);
  }
  goals_.assign(links_.size(), {});
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const JointConstraint& joint = *links_[l].joint;
    for (const JointConstraint::Row& row : joint.planned()) {
      if (locks(row)) goals_[l][row.axis] = joint.value(row.axis) + static_cast<double>(row.velocity * h);
    }
  }
}

void IslandDirect::place(const IslandPools& pools) {
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    pools.bodies[body_of_[i]].m_originalBody->setWorldTransform(to_bt(ends_[i]));
  }
  for (Link& link : links_) link.joint->refresh();
}

// The most that a joint gapes by beyond its goal, m.
double IslandDirect::gape() {
  double most = 0;
  for (std::size_t l = 0; l < links_.size(); ++l) {
    if (links_[l].node < 0) continue;
    const JointConstraint& joint = *links_[l].joint;
    for (const JointConstraint::Row& row : joint.planned()) {
      if (row.axis < 3 && locks(row)) most = std::max(most, std::fabs(error_of(joint, row.axis, goals_[l][row.axis])));
    }
  }
  return most;
}

// The same trees as the step's: locked axes go to their goals, limited ones not past their limits, others as they like.
bool IslandDirect::build_poses(const IslandPools& pools) {
  poses_.clear();
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    TreeNode& n = poses_.trees.add(system_.trees.node(static_cast<int>(i)).parent);
    n.inertia = inertia_of(*pools.bodies[body_of_[i]].m_originalBody);
    if (link_of_[i] < 0) {
      float_free(n);
    } else {
      const Link& link = links_[at(link_of_[i])];
      const JointConstraint& joint = *link.joint;
      if (!hang(n, joint, link.body_b == body_of_[i])) return false;
      for (const JointConstraint::Row& row : joint.planned()) {
        if (row.kind != JointConstraint::RowKind::lock) continue;
        const double way = locks(row) ? error_of(joint, row.axis, goals_[at(link_of_[i])][row.axis]) : 0;
        poses_.add(row.axis, way, 0, -2 * kTreeInfinity, 2 * kTreeInfinity, TreeRow::other);
      }
      for (int axis = 0; axis < 6; ++axis) {
        const AxisSettings& s = joint.axis(axis);
        if (!s.limited()) continue;
        const double down = static_cast<double>(s.lower) - joint.value(axis);
        const double up = static_cast<double>(s.upper) - joint.value(axis);
        poses_.add(axis, std::min(down, 0.0), 0, 0, 2 * kTreeInfinity, TreeRow::lower_limit);
        poses_.add(axis, std::max(up, 0.0), 0, -2 * kTreeInfinity, 0, TreeRow::upper_limit);
      }
    }
    poses_.end_node({}, {});
  }
  return std::all_of(trees_.begin(), trees_.end(), [&](const Tree& t) { return poses_.pivot(t.first, t.last, 8); });
}

// As pushes, which Bullet adds to where bodies stand before it moves them.
void IslandDirect::go_there(IslandPools& pools, const btContactSolverInfo& info) const {
  const double h = static_cast<double>(info.m_timeStep);
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    btSolverBody& b = pools.bodies[body_of_[i]];
    const Spatial v = velocity(body_of_[i], pools) + system_.change(static_cast<int>(i));
    const Turn turn = turn_of(body_of_[i], v.angular, pools, h);
    const Pose begun = from_bt(b.m_worldTransform);
    const Quat push = glm::conjugate(turn.rotation(h)) * ends_[i].rotation * glm::conjugate(begun.rotation);
    b.m_pushVelocity = to_bt((ends_[i].position - begun.position - turn.shift(v.linear, h)) / h);
    b.m_turnVelocity = to_bt(told(push) / (h * static_cast<double>(info.m_splitImpulseTurnErp)));
  }
}

void IslandDirect::close_joints(IslandPools& pools, const btContactSolverInfo& info) {
  if (!info.m_splitImpulse || info.m_splitImpulseTurnErp <= 0) return;
  if (std::any_of(links_.begin(), links_.end(), [](const Link& link) { return link.node < 0; })) return;
  foresee(pools, info);
  place(pools);
  const double first = gape();
  double left = first;
  for (int pass = 0; pass < kClosings && left > (pass == 0 ? kWorthClosing : kClosed); ++pass) {
    if (!build_poses(pools)) break;
    double farthest = kFarthestTurn;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      farthest = std::max(farthest, glm::length(poses_.change(static_cast<int>(i)).angular));
    }
    const double part = kFarthestTurn / farthest;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const Spatial way = poses_.change(static_cast<int>(i)) * part;
      const double angle = glm::length(way.angular);
      ends_[i].position += way.linear;
      if (angle > 1e-12) ends_[i].rotation = quat_axis(way.angular / angle, angle) * ends_[i].rotation;
    }
    place(pools);
    left = gape();
  }
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const btSolverBody& b = pools.bodies[body_of_[i]];
    b.m_originalBody->setWorldTransform(b.m_worldTransform);
  }
  if (left < first) go_there(pools, info);
}

}  // namespace limber

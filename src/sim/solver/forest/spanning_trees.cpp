// SpanningTrees: finds the trees by union-find, and adds their nodes, motion axes and rows.
#include "sim/solver/forest/spanning_trees.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Ratios of geometric stiffness, times the square of the step, to the moment of inertia. Above the first one, at which
/// an explicit step becomes unstable, the inertia is increased until the ratio is the second one.
constexpr double kMaxStiffnessRatio = 4;
constexpr double kTargetStiffnessRatio = 2;

// Inertia tensor from the principal moments: R·diag(1/inverse)·R'.
Sym3 world_inertia(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const btMatrix3x3& r = body.getCenterOfMassTransform().getBasis();
  Sym3 out;
  for (int k = 0; k < 3; ++k) {
    const double moment = 1 / static_cast<double>(inverse[k]);
    const Vec3 e = bullet::from_bt(r.getColumn(k));
    out.subtract_outer_product(e, -moment);
  }
  return out;
}

// True if the body can move and rotate along all axes.
bool is_supported(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const btVector3 one(1, 1, 1);
  return inverse[0] > 0 && inverse[1] > 0 && inverse[2] > 0 && body.getLinearFactor() == one &&
         body.getAngularFactor() == one;
}

Vec3 any_perpendicular(const Vec3& v) {
  const Vec3 a = std::fabs(v.x) < 0.6 * glm::length(v) ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return normalized(glm::cross(v, a));
}

// Computes the body's motion per rate of each axis, with the other body at rest. Angular axes without rows are chosen
// to complete the basis. Returns false near a singular pose.
bool motion_axes(const bullet::JointConstraint& joint, const Vec3& arm, double sign, FixedArray<Spatial, 6>& out) {
  unsigned used = 0;
  for (const bullet::JointRow& row : joint.rows()) used |= 1u << row.axis;
  FixedArray<Vec3, 3> dual{Vec3(0), Vec3(0), Vec3(0)};
  int known_count = 0;
  for (int i = 0; i < 3; ++i) {
    if ((used >> (3 + i) & 1) == 0) continue;
    dual[i] = bullet::from_bt(joint.pose().dual_axis(i));
    known_count++;
  }
  for (int i = 0; i < 3; ++i) {
    if ((used >> (3 + i) & 1) != 0) continue;
    Vec3& a = dual[(i + 1) % 3];
    Vec3& b = dual[(i + 2) % 3];
    if (known_count == 0) {
      dual[i][i] = 1;
    } else if (known_count == 1) {
      const bool first = (used >> (3 + (i + 1) % 3) & 1) != 0;
      dual[i] = any_perpendicular(first ? a : b);
      (first ? b : a) = normalized(glm::cross(first ? a : b, dual[i]));
      break;
    } else {
      dual[i] = normalized(glm::cross(a, b));
    }
  }
  const double volume = glm::dot(dual[0], glm::cross(dual[1], dual[2]));
  const double length_product = glm::length(dual[0]) * glm::length(dual[1]) * glm::length(dual[2]);
  if (!(std::fabs(volume) > 1e-3 * length_product)) return false;
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = glm::cross(dual[(i + 1) % 3], dual[(i + 2) % 3]) * (sign / volume);
    out[i] = {bullet::from_bt(joint.pose().linear_axis(i)) * sign, Vec3(0)};
    out[3 + i] = {glm::cross(arm, e), e};
  }
  return true;
}

AxisRow::Kind row_kind_of(const bullet::JointRow& row) {
  if (row.kind == bullet::JointRow::Kind::motor) return AxisRow::motor;
  const bool below = static_cast<double>(row.lower) > -AxisRow::kInfinity;
  const bool above = static_cast<double>(row.upper) < AxisRow::kInfinity;
  if (below && above) return AxisRow::friction;
  return below ? AxisRow::lower_limit : (above ? AxisRow::upper_limit : AxisRow::other);
}

// Geometric stiffness (Andrews, Teichmann and Kry, Geometric stiffness for real-time constrained multibody dynamics,
// 2017). A body that a joint pulls at with force f at arm r behaves like a pendulum with stiffness f·r against
// rotation. The explicit step is unstable if it is large, as for the light links of a rope with a heavy end. Increases
// the node's rotational inertia until it is stable. `joints`: the body's joints. Not for bodies on which motors, gears
// or contacts act: these would do work as the inertia changes.
void add_geometric_inertia(TreeNode& node, const Island& island, int body, IndexedSpan<const int> joints) {
  Sym3& moment = node.inertia.moment;
  const double mean_moment = (moment.xx + moment.yy + moment.zz) / 3;
  for (const int i : joints) {
    const Island::Joint& joint = island.joints[i];
    const bool child = joint.body_b == body;
    const Vec3 arm = bullet::from_bt(child ? joint.constraint->pose().arm_b() : joint.constraint->pose().arm_a());
    // lock_impulse() is an impulse: times h it is the stiffness times the square of the step
    const double stiffness =
        (child ? island.h : -island.h) * glm::dot(bullet::from_bt(joint.constraint->lock_impulse()), arm);
    const double length = glm::length(arm);
    if (!(stiffness > kMaxStiffnessRatio * mean_moment && length > 0)) continue;
    const double added = stiffness / kTargetStiffnessRatio - mean_moment;
    moment.xx += added;
    moment.yy += added;
    moment.zz += added;
    moment.subtract_outer_product(arm / length, added);
  }
}

}  // namespace

SpatialInertia inertia_of(const btRigidBody& body) {
  return {1 / static_cast<double>(body.getInvMass()), world_inertia(body)};
}

void make_floating(TreeNode& node) {
  for (int k = 0; k < 3; ++k) {
    node.axis[k].linear[k] = 1;
    node.axis[3 + k].angular[k] = 1;
  }
}

bool attach(TreeNode& node, const bullet::JointConstraint& joint, bool forward) {
  const Vec3 arm_a = bullet::from_bt(joint.pose().arm_a());
  const Vec3 arm_b = bullet::from_bt(joint.pose().arm_b());
  node.offset = forward ? arm_a - arm_b : arm_b - arm_a;
  return motion_axes(joint, forward ? arm_b : arm_a, forward ? 1 : -1, node.axis);
}

// Marks the bodies on which contacts, drives, gears or tendons act.
void SpanningTrees::find_acted_on() {
  acted_on_.assign(island_.pools->bodies.size(), 0);
  const btConstraintArray& contacts = island_.pools->contacts;
  for (int i = 0; i < contacts.size(); ++i) {
    acted_on_[contacts[i].m_solverBodyIdA] = acted_on_[contacts[i].m_solverBodyIdB] = 1;
  }
  for (const Island::Joint& joint : island_.joints) {
    if (joint.constraint->has_drive()) acted_on_[joint.body_a] = acted_on_[joint.body_b] = 1;
  }
  for (const int body : island_.coupled_bodies) acted_on_[body] = 1;
}

int SpanningTrees::root_of(int body) {
  while (group_[body] != body) body = group_[body] = group_[group_[body]];
  return body;
}

// Finds the joints that belong to trees, and lists them by body. All static bodies are one vertex: a second joint to it
// closes a loop.
void SpanningTrees::unite_joints() {
  const int bodies = island_.pools->bodies.size();
  const auto vertex = [&](int body) { return island_.is_dynamic(body) ? body : bodies; };
  group_.resize(bodies + 1);
  for (int i = 0; i < bodies; ++i) group_[i] = vertex(i);
  group_[bodies] = bodies;
  joint_start_.assign(bodies + 2, 0);
  node_of_joint_.clear();
  has_loops_ = false;
  for (const Island::Joint& joint : island_.joints) {
    const int a = root_of(vertex(joint.body_a));
    const int b = root_of(vertex(joint.body_b));
    node_of_joint_.push_back(a == b ? -1 : 0);
    has_loops_ = has_loops_ || a == b;
    if (a == b) continue;
    group_[std::min(a, b)] = std::max(a, b);
    joint_start_[vertex(joint.body_a) + 1]++;
    joint_start_[vertex(joint.body_b) + 1]++;
  }
  for (int i = 1; i < joint_start_.size(); ++i) joint_start_[i] += joint_start_[i - 1];
  body_joints_.resize(joint_start_.back());
  stack_.assign(joint_start_.begin(), joint_start_.end() - 1);
  for (int i = 0; i < island_.joints.size(); ++i) {
    if (node_of_joint_[i] < 0) continue;
    for (const int body : {island_.joints[i].body_a, island_.joints[i].body_b})
      body_joints_[stack_[vertex(body)]++] = i;
  }
}

bool SpanningTrees::build() {
  const int bodies = island_.pools->bodies.size();
  axes.clear(bodies);
  trees_.clear();
  tree_of_.clear();
  body_of_.clear();
  joint_of_.clear();
  node_of_.assign(bodies, -1);
  find_acted_on();
  unite_joints();
  // trees attached to static bodies first, then floating ones
  for (const int i : joints_at(bodies)) {
    const Island::Joint& joint = island_.joints[i];
    if (!add_tree(island_.is_dynamic(joint.body_a) ? joint.body_a : joint.body_b, i)) return false;
  }
  for (int body = 0; body < bodies; ++body) {
    if (island_.is_dynamic(body) && node_of(body) < 0 && !add_tree(body, -1)) return false;
  }
  return true;
}

// Adds the tree with the root `body`, parents before children.
bool SpanningTrees::add_tree(int body, int index) {
  trees_.push_back({axes.forest.size(), 0});
  stack_.clear();
  stack_.insert(stack_.end(), {body, -1, index});
  while (!stack_.empty()) {
    const int depth = stack_.size();
    const int parent_joint = stack_[depth - 1];
    const int parent_node = stack_[depth - 2];
    const int current = stack_[depth - 3];
    stack_.resize(depth - 3);
    if (!add_node(current, parent_node, parent_joint)) return false;
    const int node = axes.forest.size() - 1;
    const IndexedSpan<const int> joints = joints_at(current);
    for (int i = joints.size(); i-- > 0;) {
      if (joints[i] == parent_joint) continue;
      const Island::Joint& joint = island_.joints[joints[i]];
      const int other = joint.body_a == current ? joint.body_b : joint.body_a;
      if (island_.is_dynamic(other)) stack_.insert(stack_.end(), {other, node, joints[i]});
    }
  }
  trees_.back().last = axes.forest.size();
  return true;
}

bool SpanningTrees::add_node(int body, int parent, int index) {
  const btSolverBody& solver_body = island_.body(body);
  const btRigidBody& rigid = *solver_body.m_originalBody;
  if (!is_supported(rigid)) return false;
  TreeNode& n = axes.forest.add(parent);
  const int node = axes.forest.size() - 1;
  node_of_[body] = node;
  body_of_.push_back(body);
  joint_of_.push_back(index);
  tree_of_.push_back(trees_.size() - 1);
  n.inertia = inertia_of(rigid);
  if (acted_on_[body] == 0) add_geometric_inertia(n, island_, body, joints_at(body));
  if (index < 0) {
    make_floating(n);
    axes.end_node({}, {});
  } else {
    const Island::Joint& joint = island_.joints[index];
    node_of_joint_[index] = node;
    if (!attach(n, *joint.constraint, joint.body_b == body)) return false;
    add_rows(joint);
  }
  axes.set_change(node, make_spatial(solver_body.m_deltaLinearVelocity, solver_body.m_deltaAngularVelocity));
  return true;
}

// Adds the rows of a joint to the last node. Present rates include the velocity changes before the solve.
void SpanningTrees::add_rows(const Island::Joint& joint) {
  bullet::JointConstraint& constraint = *joint.constraint;
  const auto current_velocity = [&](int id) {
    const btSolverBody& b = island_.body(id);
    return island_.velocity(id) + make_spatial(b.m_deltaLinearVelocity, b.m_deltaAngularVelocity);
  };
  const Spatial a = current_velocity(joint.body_a);
  const Spatial b = current_velocity(joint.body_b);
  const Vec3 drift = translated(b, bullet::from_bt(constraint.pose().arm_b())).linear -
                     translated(a, bullet::from_bt(constraint.pose().arm_a())).linear;
  const Vec3 spin = b.angular - a.angular;
  FixedArray<double, 6> rates{};
  for (int k = 0; k < 3; ++k) {
    rates[k] = glm::dot(bullet::from_bt(constraint.pose().linear_axis(k)), drift);
    rates[3 + k] = glm::dot(bullet::from_bt(constraint.pose().dual_axis(k)), spin);
  }
  for (const bullet::JointRow& row : constraint.rows()) {
    axes.add(row.axis, static_cast<double>(row.velocity), static_cast<double>(row.softness),
             static_cast<double>(row.lower), static_cast<double>(row.upper), row_kind_of(row));
  }
  axes.end_node(rates, constraint.warm_start().active_set());
}

}  // namespace limber::sim::solver

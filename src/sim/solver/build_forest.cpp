// Forest of an island: builds the spanning trees of its joints, the nodes' motion axes, and their rows.
#include <algorithm>
#include <cmath>

#include "sim/solver/direct_solver.h"

namespace limber {
namespace {

// Inertia tensor from the principal moments: R·diag(1/inverse)·R'.
Sym3 world_inertia(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const btMatrix3x3& r = body.getCenterOfMassTransform().getBasis();
  Sym3 out;
  for (int k = 0; k < 3; ++k) {
    const double moment = 1 / static_cast<double>(inverse[k]);
    const Vec3 e = from_bt(r.getColumn(k));
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

/// Ratios of geometric stiffness, times the square of the step, to the moment of inertia. Above kUnstable, at which an
/// explicit step becomes unstable, the inertia is increased until the ratio is kStable.
constexpr double kMaxStiffnessRatio = 4;
constexpr double kTargetStiffnessRatio = 2;

Vec3 any_perpendicular(const Vec3& v) {
  const Vec3 a = std::fabs(v.x) < 0.6 * glm::length(v) ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return normalized(glm::cross(v, a));
}

// Computes the body's motion per rate of each axis, with the other body at rest. Angular axes without rows are chosen
// to complete the basis. Returns false near a singular pose.
bool motion_axes(const JointConstraint& joint, const Vec3& arm, double sign, std::array<Spatial, 6>& out) {
  unsigned used = 0;
  for (const JointConstraint::Row& row : joint.planned()) used |= 1u << row.axis;
  std::array<Vec3, 3> dual{Vec3(0), Vec3(0), Vec3(0)};
  int known_count = 0;
  for (int i = 0; i < 3; ++i) {
    if ((used >> (3 + i) & 1) == 0) continue;
    dual[at(i)] = from_bt(joint.dual_axis(i));
    known_count++;
  }
  for (int i = 0; i < 3; ++i) {
    if ((used >> (3 + i) & 1) != 0) continue;
    Vec3& a = dual[at((i + 1) % 3)];
    Vec3& b = dual[at((i + 2) % 3)];
    if (known_count == 0) {
      dual[at(i)][i] = 1;
    } else if (known_count == 1) {
      const bool first = (used >> (3 + (i + 1) % 3) & 1) != 0;
      dual[at(i)] = any_perpendicular(first ? a : b);
      (first ? b : a) = normalized(glm::cross(first ? a : b, dual[at(i)]));
      break;
    } else {
      dual[at(i)] = normalized(glm::cross(a, b));
    }
  }
  const double volume = glm::dot(dual[0], glm::cross(dual[1], dual[2]));
  const double length_product = glm::length(dual[0]) * glm::length(dual[1]) * glm::length(dual[2]);
  if (!(std::fabs(volume) > 1e-3 * length_product)) return false;
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = glm::cross(dual[at((i + 1) % 3)], dual[at((i + 2) % 3)]) * (sign / volume);
    out[at(i)] = {from_bt(joint.linear_axis(i)) * sign, Vec3(0)};
    out[at(3 + i)] = {glm::cross(arm, e), e};
  }
  return true;
}

TreeRow::Kind row_kind_of(const JointConstraint::Row& row) {
  if (row.kind == JointConstraint::RowKind::motor) return TreeRow::motor;
  const bool below = static_cast<double>(row.lower) > -kTreeInfinity;
  const bool above = static_cast<double>(row.upper) < kTreeInfinity;
  if (below && above) return TreeRow::friction;
  return below ? TreeRow::lower_limit : (above ? TreeRow::upper_limit : TreeRow::other);
}

}  // namespace

SpatialInertia DirectSolver::inertia_of(const btRigidBody& body) {
  return {1 / static_cast<double>(body.getInvMass()), world_inertia(body)};
}

// Marks the bodies on which contacts, drives or gears act.
void DirectSolver::find_acted_on(const IslandPools& pools) {
  acted_on_.assign(at(pools.bodies.size()), 0);
  for (int i = 0; i < pools.contacts.size(); ++i) {
    acted_on_[at(pools.contacts[i].m_solverBodyIdA)] = acted_on_[at(pools.contacts[i].m_solverBodyIdB)] = 1;
  }
  for (const Link& link : links_) {
    if (link.joint->has_drive()) acted_on_[at(link.body_a)] = acted_on_[at(link.body_b)] = 1;
  }
  for (const GearLink& link : gears_) {
    for (std::size_t i = 0; i < link.gear->jacobians().size(); ++i) acted_on_[at(link.bodies[i])] = 1;
  }
}

// Geometric stiffness (Andrews, Teichmann and Kry 2017): a body that a joint pulls at with force f at arm r behaves
// like a pendulum with stiffness f·r against rotation. The explicit step is unstable if it is large, as for the light
// links of a rope with a heavy end. Such a body gets a larger rotational inertia, unless motors, gears or contacts act
// on it: these would do work as the inertia changes.
void DirectSolver::add_geometric_inertia(TreeNode& node, int body) {
  if (acted_on_[at(body)] != 0) return;
  Sym3& moment = node.inertia.moment;
  const double mean_moment = (moment.xx + moment.yy + moment.zz) / 3;
  for (int i = link_start_[at(body)]; i < link_start_[at(body + 1)]; ++i) {
    const Link& link = links_[at(body_links_[at(i)])];
    const bool child = link.body_b == body;
    const Vec3 arm = from_bt(child ? link.joint->arm_b() : link.joint->arm_a());
    // lock_impulse() is an impulse: times step_ it is the stiffness times the square of the step
    const double stiffness = (child ? step_ : -step_) * glm::dot(from_bt(link.joint->lock_impulse()), arm);
    const double length = glm::length(arm);
    if (!(stiffness > kMaxStiffnessRatio * mean_moment && length > 0)) continue;
    const double added = stiffness / kTargetStiffnessRatio - mean_moment;
    moment.xx += added;
    moment.yy += added;
    moment.zz += added;
    moment.subtract_outer_product(arm / length, added);
  }
}

void DirectSolver::make_floating(TreeNode& node) {
  for (int k = 0; k < 3; ++k) {
    node.axis[at(k)].linear[k] = 1;
    node.axis[at(3 + k)].angular[k] = 1;
  }
}

bool DirectSolver::attach(TreeNode& node, const JointConstraint& joint, bool forward) {
  const Vec3 arm_a = from_bt(joint.arm_a());
  const Vec3 arm_b = from_bt(joint.arm_b());
  node.offset = forward ? arm_a - arm_b : arm_b - arm_a;
  return motion_axes(joint, forward ? arm_b : arm_a, forward ? 1 : -1, node.axis);
}

int DirectSolver::root_of(int body) {
  while (group_[at(body)] != body) body = group_[at(body)] = group_[at(group_[at(body)])];
  return body;
}

Spatial DirectSolver::velocity(int body, const IslandPools& pools) const {
  const btSolverBody& b = pools.bodies[body];
  return {from_bt(b.m_linearVelocity + b.m_externalForceImpulse),
          from_bt(b.m_angularVelocity + b.m_externalTorqueImpulse)};
}

bool DirectSolver::build_forest(const IslandPools& pools) {
  const int bodies = pools.bodies.size();
  const auto is_dynamic = [&](int body) { return pools.bodies[body].m_invMass.x() > 0; };
  tree_rows_.clear(bodies);
  pose_rows_.clear(bodies);
  trees_.clear();
  tree_of_.clear();
  body_of_.clear();
  link_of_.clear();
  node_of_.assign(at(bodies), -1);
  // all static bodies are one vertex: a second joint to it closes a loop
  group_.resize(at(bodies + 1));
  for (int i = 0; i <= bodies; ++i) group_[at(i)] = is_dynamic(std::min(i, bodies - 1)) && i < bodies ? i : bodies;
  link_start_.assign(at(bodies + 2), 0);
  find_acted_on(pools);
  const auto vertex = [&](int body) { return is_dynamic(body) ? body : bodies; };
  for (Link& link : links_) {
    const int a = root_of(vertex(link.body_a));
    const int b = root_of(vertex(link.body_b));
    link.node = a == b ? -1 : 0;
    if (a == b) continue;
    group_[at(std::min(a, b))] = std::max(a, b);
    link_start_[at(vertex(link.body_a) + 1)]++;
    link_start_[at(vertex(link.body_b) + 1)]++;
  }
  for (std::size_t i = 1; i < link_start_.size(); ++i) link_start_[i] += link_start_[i - 1];
  body_links_.resize(at(link_start_.back()));
  stack_.assign(link_start_.begin(), link_start_.end() - 1);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].node < 0) continue;
    for (const int body : {links_[i].body_a, links_[i].body_b}) {
      body_links_[at(stack_[at(vertex(body))]++)] = static_cast<int>(i);
    }
  }
  // trees attached to static bodies first, then floating ones
  for (int i = link_start_[at(bodies)]; i < link_start_[at(bodies + 1)]; ++i) {
    const Link& link = links_[at(body_links_[at(i)])];
    const int body = is_dynamic(link.body_a) ? link.body_a : link.body_b;
    trees_.push_back({tree_rows_.forest.size(), 0});
    if (!add_subtree(body, -1, body_links_[at(i)], pools)) return false;
    trees_.back().last = tree_rows_.forest.size();
  }
  for (int body = 0; body < bodies; ++body) {
    if (!is_dynamic(body) || node_of_[at(body)] >= 0) continue;
    trees_.push_back({tree_rows_.forest.size(), 0});
    if (!add_subtree(body, -1, -1, pools)) return false;
    trees_.back().last = tree_rows_.forest.size();
  }
  return true;
}

// Adds the tree below `body`, parents before children. Returns false at a singular pose or an unsupported body; the
// forest is unusable then.
bool DirectSolver::add_subtree(int body, int parent, int link, const IslandPools& pools) {
  stack_.clear();
  stack_.insert(stack_.end(), {body, parent, link});
  while (!stack_.empty()) {
    const int parent_link = stack_.back();
    const int parent_node = stack_[stack_.size() - 2];
    const int current = stack_[stack_.size() - 3];
    stack_.resize(stack_.size() - 3);
    if (!add_node(current, parent_node, parent_link, pools)) return false;
    const int node = tree_rows_.forest.size() - 1;
    for (int i = link_start_[at(current + 1)]; i-- > link_start_[at(current)];) {
      const int next = body_links_[at(i)];
      if (next == parent_link) continue;
      const Link& l = links_[at(next)];
      const int other = l.body_a == current ? l.body_b : l.body_a;
      if (pools.bodies[other].m_invMass.x() > 0) stack_.insert(stack_.end(), {other, node, next});
    }
  }
  return true;
}

bool DirectSolver::add_node(int body, int parent, int link, const IslandPools& pools) {
  const btSolverBody& solver_body = pools.bodies[body];
  const btRigidBody& rigid = *solver_body.m_originalBody;
  if (!is_supported(rigid)) return false;
  TreeNode& n = tree_rows_.forest.add(parent);
  node_of_[at(body)] = tree_rows_.forest.size() - 1;
  body_of_.push_back(body);
  link_of_.push_back(link);
  tree_of_.push_back(static_cast<int>(trees_.size()) - 1);
  n.inertia = inertia_of(rigid);
  add_geometric_inertia(n, body);
  std::array<double, 6> rates{};
  const Spatial applied_change{from_bt(solver_body.m_deltaLinearVelocity), from_bt(solver_body.m_deltaAngularVelocity)};
  if (link < 0) {
    make_floating(n);
    tree_rows_.end_node(rates, {});
  } else {
    Link& l = links_[at(link)];
    JointConstraint& joint = *l.joint;
    l.node = tree_rows_.forest.size() - 1;
    if (!attach(n, joint, l.body_b == body)) return false;
    const Vec3 arm_a = from_bt(joint.arm_a());
    const Vec3 arm_b = from_bt(joint.arm_b());
    // present rates, including the velocity changes before the solve
    const auto current_velocity = [&](int id) {
      const btSolverBody& b = pools.bodies[id];
      return velocity(id, pools) + Spatial{from_bt(b.m_deltaLinearVelocity), from_bt(b.m_deltaAngularVelocity)};
    };
    const Spatial a = current_velocity(l.body_a);
    const Spatial b = current_velocity(l.body_b);
    const Vec3 drift = translated(b, arm_b).linear - translated(a, arm_a).linear;
    const Vec3 spin = b.angular - a.angular;
    for (int k = 0; k < 3; ++k) {
      rates[at(k)] = glm::dot(from_bt(joint.linear_axis(k)), drift);
      rates[at(3 + k)] = glm::dot(from_bt(joint.dual_axis(k)), spin);
    }
    for (const JointConstraint::Row& row : joint.planned()) {
      tree_rows_.add(row.axis, static_cast<double>(row.velocity), static_cast<double>(row.softness),
                     static_cast<double>(row.lower), static_cast<double>(row.upper), row_kind_of(row));
    }
    tree_rows_.end_node(rates, joint.active_set_memory());
  }
  tree_rows_.set_change(tree_rows_.forest.size() - 1, applied_change);
  return true;
}

}  // namespace limber

// The forest of an island: which body hangs on which, how joints move them, and the rows of each.
#include <algorithm>
#include <cmath>

#include "sim/island_direct.h"

namespace limber {
namespace {

// A tensor from its principal axes: R·diag(1/inverse)·R'.
Sym3 world_inertia(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const btMatrix3x3& r = body.getCenterOfMassTransform().getBasis();
  Sym3 out;
  for (int k = 0; k < 3; ++k) {
    const double moment = 1 / static_cast<double>(inverse[k]);
    const Vec3 e = from_bt(r.getColumn(k));
    out.subtract_square(e, -moment);
  }
  return out;
}

bool plain_body(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const btVector3 one(1, 1, 1);
  return inverse[0] > 0 && inverse[1] > 0 && inverse[2] > 0 && body.getLinearFactor() == one &&
         body.getAngularFactor() == one;
}

/// Stiffness against rotation, times the square of the step, relative to the moment of inertia: above the first value
/// the inertia is increased until the ratio is the second. (An explicit step is unstable above 4.)
constexpr double kUnstable = 4;
constexpr double kStable = 2;

Vec3 any_normal(const Vec3& v) {
  const Vec3 a = std::fabs(v.x) < 0.6 * glm::length(v) ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return normalized(glm::cross(v, a));
}

// How a body moves per rate of each axis, its other side at rest. Angular axes without rows may stand anywhere: they
// stand where the others leave room. False near a singular pose.
bool motion_axes(const JointConstraint& joint, const Vec3& arm, double sign, std::array<Spatial, 6>& out) {
  unsigned used = 0;
  for (const JointConstraint::Row& row : joint.planned()) used |= 1u << row.axis;
  std::array<Vec3, 3> dual{Vec3(0), Vec3(0), Vec3(0)};
  int known = 0;
  for (int i = 0; i < 3; ++i) {
    if ((used >> (3 + i) & 1) == 0) continue;
    dual[at(i)] = from_bt(joint.dual_axis(i));
    known++;
  }
  for (int i = 0; i < 3; ++i) {
    if ((used >> (3 + i) & 1) != 0) continue;
    Vec3& a = dual[at((i + 1) % 3)];
    Vec3& b = dual[at((i + 2) % 3)];
    if (known == 0) {
      dual[at(i)][i] = 1;
    } else if (known == 1) {
      const bool first = (used >> (3 + (i + 1) % 3) & 1) != 0;
      dual[at(i)] = any_normal(first ? a : b);
      (first ? b : a) = normalized(glm::cross(first ? a : b, dual[at(i)]));
      break;
    } else {
      dual[at(i)] = normalized(glm::cross(a, b));
    }
  }
  const double volume = glm::dot(dual[0], glm::cross(dual[1], dual[2]));
  const double sizes = glm::length(dual[0]) * glm::length(dual[1]) * glm::length(dual[2]);
  if (!(std::fabs(volume) > 1e-3 * sizes)) return false;
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = glm::cross(dual[at((i + 1) % 3)], dual[at((i + 2) % 3)]) * (sign / volume);
    out[at(i)] = {from_bt(joint.linear_axis(i)) * sign, Vec3(0)};
    out[at(3 + i)] = {glm::cross(arm, e), e};
  }
  return true;
}

TreeRow::Mark mark_of(const JointConstraint::Row& row) {
  if (row.kind == JointConstraint::RowKind::motor) return TreeRow::motor;
  const bool below = static_cast<double>(row.lower) > -kTreeInfinity;
  const bool above = static_cast<double>(row.upper) < kTreeInfinity;
  if (below && above) return TreeRow::friction;
  return below ? TreeRow::lower_limit : (above ? TreeRow::upper_limit : TreeRow::other);
}

}  // namespace

SpatialInertia IslandDirect::inertia_of(const btRigidBody& body) {
  return {1 / static_cast<double>(body.getInvMass()), world_inertia(body)};
}

void IslandDirect::mark_acted_on(const IslandPools& pools) {
  acted_on_.assign(at(pools.bodies.size()), 0);
  for (int i = 0; i < pools.contacts.size(); ++i) {
    acted_on_[at(pools.contacts[i].m_solverBodyIdA)] = acted_on_[at(pools.contacts[i].m_solverBodyIdB)] = 1;
  }
  for (const Link& link : links_) {
    if (link.joint->drives()) acted_on_[at(link.body_a)] = acted_on_[at(link.body_b)] = 1;
  }
  for (const GearLink& link : gears_) {
    for (std::size_t i = 0; i < link.gear->sides().size(); ++i) acted_on_[at(link.bodies[i])] = 1;
  }
}

// A body that a joint pulls at, with force f at arm r, behaves like a pendulum: f·r is a stiffness against its
// rotation. The step treats it explicitly, which is unstable if it is large, as for the light links of a rope with a
// heavy end. Such a body gets a larger rotational inertia, unless motors, gears or contacts act on it: these would do
// work as the inertia changes. (Geometric stiffness: Andrews, Teichmann and Kry 2017.)
void IslandDirect::add_geometric_inertia(TreeNode& node, int body) {
  if (acted_on_[at(body)] != 0) return;
  Sym3& moment = node.inertia.moment;
  const double own = (moment.xx + moment.yy + moment.zz) / 3;
  for (int i = link_start_[at(body)]; i < link_start_[at(body + 1)]; ++i) {
    const Link& link = links_[at(body_links_[at(i)])];
    const bool child = link.body_b == body;
    const Vec3 arm = from_bt(child ? link.joint->arm_b() : link.joint->arm_a());
    // pull() is an impulse: the stiffness times the square of the step
    const double stiffness = (child ? step_ : -step_) * glm::dot(from_bt(link.joint->pull()), arm);
    const double length = glm::length(arm);
    if (!(stiffness > kUnstable * own && length > 0)) continue;
    const double more = stiffness / kStable - own;
    moment.xx += more;
    moment.yy += more;
    moment.zz += more;
    moment.subtract_square(arm / length, more);
  }
}

void IslandDirect::float_free(TreeNode& node) {
  for (int k = 0; k < 3; ++k) {
    node.axis[at(k)].linear[k] = 1;
    node.axis[at(3 + k)].angular[k] = 1;
  }
}

bool IslandDirect::hang(TreeNode& node, const JointConstraint& joint, bool forward) {
  const Vec3 arm_a = from_bt(joint.arm_a());
  const Vec3 arm_b = from_bt(joint.arm_b());
  node.shift = forward ? arm_a - arm_b : arm_b - arm_a;
  return motion_axes(joint, forward ? arm_b : arm_a, forward ? 1 : -1, node.axis);
}

int IslandDirect::root_of(int body) {
  while (group_[at(body)] != body) body = group_[at(body)] = group_[at(group_[at(body)])];
  return body;
}

Spatial IslandDirect::velocity(int body, const IslandPools& pools) const {
  const btSolverBody& b = pools.bodies[body];
  return {from_bt(b.m_linearVelocity + b.m_externalForceImpulse),
          from_bt(b.m_angularVelocity + b.m_externalTorqueImpulse)};
}

bool IslandDirect::build_forest(const IslandPools& pools) {
  const int bodies = pools.bodies.size();
  const auto moves = [&](int body) { return pools.bodies[body].m_invMass.x() > 0; };
  system_.clear(bodies);
  poses_.clear(bodies);
  trees_.clear();
  tree_of_.clear();
  body_of_.clear();
  link_of_.clear();
  node_of_.assign(at(bodies), -1);
  // all that stands still is one: a second joint to it closes a loop
  group_.resize(at(bodies + 1));
  for (int i = 0; i <= bodies; ++i) group_[at(i)] = moves(std::min(i, bodies - 1)) && i < bodies ? i : bodies;
  link_start_.assign(at(bodies + 2), 0);
  mark_acted_on(pools);
  const auto vertex = [&](int body) { return moves(body) ? body : bodies; };
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
  // trees that stand on something first, then those that float
  for (int i = link_start_[at(bodies)]; i < link_start_[at(bodies + 1)]; ++i) {
    const Link& link = links_[at(body_links_[at(i)])];
    const int body = moves(link.body_a) ? link.body_a : link.body_b;
    trees_.push_back({system_.trees.size(), 0});
    if (!grow(body, -1, body_links_[at(i)], pools)) return false;
    trees_.back().last = system_.trees.size();
  }
  for (int body = 0; body < bodies; ++body) {
    if (!moves(body) || node_of_[at(body)] >= 0) continue;
    trees_.push_back({system_.trees.size(), 0});
    if (!grow(body, -1, -1, pools)) return false;
    trees_.back().last = system_.trees.size();
  }
  return true;
}

// The tree that hangs on `body`, parents before children. False: a node of it can't be told; no other may follow.
bool IslandDirect::grow(int body, int parent, int link, const IslandPools& pools) {
  stack_.clear();
  stack_.insert(stack_.end(), {body, parent, link});
  while (!stack_.empty()) {
    const int by = stack_.back();
    const int above = stack_[stack_.size() - 2];
    const int here = stack_[stack_.size() - 3];
    stack_.resize(stack_.size() - 3);
    if (!add_node(here, above, by, pools)) return false;
    const int me = system_.trees.size() - 1;
    for (int i = link_start_[at(here + 1)]; i-- > link_start_[at(here)];) {
      const int next = body_links_[at(i)];
      if (next == by) continue;
      const Link& l = links_[at(next)];
      const int there = l.body_a == here ? l.body_b : l.body_a;
      if (pools.bodies[there].m_invMass.x() > 0) stack_.insert(stack_.end(), {there, me, next});
    }
  }
  return true;
}

bool IslandDirect::add_node(int body, int parent, int link, const IslandPools& pools) {
  const btSolverBody& solver_body = pools.bodies[body];
  const btRigidBody& rigid = *solver_body.m_originalBody;
  if (!plain_body(rigid)) return false;
  TreeNode& n = system_.trees.add(parent);
  node_of_[at(body)] = system_.trees.size() - 1;
  body_of_.push_back(body);
  link_of_.push_back(link);
  tree_of_.push_back(static_cast<int>(trees_.size()) - 1);
  n.inertia = inertia_of(rigid);
  add_geometric_inertia(n, body);
  std::array<double, 6> rates{};
  const Spatial done{from_bt(solver_body.m_deltaLinearVelocity), from_bt(solver_body.m_deltaAngularVelocity)};
  if (link < 0) {
    float_free(n);
    system_.end_node(rates, {});
  } else {
    Link& l = links_[at(link)];
    JointConstraint& joint = *l.joint;
    l.node = system_.trees.size() - 1;
    if (!hang(n, joint, l.body_b == body)) return false;
    const Vec3 arm_a = from_bt(joint.arm_a());
    const Vec3 arm_b = from_bt(joint.arm_b());
    // rates as they are now, what contacts start from included
    const auto moving = [&](int id) {
      const btSolverBody& b = pools.bodies[id];
      return velocity(id, pools) + Spatial{from_bt(b.m_deltaLinearVelocity), from_bt(b.m_deltaAngularVelocity)};
    };
    const Spatial a = moving(l.body_a);
    const Spatial b = moving(l.body_b);
    const Vec3 drift = carried(b, arm_b).linear - carried(a, arm_a).linear;
    const Vec3 spin = b.angular - a.angular;
    for (int k = 0; k < 3; ++k) {
      rates[at(k)] = glm::dot(from_bt(joint.linear_axis(k)), drift);
      rates[at(3 + k)] = glm::dot(from_bt(joint.dual_axis(k)), spin);
    }
    for (const JointConstraint::Row& row : joint.planned()) {
      system_.add(row.axis, static_cast<double>(row.velocity), static_cast<double>(row.softness),
                  static_cast<double>(row.lower), static_cast<double>(row.upper), mark_of(row));
    }
    system_.end_node(rates, joint.tree_memory());
  }
  system_.set_change(system_.trees.size() - 1, done);
  return true;
}

}  // namespace limber

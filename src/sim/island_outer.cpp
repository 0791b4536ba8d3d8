// What stands around the trees: contacts, friction, joints that close loops, gears, and axes whose row in force did not
// settle. All are solved together, against the response of the trees.
#include <algorithm>
#include <cmath>

#include "sim/contact_friction.h"
#include "sim/island_direct.h"

namespace limber {
namespace {

/// Work that should do for a step: for any, for each body, and for what contacts have to do with each other; and times
/// that while no motor gives way to them: then contacts are all that there is to solve for, and their exactness shows.
constexpr double kEnough = 5e4;
constexpr double kEnoughForBody = 2e3;
constexpr double kEnoughForContacts = 1;
constexpr double kEnoughWhileMotorsHold = 4;
/// Least softness of a contact's or loop's row, as part of the response of its two bodies alone. Where servos or locks
/// hold the two against each other, or a loop repeats what another joint locks, the trees respond by rounding errors
/// only, and without it an impulse would be a multiple of them.
constexpr double kLeastSoftness = 1e-6;
/// The same for the repair of penetration: a contact that the joints let move by less than about this part of what the
/// two bodies alone would move is not repaired.
constexpr double kLeastPushSoftness = 1e-3;
/// Fastest repair of penetration, m/s.
constexpr double kFastestPush = 2;
/// Largest rotation of a body by the repair of one step, rad. The repair of the island is scaled down to it, because a
/// body that is rotated while its velocity stays changes its energy.
constexpr double kFurthestPushTurn = 0.05;

// Rate per impulse of one body alone.
double ease_alone(const btSolverBody& body, const Spatial& pull) {
  const btRigidBody* rigid = body.m_originalBody;
  if (rigid == nullptr) return 0;
  const btVector3 turn = to_bt(pull.angular);
  return glm::dot(pull.linear, pull.linear) * static_cast<double>(rigid->getInvMass()) +
         static_cast<double>(turn.dot(rigid->getInvInertiaTensorWorld() * turn));
}

/// Friction that exceeds the cone by this is brought back into it.
constexpr double kOutsideOfCone = 1.02;

Spatial pull_of(const btVector3& linear, const btVector3& angular) { return {from_bt(linear), from_bt(angular)}; }

BoxSolver::Status in_box(TreeRow::Status status) {
  return status == TreeRow::outer      ? BoxSolver::unknown
         : status == TreeRow::active   ? BoxSolver::free
         : status == TreeRow::at_lower ? BoxSolver::at_lower
                                       : BoxSolver::at_upper;
}

TreeRow::Status in_tree(BoxSolver::Status status) {
  return status == BoxSolver::unknown    ? TreeRow::outer
         : status == BoxSolver::free     ? TreeRow::active
         : status == BoxSolver::at_lower ? TreeRow::at_lower
                                         : TreeRow::at_upper;
}

}  // namespace

void IslandDirect::add_contact(btSolverConstraint& row, int normal, double most) {
  OuterRow out;
  out.a = {node_of_[at(row.m_solverBodyIdA)], pull_of(row.m_contactNormal1, row.m_relpos1CrossNormal)};
  out.b = {node_of_[at(row.m_solverBodyIdB)], pull_of(row.m_contactNormal2, row.m_relpos2CrossNormal)};
  const double step = static_cast<double>(row.m_jacDiagABInv);
  out.contact = &row;
  out.eases = step > 0 ? 1 / step : 0;
  out.target = step > 0 ? static_cast<double>(row.m_rhs) / step : 0;
  out.softness = step > 0 ? static_cast<double>(row.m_cfm) / step + kLeastSoftness * out.eases : 0;
  out.impulse = out.likely = static_cast<double>(row.m_appliedImpulse);
  // a normal's own softness counts from the impulse of the step before, so that what rests does not sink
  if (normal < 0 && step > 0) out.target += static_cast<double>(row.m_cfm) / step * out.impulse;
  out.lower = static_cast<double>(row.m_lowerLimit);
  out.upper = static_cast<double>(row.m_upperLimit);
  out.normal = normal;
  out.friction = static_cast<double>(row.m_friction);
  out.most = most;
  // until take_contacts() brings it back
  out.aside = out.impulse == 0 && (normal < 0 || outer_[at(normal)].aside);
  if (normal >= 0 && !out.aside) outer_[at(normal)].aside = false;
  outer_.push_back(out);
}

void IslandDirect::collect_contacts(IslandPools& pools) {
  for (int i = 0; i < pools.contacts.size(); ++i) add_contact(pools.contacts[i], -1, 0);
  for (int i = 0; i < pools.frictions.size(); ++i) {
    add_contact(pools.frictions[i], pools.frictions[i].m_frictionIndex, 0);
  }
  for (int i = 0; i < pools.rollings.size(); ++i) {
    add_contact(pools.rollings[i], pools.rollings[i].m_frictionIndex, 0);
  }
}

void IslandDirect::collect_loops(const IslandPools& pools) {
  for (Link& link : links_) {
    if (link.node >= 0) continue;
    link.outer = static_cast<int>(outer_.size());
    for (const JointConstraint::Row& row : link.joint->planned()) {
      const JointConstraint::Jacobian j = link.joint->jacobian(row.axis);
      OuterRow out;
      out.loop = true;
      out.a = {node_of_[at(link.body_a)], pull_of(-j.linear, j.angular_a)};
      out.b = {node_of_[at(link.body_b)], pull_of(j.linear, j.angular_b)};
      out.target = static_cast<double>(row.velocity) - dot(out.a.pull, velocity(link.body_a, pools)) -
                   dot(out.b.pull, velocity(link.body_b, pools));
      out.eases = ease_alone(pools.bodies[link.body_a], out.a.pull) + ease_alone(pools.bodies[link.body_b], out.b.pull);
      out.softness = static_cast<double>(row.softness) + kLeastSoftness * out.eases;
      out.lower = static_cast<double>(row.lower);
      out.upper = static_cast<double>(row.upper);
      outer_.push_back(out);
    }
  }
}

// One row each, on up to four bodies.
void IslandDirect::collect_gears(const IslandPools& pools) {
  gear_sides_.clear();
  for (GearLink& link : gears_) {
    link.outer = static_cast<int>(outer_.size());
    const GearConstraint::Row& row = link.gear->row();
    OuterRow out;
    out.loop = true;
    out.gear = static_cast<int>(gear_sides_.size());
    std::array<Side, 2>& more = gear_sides_.emplace_back();
    out.target = row.velocity;
    const std::span<const GearConstraint::Side> sides = link.gear->sides();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      Side& side = i == 0 ? out.a : i == 1 ? out.b : more[i - 2];
      side = {node_of_[at(link.bodies[i])], pull_of(sides[i].linear, sides[i].angular)};
      out.target -= dot(side.pull, velocity(link.bodies[i], pools));
    }
    out.softness = row.softness;
    out.eases = row.mobility;
    out.lower = -row.bound;
    out.upper = row.bound;
    outer_.push_back(out);
  }
}

// Behind contacts, loops and gears: the rows of axes that were given up.
void IslandDirect::collect_axes() {
  outer_.resize(fixed_outer_);
  for (TreeRow& row : system_.rows()) {
    if (row.status != TreeRow::outer) continue;
    OuterRow out;
    out.axis = &row;
    out.a.node = row.node;
    out.softness = row.softness;
    out.impulse = row.impulse;
    out.lower = row.lower;
    out.upper = row.upper;
    out.guess = in_box(row.guess);
    out.likely = row.likely;
    outer_.push_back(out);
  }
  allow_work();
}

void IslandDirect::allow_work() {
  const auto rows = static_cast<double>(fixed_outer_);
  const double enough = kEnough + kEnoughForBody * system_.trees.size() + kEnoughForContacts * rows * rows;
  effort_.allow(outer_.size() > fixed_outer_ ? enough : kEnoughWhileMotorsHold * enough);
}

// Present rate, as a change from the start.
double IslandDirect::rate_of(const OuterRow& row) const {
  double rate = 0;
  for_each_side(row, [&](const Side& side) { rate += dot(side.pull, system_.change(side.node)); });
  return rate;
}

void IslandDirect::load(const OuterRow& row, double impulse) {
  if (row.axis != nullptr) {
    system_.trees.node(row.axis->node).ask[row.axis->axis] = impulse;
    return;
  }
  for_each_side(row, [&](const Side& side) { system_.trees.node(side.node).load += side.pull * impulse; });
}

// Contacts that stand aside and would be passed through now come back, with their friction; how many rows these were.
int IslandDirect::take_contacts() {
  int taken = 0;
  for (std::size_t i = 0; i < fixed_outer_; ++i) {
    OuterRow& row = outer_[i];
    if (!row.aside) continue;
    row.aside = row.normal < 0 ? row.target - rate_of(row) <= kOuterTolerance : outer_[at(row.normal)].aside;
    taken += row.aside ? 0 : 1;
  }
  return taken;
}

// Rows of friction are bounded one by one, by a square that has the cone's strength along its axes only. Where both
// together are stronger than the cone, their bounds become those of the rectangle within it whose corner has the
// direction of the force that was found. True when something changed.
bool IslandDirect::narrow_friction() {
  bool changed = false;
  for (std::size_t i = 0; i + 1 < fixed_outer_; ++i) {
    OuterRow& first = outer_[i];
    OuterRow& second = outer_[i + 1];
    if (first.contact == nullptr || first.normal < 0) continue;
    if (first.contact->m_overrideNumSolverIterations != friction_along) continue;
    const double most = static_cast<double>(first.contact->m_friction) * outer_[at(first.normal)].impulse;
    const double force = fixed::hypot(first.impulse, second.impulse);
    if (!(force > kOutsideOfCone * most)) continue;
    for (OuterRow* row : {&first, &second}) {
      row->friction = static_cast<double>(row->contact->m_friction) * std::fabs(row->impulse) / force;
    }
    changed = true;
  }
  return changed;
}

// Gears whose axes motors, limits or locks hold: the trees don't respond to their impulses.
bool IslandDirect::give_up_pinned_gears() {
  int given_up = 0;
  for (int i = 0; i < box_.size(); ++i) {
    OuterRow& row = outer_[at(boxed_[at(i)])];
    const bool pinned = row.gear >= 0 && !(box_.response(i, i) - row.softness > kPinned * row.eases);
    if (pinned) given_up += give_up_gear(row);
  }
  return given_up > 0;
}

// A gear both of whose axes are held: their motors and limits give way. Where locks hold them, the gear does nothing.
int IslandDirect::give_up_gear(OuterRow& row) {
  int given_up = 0;
  const GearConstraint& gear = *gears_[at(row.gear)].gear;
  for (const Link& link : links_) {
    if (link.node < 0) continue;
    if (link.joint == &gear.joint_a()) given_up += system_.give_up_axis(link.node, gear.axis_a());
    if (link.joint == &gear.joint_b()) given_up += system_.give_up_axis(link.node, gear.axis_b());
  }
  if (given_up == 0) row.lower = row.upper = 0;
  return given_up;
}

int IslandDirect::give_up_touched() {
  int given_up = 0;
  for (const int i : boxed_) {
    for_each_side(outer_[at(i)], [&](const Side& side) {
      const Tree& tree = trees_[at(tree_at(side.node))];
      given_up += system_.give_up_all(tree.first, tree.last);
    });
  }
  return given_up;
}

// With the responses at hand: solves for all outer rows, and lets the trees follow. Returns what a row still misses.
double IslandDirect::solve_outer(Solve how) {
  for (int i = 0; i < box_.size(); ++i) {
    OuterRow& row = outer_[at(boxed_[at(i)])];
    row.begun = row.axis != nullptr ? row.axis->impulse : row.impulse;
    box_.row(i) = {
        row.axis != nullptr ? system_.residual(*row.axis) : row.target - rate_of(row) - row.softness * row.impulse,
        row.begun,
        row.lower,
        row.upper,
        row.normal < 0 ? -1 : place_[at(row.normal)],
        row.friction,
        row.most,
        row.guess,
        row.likely - row.begun};
  }
  const double missed = how == Solve::anew ? box_.solve(kOuterTolerance) : box_.polish();
  for (int i = 0; i < box_.size(); ++i) {
    OuterRow& row = outer_[at(boxed_[at(i)])];
    row.impulse = box_.row(i).impulse;
    row.likely = std::isfinite(row.impulse) ? row.impulse : row.begun;
    row.guess = box_.status(i);
    const double change = row.impulse - row.begun;
    if (row.axis != nullptr) {
      row.axis->guess = in_tree(row.guess);
      row.axis->likely = row.likely;
      system_.push(*row.axis, change);
    } else {
      load(row, change);
    }
  }
  for (const Tree& t : trees_) system_.correct(t.first, t.last);
  return missed;
}

// Penetration is repaired by moving bodies apart, once, without leaving them a velocity (Bullet's split impulse): here
// joints hold while it is done.
void IslandDirect::push_apart(IslandPools& pools, const btContactSolverInfo& info) {
  if (!info.m_splitImpulse || info.m_splitImpulseTurnErp <= 0) return;
  const auto pushes = [](const OuterRow& row) { return row.contact != nullptr && row.normal < 0; };
  const auto wants = [](const OuterRow& row) {
    const double step = static_cast<double>(row.contact->m_jacDiagABInv);
    return step > 0 ? std::min(static_cast<double>(row.contact->m_rhsPenetration) / step, kFastestPush) : 0;
  };
  if (std::none_of(outer_.begin(), outer_.end(), [&](const OuterRow& r) { return pushes(r) && wants(r) > 0; })) return;
  for (OuterRow& row : outer_) row.begun = 0;
  push_rows_.clear();
  for (int i = 0; i < static_cast<int>(fixed_outer_); ++i) {
    const OuterRow& row = outer_[at(i)];
    if (pushes(row) || (row.loop && row.lower < -kTreeInfinity && row.upper > kTreeInfinity)) push_rows_.push_back(i);
  }
  const int count = static_cast<int>(push_rows_.size());
  respond(push_box_, push_rows_);
  for (int i = 0; i < count; ++i) {
    const OuterRow& row = outer_[at(push_rows_[at(i)])];
    BoxSolver::Row& box = push_box_.row(i);
    box.left = row.loop ? 0 : wants(row);
    box.lower = row.loop ? row.lower : 0;
    box.upper = row.upper;
    push_box_.response(i, i) += row.softness + kLeastPushSoftness * row.eases;
  }
  push_box_.solve(kOuterTolerance);
  for (int i = 0; i < system_.trees.size(); ++i) {
    system_.trees.node(i).ask.fill(0);
    system_.trees.node(i).load = {};
  }
  for (int i = 0; i < count; ++i) load(outer_[at(push_rows_[at(i)])], push_box_.row(i).impulse);
  for (const Tree& t : trees_) system_.trees.respond(t.first, t.last);
  double furthest = kFurthestPushTurn / static_cast<double>(info.m_timeStep);
  const double most = furthest;
  for (int i = 0; i < system_.trees.size(); ++i) {
    furthest = std::max(furthest, glm::length(system_.trees.node(i).change.angular));
  }
  const double turn = static_cast<double>(info.m_splitImpulseTurnErp);  // Bullet will multiply with it
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const Spatial change = system_.trees.node(static_cast<int>(i)).change * (most / furthest);
    pools.bodies[body_of_[i]].m_pushVelocity = to_bt(change.linear);
    pools.bodies[body_of_[i]].m_turnVelocity = to_bt(change.angular / turn);
  }
}

// Natural residuals of all rows, at the velocities that were found.
void IslandDirect::take_residuals(const IslandPools& pools) {
  residuals_ = {};
  const auto miss = [](double left, double impulse, double lower, double upper, double eases) {
    const double after = std::clamp(impulse + left / eases, lower, std::max(lower, upper));
    return std::fabs(after - impulse) * eases;
  };
  // from the bodies' velocities, not from what the solver believes of its axes
  const auto moving = [&](int body) {
    const int node = node_of_[at(body)];
    return node < 0 ? velocity(body, pools) : velocity(body, pools) + system_.change(node);
  };
  for (const Link& link : links_) {
    if (link.node < 0) continue;
    const Spatial a = moving(link.body_a);
    const Spatial b = moving(link.body_b);
    for (const TreeRow& row : system_.rows(link.node)) {
      const JointConstraint::Jacobian j = link.joint->jacobian(row.axis);
      const double rate = dot(pull_of(-j.linear, j.angular_a), a) + dot(pull_of(j.linear, j.angular_b), b);
      const TreeNode& n = system_.trees.node(row.node);
      const double eases = 1 / dot(n.axis[row.axis], n.inertia * n.axis[row.axis]) + row.softness;
      const double m = miss(row.velocity - row.softness * row.impulse - rate, row.impulse, row.lower, row.upper, eases);
      double& most = row.bounded() ? residuals_.bounded : residuals_.locked;
      most = std::max(most, m);
    }
  }
  for (int i = 0; i < static_cast<int>(outer_.size()); ++i) {
    const OuterRow& row = outer_[at(i)];
    if (row.axis != nullptr) continue;
    const double reach = row.normal < 0 ? 0 : row.friction * std::max(outer_[at(row.normal)].impulse, 0.0);
    const double bound = row.most > 0 ? std::min(reach, row.most) : reach;
    const double left = row.target - rate_of(row) - row.softness * row.impulse;
    const double m = miss(left, row.impulse, row.normal < 0 ? row.lower : -bound, row.normal < 0 ? row.upper : bound,
                          std::max(place_[at(i)] < 0 ? row.eases : box_.response(place_[at(i)], place_[at(i)]), 1e-9));
    residuals_.contact = std::max(residuals_.contact, m);
  }
}

}  // namespace limber

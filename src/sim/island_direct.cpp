// The order of the work in one island, the guards, and what is written back.
#include "sim/island_direct.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {
namespace {

/// Exchanges of rows in force that a tree gets before its unsettled axes are swept instead.
constexpr int kExchanges = 16;
/// Rounds in which axes may still be given up once contacts are known.
constexpr int kRounds = 8;
/// Motors keep below this turn of a body in one step, rad; where they do not, they ask for this, since what else acts
/// on the body does not become less with them.
constexpr double kMostTurn = 0.5;
constexpr double kTurnGoal = 0.44;
/// So often friction outside of its cone is brought back.
constexpr int kNarrowings = 2;
/// So often bends are corrected.
constexpr int kBends = 4;
/// Bends are taken back when a correction is larger than this, m, and more than twice as large as an earlier one.
constexpr double kDivergingBend = 1e-3;
/// Passes in which gyroscopic torques are corrected; and what is left of them then, relative to the angular velocity
/// perpendicular to the spin, and to all of it.
constexpr int kGyroPasses = 10;
constexpr double kGyroMiss = 1e-5;
constexpr double kGyroMissOfSpin = 1e-7;
/// Bends that made locks drive are eased so often, a little more than a straight line between the two would say.
constexpr int kEasings = 2;
constexpr double kEasing = 0.95;
/// Part of what locks took that they may give back, and the most of it, J.
constexpr double kGivenBack = 0.75;
constexpr double kMostGivenBack = 1e6;
/// Faster than this no impulse of ours may make a body: m/s, rad/s.
constexpr double kFastest = 1e5;

// The sweeps begin without the impulses of the step before, which only ours could hold in balance.
void start_contacts_anew(IslandPools& pools) {
  for (btConstraintArray* rows : {&pools.contacts, &pools.frictions, &pools.rollings}) {
    for (int i = 0; i < rows->size(); ++i) {
      btSolverConstraint& row = (*rows)[i];
      const btScalar impulse = -std::exchange(row.m_appliedImpulse, btScalar(0));
      btSolverBody& a = pools.bodies[row.m_solverBodyIdA];
      btSolverBody& b = pools.bodies[row.m_solverBodyIdB];
      a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, impulse);
      b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, impulse);
    }
  }
}

}  // namespace

void IslandDirect::start() {
  links_.clear();
  gears_.clear();
}

void IslandDirect::add_joint(JointConstraint& joint, int body_a, int body_b) {
  links_.push_back({&joint, body_a, body_b, -1, 0, Vec3(0), Vec3(0)});
}

int IslandDirect::give_up_broken() {
  int broken = 0;
  for (const Tree& t : trees_) broken += system_.give_up_broken(t.first, t.last);
  return broken;
}

// Trees by themselves, contacts as they are; then what stands around them, until no law is broken.
bool IslandDirect::settle() {
  const double before = effort_.spent();
  const bool settled = settle_trees() && (outer_.empty() || settle_outer()) && finite();
  settle_cost_ = effort_.spent() - before;
  return settled;
}

bool IslandDirect::settle_trees() {
  for (const Tree& t : trees_) {
    if (!system_.settle(t.first, t.last, kExchanges)) return false;
    const bool again = !outer_.empty() && system_.give_up_remembered(t.first, t.last) > 0;
    if (again && !system_.refresh(t.first, t.last)) return false;
  }
  collect_axes();
  return true;
}

bool IslandDirect::settle_outer() {
  system_.keep();
  for (OuterRow& row : outer_) row.kept = row.impulse;
  take_contacts();
  for (int round = 0; round < kRounds; ++round) {
    bool pinned = false;
    double missed = 0;
    do {
      if (!build_responses()) return false;
      pinned = give_up_pinned_gears();
      missed = pinned ? 0 : solve_outer(Solve::anew);
    } while (!pinned && take_contacts() > 0);
    int broken = pinned ? 1 : give_up_broken();
    // too stiff to be solved: then every motor and limit that contacts feel gives way as far as its force says
    if ((!(missed < kOuterMiss) || round == kRounds - 2) && give_up_touched() > 0) broken++;
    if (broken == 0) {
      if (!box_.agrees()) missed = solve_outer(Solve::polish);
      return std::isfinite(missed);
    }
    // what was found with other rows in force must not stay
    system_.go_back();
    for (OuterRow& row : outer_) row.impulse = row.kept;
    for (const Tree& t : trees_) {
      if (!system_.refresh(t.first, t.last)) return false;
    }
    collect_axes();
  }
  return false;
}

Turn IslandDirect::turn_of(int body, const Vec3& w, const IslandPools& pools, double h) const {
  const btRigidBody* rigid = pools.bodies[body].m_originalBody;
  if (rigid != nullptr) return split_turn(*rigid, w, h);
  Turn turn;
  turn.rest = w;
  return turn;
}

// Velocity of a body as the step was solved.
Spatial IslandDirect::solved_velocity(int body, const IslandPools& pools) const {
  const int node = node_of_[at(body)];
  return node < 0 ? velocity(body, pools) : velocity(body, pools) + system_.change(node);
}

// Whether a motor on this axis of a joint makes one of its bodies spin.
bool IslandDirect::drives_spin(const Link& link, int axis, const IslandPools& pools, double h) const {
  if (axis < 3) return false;
  const Vec3 along = from_bt(link.joint->linear_axis(axis - 3));
  return std::ranges::any_of(std::array{link.body_a, link.body_b}, [&](int body) {
    const Turn turn = turn_of(body, solved_velocity(body, pools).angular, pools, h);
    return turn.spin != 0 && std::fabs(glm::dot(turn.axis, along)) > 0.99;
  });
}

// A body that would turn far in one step, but for its spin, goes straight where it should go round: motors and limits
// of its tree ask for less then. True when something changed.
bool IslandDirect::limit_turns(const IslandPools& pools, double h) {
  bool changed = false;
  for (const Tree& t : trees_) {
    double fastest = 0;
    for (int i = t.first; i < t.last; ++i) {
      const Spatial v = velocity(body_of_[at(i)], pools) + system_.change(i);
      if (glm::dot(v.angular, v.angular) * h * h <= kMostTurn * kMostTurn) continue;
      const double turn = glm::length(turn_of(body_of_[at(i)], v.angular, pools, h).rest);
      if (t.last - t.first > 1 || link_of_[at(i)] >= 0) fastest = std::max(fastest, turn);
      if (turn * h > kMostTurn) note_clamp(*pools.bodies[body_of_[at(i)]].m_originalBody, turn - kTurnGoal / h);
    }
    if (!(fastest * h > kMostTurn)) continue;
    for (int i = t.first; i < t.last; ++i) {
      for (TreeRow& row : system_.rows(i)) {
        if (!row.bounded() || row.constant()) continue;
        if (link_of_[at(i)] >= 0 && drives_spin(links_[at(link_of_[at(i)])], row.axis, pools, h)) continue;
        row.velocity *= kTurnGoal / (fastest * h);
        changed = true;
      }
    }
  }
  return changed;
}

// Bodies whose gyroscopic torque depends so much on the velocities after the step that joints have to be known for it.
void IslandDirect::collect_gyroscopes(const IslandPools& pools, double h) {
  gyros_.clear();
  gyro_passes_ = 0;
  for (const Tree& t : trees_) {
    if (t.last - t.first == 1 && link_of_[at(t.first)] < 0) continue;
    for (int i = t.first; i < t.last; ++i) {
      const btSolverBody& b = pools.bodies[body_of_[at(i)]];
      const double before = static_cast<double>(b.m_angularVelocity.length());
      const double after = glm::length(solved_velocity(body_of_[at(i)], pools).angular);
      if (!(std::max(before, after) * h > kSlowTurn)) continue;
      const Sym3& moment = system_.trees.node(i).inertia.moment;
      const Vec3 applied = moment * gyroscopic_change(*b.m_originalBody, h);
      gyros_.push_back({i, (moment.xx + moment.yy + moment.zz) / 3, applied, Vec3(0), {}, {}});
    }
  }
}

// Gyroscopic torques are those at the middle of the step, by the velocities that joints, motors and contacts allow: a
// fixed point, approached by Anderson's mixing. True when loads changed: then all is solved anew.
bool IslandDirect::correct_gyroscopes(const IslandPools& pools, double h) {
  if (gyros_.empty() || gyro_passes_ >= kGyroPasses) return false;
  bool missed = false;
  for (Gyro& g : gyros_) {
    const int body = body_of_[at(g.node)];
    const Vec3 before = from_bt(pools.bodies[body].m_angularVelocity);
    const Vec3 middle = (before + solved_velocity(body, pools).angular) / 2.0;
    const btRigidBody& rigid = *pools.bodies[body].m_originalBody;
    const Vec3 miss = h * gyroscopic_torque(rigid, middle, h) - g.impulse;
    g.miss_changes[1] = g.miss_changes[0];
    g.miss_changes[0] = miss - g.miss;
    g.miss = miss;
    const double rest = glm::length(split_turn(rigid, middle, h).rest);
    const double most = kGyroMiss * rest + kGyroMissOfSpin * glm::length(middle);
    missed = missed || glm::length(miss) > most * g.scale;
  }
  if (!missed) return false;
  // the least of |miss - sum of weight·change| over the last one or two passes
  const int known = std::min(gyro_passes_++, 2);
  double normal[2][2] = {};
  double right[2] = {};
  for (const Gyro& g : gyros_) {
    const double scale = 1 / (g.scale * g.scale);
    for (int i = 0; i < known; ++i) {
      right[i] += scale * glm::dot(g.miss_changes[at(i)], g.miss);
      for (int j = 0; j < known; ++j) normal[i][j] += scale * glm::dot(g.miss_changes[at(i)], g.miss_changes[at(j)]);
    }
  }
  double weight[2] = {};
  const double determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
  if (known == 2 && determinant > 1e-9 * normal[0][0] * normal[1][1]) {
    weight[0] = (right[0] * normal[1][1] - right[1] * normal[0][1]) / determinant;
    weight[1] = (right[1] * normal[0][0] - right[0] * normal[1][0]) / determinant;
  } else if (known > 0 && normal[0][0] > 0) {
    weight[0] = right[0] / normal[0][0];
  }
  for (Gyro& g : gyros_) {
    Vec3 change = g.miss;
    for (int i = 0; i < known; ++i) change -= weight[i] * (g.impulse_changes[at(i)] + g.miss_changes[at(i)]);
    g.impulse_changes[1] = g.impulse_changes[0];
    g.impulse_changes[0] = change;
    g.impulse += change;
    system_.trees.node(g.node).load.angular += change;
  }
  return true;
}

// What locks gave or took (J): each impulse times the mean of its rate before and after the step. Locks of a machine do
// no work.
double IslandDirect::work_of_locks(const Tree& tree, const IslandPools& pools) const {
  double work = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    if (link_of_[at(i)] < 0) continue;
    const Link& link = links_[at(link_of_[at(i)])];
    const JointConstraint& joint = *link.joint;
    const auto before = [&](int body) {
      const btSolverBody& b = pools.bodies[body];
      return Spatial{from_bt(b.m_linearVelocity), from_bt(b.m_angularVelocity)};
    };
    const Spatial a = before(link.body_a);
    const Spatial b = before(link.body_b);
    const Vec3 drift = carried(b, from_bt(joint.arm_b())).linear - carried(a, from_bt(joint.arm_a())).linear;
    const Vec3 spin = b.angular - a.angular;
    for (const TreeRow& row : system_.rows(i)) {
      if (row.bounded() || !row.hard()) continue;
      const double rate = row.axis < 3 ? glm::dot(from_bt(joint.linear_axis(row.axis)), drift)
                                       : glm::dot(from_bt(joint.dual_axis(row.axis - 3)), spin);
      work += row.impulse * (rate + system_.rate(i, row.axis)) / 2;
    }
  }
  return work;
}

JointConstraint& IslandDirect::first_joint(const Tree& tree) const {
  const int root = link_of_[at(tree.first)] < 0 ? tree.first + 1 : tree.first;
  return *links_[at(link_of_[at(root)])].joint;
}

bool IslandDirect::passive(const Tree& tree) const {
  if (tree.last - tree.first == 1 && link_of_[at(tree.first)] < 0) return false;
  return !driven(tree);
}

bool IslandDirect::driven(const Tree& tree) const {
  for (int i = tree.first; i < tree.last; ++i) {
    for (const TreeRow& row : system_.rows(i)) {
      if (row.mark == TreeRow::motor && row.upper > row.lower) return true;
    }
  }
  return false;
}

// Where no motor drives, bends that would make locks drive become less. True when something changed.
bool IslandDirect::ease_bends(const IslandPools& pools, double h) {
  bool changed = false;
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const Tree& tree = trees_[t];
    if (!passive(tree)) continue;
    const double work = work_of_locks(tree, pools);
    const double budget = first_joint(tree).taken_by_locks();
    if (!(work > budget)) continue;
    const double unbent = unbent_work_[t];
    const double part = unbent < budget ? kEasing * (budget - unbent) / (work - unbent) : 0;
    for (int i = tree.first; i < tree.last; ++i) {
      if (link_of_[at(i)] < 0) continue;
      Link& link = links_[at(link_of_[at(i)])];
      changed = changed || link.bent != Vec3(0);
      link.bend = link.bent * part;
      ask_for_bend(link, h);
    }
  }
  return changed;
}

bool IslandDirect::finite() const {
  for (int i = 0; i < static_cast<int>(body_of_.size()); ++i) {
    const Spatial& c = system_.change(i);
    for (int k = 0; k < 3; ++k) {
      if (!(std::fabs(c.linear[k]) < kFastest) || !(std::fabs(c.angular[k]) < kFastest)) return false;
    }
  }
  return true;
}

// All but the bends.
bool IslandDirect::settle_all(IslandPools& pools, double h) {
  outer_.clear();
  box_factors_ = 0;
  known_names_.clear();
  known_axes_.clear();
  collect_contacts(pools);
  collect_loops(pools);
  collect_gears(pools);
  fixed_outer_ = outer_.size();
  bool settled = settle();
  for (int pass = 0; pass < kNarrowings && settled && narrow_friction(); ++pass) settled = settle();
  for (int pass = 0; pass < 3 && settled && limit_turns(pools, h); ++pass) settled = settle();
  return settled;
}

// Bends, until they fit, and of passive trees as far as they may.
bool IslandDirect::bend_all(const IslandPools& pools, double h) {
  gapes_ = false;
  unbent_work_.clear();
  for (const Tree& t : trees_) unbent_work_.push_back(passive(t) ? work_of_locks(t, pools) : 0);
  bool solved = true;
  bool bending = true;
  bool turning = true;
  double least = kFastest;
  const auto time_left = [this] { return !effort_.over(settle_cost_); };
  collect_gyroscopes(pools, h);
  for (int pass = 0; solved && (bending || turning) && time_left(); ++pass) {
    turning = correct_gyroscopes(pools, h);
    if (pass < kBends && bending) {
      const double bent = bend_locks(pools, h);
      bending = bent > 0;
      if (bent > kDivergingBend && bent > 2 * least) {
        straighten(h);  // the gap that is left is closed afterwards, by moving the bodies
        gapes_ = true;
        return settle();
      }
      least = std::min(least, bent);
    }
    if (pass >= kBends && !turning) break;
    if (bending || turning) solved = settle();
  }
  gapes_ = gapes_ || bending;
  for (int pass = 0; pass < kEasings && solved && ease_bends(pools, h); ++pass) solved = settle();
  return solved;
}

bool IslandDirect::solve(IslandPools pools, const btContactSolverInfo& info) {
  const int most = links_.empty() ? kMostRowsWithoutJoints : kMostContactRows;
  if (pools.contacts.size() + pools.frictions.size() + pools.rollings.size() > most) {
    counts_.plain++;
    return false;
  }
  const double h = static_cast<double>(info.m_timeStep);
  step_ = h;
  before_calm_.clear();
  effort_.begin();
  bool solved = build_forest(pools);
  if (solved && calm_whips(pools, h, Whips::before)) solved = build_forest(pools);
  if (solved) solved = settle_all(pools, h);
  // with no time left they wait for the next step
  if (solved && !effort_.over() && calm_whips(pools, h, Whips::after)) {
    solved = build_forest(pools) && settle_all(pools, h);
  }
  if (solved) solved = bend_all(pools, h);
  if (!solved) {
    counts_.fallbacks++;
    forget_calm(pools);
    start_contacts_anew(pools);
    for (const Link& link : links_) {
      link.joint->forget_impulses();
      link.joint->tree_memory().fill(0);
    }
    for (const GearLink& link : gears_) link.gear->forget_impulses();
    return false;
  }
  counts_.direct++;
  for (const Tree& t : trees_) {
    if (!passive(t)) continue;
    double& taken = first_joint(t).taken_by_locks();
    const double work = work_of_locks(t, pools);
    taken = std::clamp(taken - (work < 0 ? kGivenBack : 1.0) * work, 0.0, kMostGivenBack);
  }
  write(pools);
  push_apart(pools, info);
  if (measured_) take_residuals(pools);
  if (gapes_) close_joints(pools, info);
  return true;
}

void IslandDirect::write(IslandPools& pools) {
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    btSolverBody& body = pools.bodies[body_of_[i]];
    const Spatial& change = system_.change(static_cast<int>(i));
    body.m_deltaLinearVelocity = to_bt(change.linear);
    body.m_deltaAngularVelocity = to_bt(change.angular);
  }
  for (const OuterRow& row : outer_) {
    if (row.contact != nullptr) row.contact->m_appliedImpulse = to_scalar(row.impulse);
  }
  for (const Link& link : links_) {
    impulses_.clear();
    if (link.node >= 0) {
      for (const TreeRow& row : system_.rows(link.node)) impulses_.push_back(row.impulse);
      link.joint->tree_memory() = system_.memory(link.node);
    } else {
      for (int r = 0; r < static_cast<int>(link.joint->planned().size()); ++r) {
        impulses_.push_back(outer_[at(link.outer + r)].impulse);
      }
    }
    link.joint->take_impulses(impulses_);
  }
  for (const GearLink& link : gears_) link.gear->take_impulse(outer_[at(link.outer)].impulse);
}

}  // namespace limber

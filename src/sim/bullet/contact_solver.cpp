// Rows of the same body depend on each other, so latency matters: a pair's velocities stay in registers from row to row
// and are prefetched.
#include "sim/bullet/contact_solver.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/memory/prefetch.h"

namespace limber::sim::bullet {
namespace {

/// Prefetch distance, in pairs.
constexpr int kPairsAhead = 3;
/// N·s: Bullet's upper bound of a contact's impulse.
constexpr float kNoBound = 1e10f;

Float4 with_w(const btVector3& v, float w) {
  Float4 l = to_float4(v);
  l[3] = w;
  return l;
}

Float4 broadcast(float x) { return Float4{x, x, x, x}; }

template <int kLane>
Float4 broadcast(Float4 l) {
  return __builtin_shufflevector(l, l, kLane, kLane, kLane, kLane);
}

}  // namespace

// Bullet leaves out the normal of a static body.
void ContactSolver::load_row(const btSolverConstraint& from, bool a_moves, Row& row) {
  row.normal = with_w(a_moves ? from.m_contactNormal1 : -from.m_contactNormal2, from.m_rhs);
  row.jacobian_a = with_w(from.m_relpos1CrossNormal, from.m_jacDiagABInv);
  row.jacobian_b = with_w(from.m_relpos2CrossNormal, from.m_cfm);
  row.response_a = to_float4(from.m_angularComponentA);
  row.response_b = to_float4(from.m_angularComponentB);
  row.impulse = from.m_appliedImpulse;
  row.friction = from.m_friction;
  row.push_target = from.m_rhsPenetration;
  row.push_impulse = from.m_appliedPushImpulse;
}

void ContactSolver::begin(btAlignedObjectArray<btSolverBody>& bodies, const btConstraintArray& contacts,
                          const btConstraintArray& friction) {
  bodies_ = &bodies;
  bullet_contacts_ = &contacts;
  bullet_friction_ = &friction;
  const int count = contacts.size();
  LIMBER_CHECK(friction.size() == 2 * count);
  contacts_.resizeNoInitialize(count);
  friction_.resizeNoInitialize(friction.size());
  pairs_.resizeNoInitialize(0);
  for (int i = 0; i < count; ++i) {
    const btSolverConstraint& c = contacts[i];
    const bool a_moves = bodies[c.m_solverBodyIdA].m_originalBody != nullptr;
    load_row(c, a_moves, contacts_[i]);
    load_row(friction[2 * i], a_moves, friction_[2 * i]);
    load_row(friction[2 * i + 1], a_moves, friction_[2 * i + 1]);
    const float step = std::min(friction[2 * i].m_jacDiagABInv, friction[2 * i + 1].m_jacDiagABInv);
    for (int k = 2 * i; k < 2 * i + 2; ++k) {
      const float own_step = friction[k].m_jacDiagABInv;
      friction_[k].push_target = own_step > 0 ? step / own_step : 1;
    }
    Pair* const last = pairs_.size() > 0 ? &pairs_[pairs_.size() - 1] : nullptr;
    if (last != nullptr && last->a == c.m_solverBodyIdA && last->b == c.m_solverBodyIdB) {
      last->end = i + 1;
    } else {
      pairs_.push_back({c.m_solverBodyIdA, c.m_solverBodyIdB, i, i + 1});
    }
  }
}

// Adds in Bullet's order, so that results round equally; without branches, since they are unpredictable. Scalars are
// broadcast to all elements. Returns the squared change.
inline float ContactSolver::solve(Row& row, float target, float& impulse, float lower, float upper, PairVelocity& v) {
  const Float4 speeds = sum_xyz(row.normal * v.linear_a, row.jacobian_a * v.angular_a, row.normal * v.linear_b,
                                row.jacobian_b * v.angular_b);
  const Float4 step = broadcast<3>(row.jacobian_a);
  const Float4 before = broadcast(impulse);
  const Float4 low = broadcast(lower);
  const Float4 high = broadcast(upper);
  const Float4 free = ((broadcast(target) - before * broadcast<3>(row.jacobian_b)) -
                       (broadcast<0>(speeds) + broadcast<1>(speeds)) * step) -
                      (broadcast<3>(speeds) - broadcast<2>(speeds)) * step;
  const Float4 sum = before + free;
  Float4 change = sum < low ? low - before : free;
  change = sum > high ? high - before : change;
  Float4 after = sum < low ? low : sum;
  after = sum > high ? high : after;
  impulse = after[0];
  v.linear_a += row.normal * v.mass_a * change;
  v.angular_a += row.response_a * change;
  v.linear_b -= row.normal * v.mass_b * change;
  v.angular_b += row.response_b * change;
  return change[0] * change[0];
}

// Impulse that the row needs in addition to its present one; its softness applies to the direct solver only.
inline float ContactSolver::unclamped_change(const Row& row, const PairVelocity& v) {
  const Float4 speeds = sum_xyz(row.normal * v.linear_a, row.jacobian_a * v.angular_a, row.normal * v.linear_b,
                                row.jacobian_b * v.angular_b);
  return row.normal[3] - ((speeds[0] + speeds[1]) + (speeds[3] - speeds[2])) * row.jacobian_a[3];
}

// Sticks if the disc permits the impulse. Otherwise both rows take a step of the same length against the slip and are
// projected onto the disc, so that friction becomes opposite to the slip. Returns the larger squared change.
inline float ContactSolver::solve_friction(Row& first, Row& second, float normal_impulse, PairVelocity& v) {
  const float max_impulse = first.friction * normal_impulse;
  const float free_first = unclamped_change(first, v);
  const float free_second = unclamped_change(second, v);
  float along = first.impulse + free_first;
  float across = second.impulse + free_second;
  if (along * along + across * across > max_impulse * max_impulse) {
    along = first.impulse + free_first * first.push_target;
    across = second.impulse + free_second * second.push_target;
    const float length2 = along * along + across * across;
    const float fraction = length2 > max_impulse * max_impulse ? max_impulse / std::sqrt(length2) : 1.0F;
    along *= fraction;
    across *= fraction;
  }
  const float change_first = along - first.impulse;
  const float change_second = across - second.impulse;
  first.impulse = along;
  second.impulse = across;
  v.linear_a += (first.normal * change_first + second.normal * change_second) * v.mass_a;
  v.angular_a += first.response_a * change_first + second.response_a * change_second;
  v.linear_b -= (first.normal * change_first + second.normal * change_second) * v.mass_b;
  v.angular_b += first.response_b * change_first + second.response_b * change_second;
  return std::max(change_first * change_first, change_second * change_second);
}

// Calls work(contact, velocity) for each contact, with the velocity of its pair.
template <class Velocity, class Work>
void ContactSolver::for_each_contact(Work&& work) {
  constexpr std::size_t kSpeeds = 7 * sizeof(btVector3);  // up to and including the split-impulse velocities
  const int count = pairs_.size();
  for (int p = 0; p < count; ++p) {
    if (p + kPairsAhead < count) {
      const Pair& next = pairs_[p + kPairsAhead];
      prefetch(&(*bodies_)[next.a].m_deltaLinearVelocity, kSpeeds);
      prefetch(&(*bodies_)[next.b].m_deltaLinearVelocity, kSpeeds);
    }
    const Pair& pair = pairs_[p];
    btSolverBody& a = (*bodies_)[pair.a];
    btSolverBody& b = (*bodies_)[pair.b];
    Velocity v(a, b);
    for (int i = pair.first; i < pair.end; ++i) work(i, v);
    v.store(a, b);
  }
}

btScalar ContactSolver::sweep_split_impulse() {
  float largest = 0;
  for_each_contact<PairPushVelocity>([&](int i, PairPushVelocity& v) {
    Row& row = contacts_[i];
    if (row.push_target == 0) return;
    largest = std::max(largest, solve(row, row.push_target, row.push_impulse, 0, kNoBound, v));
  });
  return largest;
}

btScalar ContactSolver::sweep() {
  float largest = 0;
  for_each_contact<PairVelocity>([&](int i, PairVelocity& v) {
    Row& row = contacts_[i];
    largest = std::max(largest, solve(row, row.normal[3], row.impulse, 0, kNoBound, v));
  });
  for_each_contact<PairVelocity>([&](int i, PairVelocity& v) {
    const float normal_impulse = contacts_[i].impulse;
    if (!(normal_impulse > 0)) return;
    largest = std::max(largest, solve_friction(friction_[2 * i], friction_[2 * i + 1], normal_impulse, v));
  });
  return largest;
}

void ContactSolver::finish() const {
  for (int i = 0; i < contacts_.size(); ++i) {
    (*bullet_contacts_)[i].m_appliedImpulse = contacts_[i].impulse;
    (*bullet_contacts_)[i].m_appliedPushImpulse = contacts_[i].push_impulse;
  }
  for (int i = 0; i < friction_.size(); ++i) (*bullet_friction_)[i].m_appliedImpulse = friction_[i].impulse;
}

}  // namespace limber::sim::bullet

// A row waits for the one before it wherever both move the same body, so what counts is how soon a pair's velocities
// are there: in registers from row to row, and asked for before it is the pair's turn.
#include "sim/contact_sweep.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/prefetch.h"

namespace limber {
namespace {

/// So many pairs ahead their bodies are asked for.
constexpr int kPairsAhead = 3;
/// N·s: Bullet bounds no contact by less.
constexpr float kNoBound = 1e10f;

Lanes with_fourth(const btVector3& v, float fourth) {
  Lanes l = lanes(v);
  l[3] = fourth;
  return l;
}

Lanes all(float x) { return Lanes{x, x, x, x}; }

template <int kLane>
Lanes all(Lanes l) {
  return __builtin_shufflevector(l, l, kLane, kLane, kLane, kLane);
}

}  // namespace

// Bullet leaves the normal out of a body that does not move.
void ContactSweep::take(const btSolverConstraint& from, bool a_moves, Row& row) {
  row.normal = with_fourth(a_moves ? from.m_contactNormal1 : -from.m_contactNormal2, from.m_rhs);
  row.turn_a = with_fourth(from.m_relpos1CrossNormal, from.m_jacDiagABInv);
  row.turn_b = with_fourth(from.m_relpos2CrossNormal, from.m_cfm);
  row.answer_a = lanes(from.m_angularComponentA);
  row.answer_b = lanes(from.m_angularComponentB);
  row.impulse = from.m_appliedImpulse;
  row.friction = from.m_friction;
  row.push_wanted = from.m_rhsPenetration;
  row.push = from.m_appliedPushImpulse;
}

void ContactSweep::begin(btAlignedObjectArray<btSolverBody>& bodies, const btConstraintArray& contacts,
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
    take(c, a_moves, contacts_[i]);
    take(friction[2 * i], a_moves, friction_[2 * i]);
    take(friction[2 * i + 1], a_moves, friction_[2 * i + 1]);
    const float step = std::min(friction[2 * i].m_jacDiagABInv, friction[2 * i + 1].m_jacDiagABInv);
    for (int k = 2 * i; k < 2 * i + 2; ++k) {
      const float own = friction[k].m_jacDiagABInv;
      friction_[k].push_wanted = own > 0 ? step / own : 1;
    }
    Pair* const last = pairs_.size() > 0 ? &pairs_[pairs_.size() - 1] : nullptr;
    if (last != nullptr && last->a == c.m_solverBodyIdA && last->b == c.m_solverBodyIdB) {
      last->end = i + 1;
    } else {
      pairs_.push_back({c.m_solverBodyIdA, c.m_solverBodyIdB, i, i + 1});
    }
  }
}

// Bullet's own order of sums, so that they round as Bullet's do; no branches, whose outcome nothing foretells. Numbers
// are in all lanes alike. Returns the squared change.
inline float ContactSweep::solve(Row& row, float wanted, float& impulse, float lower, float upper, PairVelocity& v) {
  const Lanes speeds = sums_of_three(row.normal * v.linear_a, row.turn_a * v.angular_a, row.normal * v.linear_b,
                                     row.turn_b * v.angular_b);
  const Lanes step = all<3>(row.turn_a);
  const Lanes before = all(impulse);
  const Lanes low = all(lower);
  const Lanes high = all(upper);
  const Lanes free = ((all(wanted) - before * all<3>(row.turn_b)) - (all<0>(speeds) + all<1>(speeds)) * step) -
                     (all<3>(speeds) - all<2>(speeds)) * step;
  const Lanes sum = before + free;
  Lanes change = sum < low ? low - before : free;
  change = sum > high ? high - before : change;
  Lanes after = sum < low ? low : sum;
  after = sum > high ? high : after;
  impulse = after[0];
  v.linear_a += row.normal * v.mass_a * change;
  v.angular_a += row.answer_a * change;
  v.linear_b -= row.normal * v.mass_b * change;
  v.angular_b += row.answer_b * change;
  return change[0] * change[0];
}

// What the row would need beside the impulse that it has; its softness is the direct solver's.
inline float ContactSweep::free_impulse(const Row& row, const PairVelocity& v) {
  const Lanes speeds = sums_of_three(row.normal * v.linear_a, row.turn_a * v.angular_a, row.normal * v.linear_b,
                                     row.turn_b * v.angular_b);
  return row.normal[3] - ((speeds[0] + speeds[1]) + (speeds[3] - speeds[2])) * row.turn_a[3];
}

// Sticks where the disc has room for that. Where it slides, both rows take a step of one length against the slip and go
// back onto the disc, so that friction ends up opposite to the slip. Returns the larger squared change.
inline float ContactSweep::solve_friction(Row& first, Row& second, float pressing, PairVelocity& v) {
  const float most = first.friction * pressing;
  const float free_first = free_impulse(first, v);
  const float free_second = free_impulse(second, v);
  float along = first.impulse + free_first;
  float across = second.impulse + free_second;
  if (along * along + across * across > most * most) {
    along = first.impulse + free_first * first.push_wanted;
    across = second.impulse + free_second * second.push_wanted;
    const float length2 = along * along + across * across;
    const float part = length2 > most * most ? most / std::sqrt(length2) : 1.0F;
    along *= part;
    across *= part;
  }
  const float change_first = along - first.impulse;
  const float change_second = across - second.impulse;
  first.impulse = along;
  second.impulse = across;
  v.linear_a += (first.normal * change_first + second.normal * change_second) * v.mass_a;
  v.angular_a += first.answer_a * change_first + second.answer_a * change_second;
  v.linear_b -= (first.normal * change_first + second.normal * change_second) * v.mass_b;
  v.angular_b += first.answer_b * change_first + second.answer_b * change_second;
  return std::max(change_first * change_first, change_second * change_second);
}

// Calls work(contact, velocity) for each contact, with the velocity of its pair.
template <class Velocity, class Work>
void ContactSweep::each_pair(Work&& work) {
  constexpr std::size_t kSpeeds = 7 * sizeof(btVector3);  // up to those that only push apart
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

btScalar ContactSweep::push_apart() {
  float largest = 0;
  each_pair<PairPush>([&](int i, PairPush& v) {
    Row& row = contacts_[i];
    if (row.push_wanted == 0) return;
    largest = std::max(largest, solve(row, row.push_wanted, row.push, 0, kNoBound, v));
  });
  return largest;
}

btScalar ContactSweep::sweep() {
  float largest = 0;
  each_pair<PairVelocity>([&](int i, PairVelocity& v) {
    Row& row = contacts_[i];
    largest = std::max(largest, solve(row, row.normal[3], row.impulse, 0, kNoBound, v));
  });
  each_pair<PairVelocity>([&](int i, PairVelocity& v) {
    const float pressing = contacts_[i].impulse;
    if (!(pressing > 0)) return;
    largest = std::max(largest, solve_friction(friction_[2 * i], friction_[2 * i + 1], pressing, v));
  });
  return largest;
}

void ContactSweep::finish() const {
  for (int i = 0; i < contacts_.size(); ++i) {
    (*bullet_contacts_)[i].m_appliedImpulse = contacts_[i].impulse;
    (*bullet_contacts_)[i].m_appliedPushImpulse = contacts_[i].push;
  }
  for (int i = 0; i < friction_.size(); ++i) (*bullet_friction_)[i].m_appliedImpulse = friction_[i].impulse;
}

}  // namespace limber

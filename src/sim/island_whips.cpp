// Whips: bodies that turn by more than kTurnClamp in a step, spins (spin.h) not counted. Their tree goes on with less
// of its inner motion: what it moves as one piece, and so its momentum, stays, and so does every law that its rates
// kept.
#include <algorithm>

#include "sim/island_direct.h"

namespace limber {
namespace {

/// What is left of a turn that whips after all was solved, as a part of kTurnClamp: contacts and motors will give
/// some of it back.
constexpr double kLeft = 0.5;
/// What was calmed to kTurnClamp just now is not more than that.
constexpr double kMore = 1.01;

Vec3 center_of(const btRigidBody& body) { return from_bt(body.getCenterOfMassPosition()); }

}  // namespace

Vec3 IslandDirect::angular_velocity(int node, const IslandPools& pools, Whips which) const {
  const int body = body_of_[at(node)];
  if (which == Whips::after) return solved_velocity(body, pools).angular;
  return from_bt(pools.bodies[body].m_angularVelocity);
}

// Without the spin of the body.
Spatial IslandDirect::moving(int node, const IslandPools& pools, Whips which, double h) const {
  const int body = body_of_[at(node)];
  const btSolverBody& b = pools.bodies[body];
  Spatial v{from_bt(b.m_linearVelocity), from_bt(b.m_angularVelocity)};
  if (which == Whips::after) v = velocity(body, pools) + system_.change(node);
  const Turn turn = turn_of(body, v.angular, pools, h);
  return {v.linear - turn.spin * glm::cross(turn.axis, turn.lever), turn.rest};
}

// A tree that stands on something does not move as one piece.
IslandDirect::Rigid IslandDirect::motion_of(const Tree& tree, const IslandPools& pools, Whips which, double h) const {
  Rigid rigid;
  if (link_of_[at(tree.first)] >= 0) return rigid;
  const auto center = [&](int node) { return center_of(*pools.bodies[body_of_[at(node)]].m_originalBody); };
  // without what add_geometric_inertia() adds: that has no momentum
  const auto inertia = [&](int node) { return inertia_of(*pools.bodies[body_of_[at(node)]].m_originalBody); };
  double mass = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    mass += inertia(i).mass.xx;
    rigid.center += center(i) * inertia(i).mass.xx;
  }
  rigid.center /= mass;
  // seen from the centre, the momentum of all and what resists it
  SpatialInertia all;
  Spatial momentum;
  for (int i = tree.first; i < tree.last; ++i) {
    const Vec3 arm = center(i) - rigid.center;
    all.add_carried(inertia(i), arm);
    momentum += brought_back(inertia(i) * moving(i, pools, which, h), arm);
  }
  const Sym3& m = all.moment;
  const Mat3 moment(Vec3(m.xx, m.xy, m.xz), Vec3(m.xy, m.yy, m.yz), Vec3(m.xz, m.yz, m.zz));
  rigid.velocity = {momentum.linear / mass, glm::inverse(moment) * momentum.angular};
  return rigid;
}

// True when something changed: then the forest has to be built anew, from the changes that bodies begin with.
bool IslandDirect::calm_whips(IslandPools& pools, double h, Whips which) {
  bool changed = false;
  for (const Tree& t : trees_) {
    if (t.last - t.first == 1 && link_of_[at(t.first)] < 0) continue;
    double fastest = 0;
    for (int i = t.first; i < t.last; ++i) {
      const Vec3 w = angular_velocity(i, pools, which);
      if (glm::dot(w, w) * h * h <= kTurnClamp * kTurnClamp) continue;
      fastest = std::max(fastest, glm::length(moving(i, pools, which, h).angular));
    }
    if (!(fastest * h > kMore * kTurnClamp)) continue;
    const Rigid rigid = motion_of(t, pools, which, h);
    fastest = 0;
    for (int i = t.first; i < t.last; ++i) {
      fastest = std::max(fastest, glm::length(moving(i, pools, which, h).angular - rigid.velocity.angular));
    }
    if (!(fastest * h > kMore * kTurnClamp)) continue;
    if (!changed && before_calm_.empty()) {
      for (int i = 0; i < pools.bodies.size(); ++i)
        before_calm_.emplace_back(pools.bodies[i].m_deltaLinearVelocity, pools.bodies[i].m_deltaAngularVelocity);
    }
    changed = true;
    const double less = (which == Whips::before ? 1 : kLeft) * kTurnClamp / (fastest * h) - 1;
    for (int i = t.first; i < t.last; ++i) {
      btSolverBody& body = pools.bodies[body_of_[at(i)]];
      const Vec3 arm = center_of(*body.m_originalBody) - rigid.center;
      const Spatial inner = moving(i, pools, which, h) - carried(rigid.velocity, arm);
      if (glm::length(inner.angular) * h > kMore * kTurnClamp) {
        note_clamp(*body.m_originalBody, -glm::length(inner.angular) * less);
      }
      body.m_deltaLinearVelocity += to_bt(inner.linear * less);
      body.m_deltaAngularVelocity += to_bt(inner.angular * less);
    }
  }
  return changed;
}

// The sweeps begin as if nothing had been done.
void IslandDirect::forget_calm(IslandPools& pools) const {
  for (std::size_t i = 0; i < before_calm_.size(); ++i) {
    btSolverBody& body = pools.bodies[static_cast<int>(i)];
    body.m_deltaLinearVelocity = before_calm_[i].first;
    body.m_deltaAngularVelocity = before_calm_[i].second;
  }
}

}  // namespace limber

// Sweeps fast bodies against their neighbors, in rounds until no body stops earlier than before.
#include "sim/bullet/continuous_collision.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::bullet {
namespace {

/// A body is fast if its points move by more than this share of the radius of a sphere within it. Two slow bodies can't
/// pass each other's centers in a substep: their contact separates them to the proper side.
constexpr btScalar kFastShare = 0.9F;
/// Bodies that stop early can be hit by others: that many rounds take it into account. Each round only shortens the
/// motion, and only by more than kMinChange of a substep.
constexpr int kMaxRounds = 6;
constexpr btScalar kMinChange = 1e-4F;

}  // namespace

bool ContinuousCollision::is_fast(const btRigidBody& body, btScalar h) {
  const btScalar threshold = body.getCcdMotionThreshold() * kFastShare;
  if (!(threshold > 0)) return false;
  const btScalar speed2 = body.getLinearVelocity().length2();
  const btScalar spin2 = body.getAngularVelocity().length2();
  const btScalar reach = body.getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE
                             ? btScalar(0)
                             : body.getCollisionShape()->getAngularMotionDisc();
  const btScalar motion = (std::sqrt(speed2) + std::sqrt(spin2) * reach) * h;
  return motion > threshold;
}

void ContinuousCollision::begin(const AwakeObjects& awake) {
  awake_ = &awake;
  joined_.assign(awake.joined());
  const auto count = static_cast<std::size_t>(awake.bodies().size());
  stops_.assign(count, 1);
  state_.assign(count, State::moved);
  movers_.clear();
}

void ContinuousCollision::add(btRigidBody& body, btScalar h) {
  const int index = awake_->index_of(body);
  if (index < 0 || body.getBroadphaseHandle() == nullptr) return;
  state_[static_cast<std::size_t>(index)] = State::slow;
  if (!is_fast(body, h)) return;
  state_[static_cast<std::size_t>(index)] = State::fast;
  Mover mover{&body, index, {0, 0, 0}, {0, 0, 0}};
  sweep_of(body, h).bounds(mover.low, mover.high);
  movers_.push_back(mover);
}

btScalar ContinuousCollision::stop(const btCollisionObject& body) {
  const int index = awake_->index_of(body);
  return index < 0 ? btScalar(1) : stops_[static_cast<std::size_t>(joined_.root(index))];
}

// The motion of an object in this substep. Slow bodies may have been moved already: they start where they came from.
collision::Sweep ContinuousCollision::sweep_of(const btCollisionObject& object, btScalar h) {
  collision::Sweep sweep;
  sweep.shape = object.getCollisionShape();
  sweep.start = object.getWorldTransform();
  sweep.radius = object.getCcdMotionThreshold();
  const btRigidBody* const body = btRigidBody::upcast(&object);
  if (body == nullptr) return sweep;
  sweep.linear = body->getLinearVelocity() * h;  // also of static bodies that move (KinematicBodies)
  sweep.angular = body->getAngularVelocity() * h;
  const int index = awake_->index_of(object);
  if (index < 0) return sweep;  // static, or asleep
  if (state_[static_cast<std::size_t>(index)] != State::moved) {
    sweep.stop = stop(object);
  } else {
    sweep.start.setOrigin(sweep.start.getOrigin() - sweep.linear);
    sweep.angular.setZero();
  }
  remove_symmetric_spin(sweep);
  return sweep;
}

void ContinuousCollision::find_pairs(collision::Broadphase& broadphase, btDispatcher& dispatcher) {
  pairs_.clear();
  std::ranges::sort(movers_, [](const Mover& a, const Mover& b) {
    return a.low.x() != b.low.x() ? a.low.x() < b.low.x() : a.index < b.index;
  });
  const auto add_pair = [&](int mover, btCollisionObject& other) {
    const btRigidBody& body = *movers_[static_cast<std::size_t>(mover)].body;
    if (dispatcher.needsResponse(&body, &other)) pairs_.push_back({mover, &other});
  };
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    found_.clear();
    broadphase.find_collidable(*movers_[i].body, movers_[i].low, movers_[i].high, stack_, found_);
    for (btCollisionObject* other : found_) {
      if (!is_mover(*other)) add_pair(static_cast<int>(i), *other);
    }
  }
  // the boxes in the trees don't include the motion of other fast bodies
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    for (std::size_t k = i + 1; k < movers_.size() && movers_[k].low.x() <= movers_[i].high.x(); ++k) {
      if (TestAabbAgainstAabb2(movers_[i].low, movers_[i].high, movers_[k].low, movers_[k].high) &&
          collision::Broadphase::may_collide(*movers_[i].body, *movers_[k].body))
        add_pair(static_cast<int>(i), *movers_[k].body);
    }
  }
}

bool ContinuousCollision::is_mover(const btCollisionObject& object) const {
  const int index = awake_->index_of(object);
  return index >= 0 && state_[static_cast<std::size_t>(index)] == State::fast;
}

// One round; returns false if nothing stops earlier than before.
bool ContinuousCollision::find_impacts(btScalar h) {
  next_stops_ = stops_;
  bool changed = false;
  const auto is_settled = [&](int index) {
    return index < 0 || last_stops_[static_cast<std::size_t>(joined_.root(index))] ==
                            stops_[static_cast<std::size_t>(joined_.root(index))];
  };
  for (const Pair& pair : pairs_) {
    const Mover& mover = movers_[static_cast<std::size_t>(pair.mover)];
    if (is_settled(mover.index) && is_settled(awake_->index_of(*pair.other))) continue;
    const btScalar time = time_of_impact(sweep_of(*mover.body, h), sweep_of(*pair.other, h));
    if (!(time < 1)) continue;
    for (const int index : {mover.index, awake_->index_of(*pair.other)}) {
      if (index < 0 || state_[static_cast<std::size_t>(index)] != State::fast) continue;
      const auto root = static_cast<std::size_t>(joined_.root(index));
      if (time >= next_stops_[root] - kMinChange) continue;
      next_stops_[root] = time;
      changed = true;
    }
  }
  last_stops_.swap(stops_);
  stops_.swap(next_stops_);
  return changed;
}

void ContinuousCollision::find_stops(collision::Broadphase& broadphase, btDispatcher& dispatcher, btScalar h) {
  find_pairs(broadphase, dispatcher);
  last_stops_.assign(stops_.size(), 0);
  for (int round = 0; round < kMaxRounds && find_impacts(h); ++round) {
  }
}

}  // namespace limber::sim::bullet

// ContinuousCollision: keeps fast bodies from passing through others between two substeps.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/bullet/awake_objects.h"
#include "sim/bullet/bullet.h"
#include "sim/collision/broadphase.h"
#include "sim/collision/time_of_impact.h"

namespace limber::sim::bullet {

/// A body that would hit another one during a substep stops where they begin to overlap, together with all bodies that
/// are joined to it; it keeps its velocity, and the contact acts in the next substep. So it loses less than a substep
/// of its motion, joints don't gape, and bounce and friction are those of any contact. Contacts that begin within a
/// substep are predicted in most cases (ManifoldBuilder); this catches the others: of parts with restitution, fast
/// rotation, round shapes and grazing hits.
///
/// Per substep: mark_fast() for each batch of islands with a fast body, instead of moving it; then, if there are any,
/// begin(), add() for each of their bodies, find_stops(), and stop() for each body. Memory is reused; it is on the
/// heap, because the data lives for one substep only. [sim]
class ContinuousCollision {
 public:
  /// True if a body moves so far in a step of `h` s, relative to its inner radius (stored as Bullet's motion threshold;
  /// 0: never), that contacts may miss another one. Slow bodies cost only this.
  static bool is_fast(const btRigidBody& body, btScalar h);

  /// Forgets the batches of the last substep.
  void reset_batches(int count) { fast_batches_.assign(static_cast<std::size_t>(count), 0); }
  /// [any thread, a different batch each]
  void mark_fast(int batch) { fast_batches_[static_cast<std::size_t>(batch)] = 1; }
  bool is_fast_batch(int batch) const { return fast_batches_[static_cast<std::size_t>(batch)] != 0; }
  bool any_fast() const { return std::ranges::find(fast_batches_, 1) != fast_batches_.end(); }

  /// Forgets the bodies of the last substep.
  void begin(const AwakeObjects& awake);
  /// Adds a body that has not been moved in this substep.
  void add(btRigidBody& body, btScalar h);
  /// Finds where the added bodies stop.
  void find_stops(collision::Broadphase& broadphase, btDispatcher& dispatcher, btScalar h);
  /// The fraction of the substep after which a body stops; 1: it doesn't.
  btScalar stop(const btCollisionObject& body);
  /// The same for the parts of a joint.
  btScalar stop(btTypedConstraint& joint) { return std::min(stop(joint.getRigidBodyA()), stop(joint.getRigidBodyB())); }

 private:
  struct Mover {  // a fast body
    btRigidBody* body;
    int index;  // of AwakeObjects
    btVector3 low, high;
  };
  enum class State : std::uint8_t { moved, slow, fast };  // in this substep: moved already, or to be moved
  struct Pair {
    int mover;
    btCollisionObject* other;
  };
  collision::Sweep sweep_of(const btCollisionObject& object, btScalar h);
  void find_pairs(collision::Broadphase& broadphase, btDispatcher& dispatcher);
  bool is_mover(const btCollisionObject& object) const;
  bool find_impacts(btScalar h);

  std::vector<std::uint8_t> fast_batches_;
  const AwakeObjects* awake_ = nullptr;
  UnionFind joined_;                  // copy of the awake objects' sets
  std::vector<btScalar> stops_;       // by root in joined_
  std::vector<btScalar> last_stops_;  // before the previous round
  std::vector<btScalar> next_stops_;  // after the present round
  std::vector<State> state_;          // by index of AwakeObjects
  std::vector<Mover> movers_;
  std::vector<Pair> pairs_;
  std::vector<const btDbvtNode*> stack_;   // scratch
  std::vector<btCollisionObject*> found_;  // scratch
};

}  // namespace limber::sim::bullet

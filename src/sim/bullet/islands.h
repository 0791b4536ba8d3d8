// Islands: the islands of a substep (bodies that are joined, or whose bounding boxes overlap), with their
// bodies, joints and contacts sorted by island, and batches of islands to solve.
#pragma once

#include "sim/bullet/awake_objects.h"
#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

/// In each step: find(), find_contacts() once contacts are known, make_batches(). Islands are numbered in the order of
/// their first body; their joints are in the order of their creation, their contacts in that of the age of the parts.
/// So an island's order depends on that island alone. Memory is reused from step to step. [sim]
class Islands {
 public:
  /// Items of an array from `first` on.
  struct Range {
    int first;
    int count;
    int end() const { return first + count; }
  };
  /// Consecutive islands and their items in bodies(), joints() and contacts().
  struct Batch {
    Range bodies;
    Range joints;
    Range contacts;
    int islands;
    int constrained_islands;  ///< Number of islands that have joints or contacts.
  };

  void find(const AwakeObjects& awake, const btBroadphasePairArray& overlapping);
  void find_contacts(const AwakeObjects& awake, btDispatcher& dispatcher);
  /// Gathers islands until a batch has `min_constraints` joints and contact pairs, or enough bodies. `separate`:
  /// islands with joints or contacts are a batch each.
  void make_batches(int min_constraints, bool separate);

  int batch_count() const { return batches_.size() - 1; }
  Batch batch(int index) const;
  btAlignedObjectArray<btCollisionObject*>& bodies() { return bodies_; }
  btAlignedObjectArray<btTypedConstraint*>& joints() { return joints_; }
  btAlignedObjectArray<btPersistentManifold*>& contacts() { return contacts_; }
  /// Joints that connect no body that can move.
  const btAlignedObjectArray<btTypedConstraint*>& static_joints() const { return static_joints_; }

 private:
  struct OrderedManifold {  // a contact manifold and its position in the solving order
    int island;
    int first;
    int second;
    btPersistentManifold* manifold;
  };
  void sort_bodies(const AwakeObjects& awake);
  void sort_joints(const AwakeObjects& awake);
  bool is_constrained(int island) const {
    return joint_start_[island + 1] > joint_start_[island] || contact_start_[island + 1] > contact_start_[island];
  }

  int count_ = 0;
  UnionFind connected_;               // bodies that are joined or overlap
  btAlignedObjectArray<int> island_;  // by body
  // items of island i are bodies_[body_start_[i]] up to bodies_[body_start_[i + 1]], and so on
  btAlignedObjectArray<int> body_start_;
  btAlignedObjectArray<int> joint_start_;
  btAlignedObjectArray<int> contact_start_;
  btAlignedObjectArray<btCollisionObject*> bodies_;
  btAlignedObjectArray<btTypedConstraint*> joints_;
  btAlignedObjectArray<btTypedConstraint*> static_joints_;
  btAlignedObjectArray<btPersistentManifold*> contacts_;
  btAlignedObjectArray<int> batches_;  // islands of batch i: batches_[i] up to batches_[i + 1]
  // scratch
  btAlignedObjectArray<int> island_of_root_;
  btAlignedObjectArray<int> cursor_;
  btAlignedObjectArray<OrderedManifold> ordered_manifolds_;
};

}  // namespace limber::sim::bullet

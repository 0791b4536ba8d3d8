// AwakeObjects: the objects and joints of a world that are awake, in lists that steps iterate over instead of the
// world's.
#pragma once

#include "sim/bullet/bullet.h"
#include "sim/bullet/union_find.h"

namespace limber::sim::bullet {

/// The lists change only when objects and joints are added, removed, woken or put to sleep. Then call invalidate(), and
/// collect() before the next use. Their memory is that of the present BulletMemory::Scope. [sim]
class AwakeObjects {
 public:
  void invalidate() { valid_ = false; }
  /// False if the lists must be collected, also because the world has another number of objects.
  bool valid(int object_count) const { return valid_ && index_.size() == object_count; }
  /// Collects the lists from those of a world, in their order.
  void collect(const btAlignedObjectArray<btRigidBody*>& movable, const btCollisionObjectArray& objects,
               const btAlignedObjectArray<btTypedConstraint*>& joints);

  bool empty() const { return bodies_.size() == 0 && joints_.size() == 0; }
  /// Bodies that are not static.
  const btAlignedObjectArray<btRigidBody*>& bodies() const { return bodies_; }
  /// Objects whose bounding boxes are updated: awake and static ones.
  const btAlignedObjectArray<btCollisionObject*>& with_aabb() const { return with_aabb_; }
  /// Joints of awake bodies, or of none that can move.
  const btAlignedObjectArray<btTypedConstraint*>& joints() const { return joints_; }
  /// Index of an object in bodies(); -1: static or asleep.
  int index_of(const btCollisionObject& object) const { return index_[object.getWorldArrayIndex()]; }
  /// Index in bodies() of a body of a joint, by index in joints(); -1: none can move.
  int body_of_joint(int joint) const { return body_of_joint_[joint]; }
  /// Sets of the bodies that joints connect.
  const UnionFind& joined() const { return joined_; }

 private:
  bool valid_ = false;
  btAlignedObjectArray<btRigidBody*> bodies_;
  btAlignedObjectArray<btCollisionObject*> with_aabb_;
  btAlignedObjectArray<btTypedConstraint*> joints_;
  btAlignedObjectArray<int> index_;
  btAlignedObjectArray<int> body_of_joint_;
  UnionFind joined_;
};

}  // namespace limber::sim::bullet

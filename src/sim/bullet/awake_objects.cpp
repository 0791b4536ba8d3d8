// AwakeObjects: one pass over the objects and one over the joints.
#include "sim/bullet/awake_objects.h"

#include "sim/bullet/joints/tendon_constraint.h"

namespace limber::sim::bullet {

void AwakeObjects::collect(const btAlignedObjectArray<btRigidBody*>& movable, const btCollisionObjectArray& objects,
                           const btAlignedObjectArray<btTypedConstraint*>& joints) {
  index_.resizeNoInitialize(objects.size());
  for (int i = 0; i < index_.size(); ++i) index_[i] = -1;
  bodies_.resizeNoInitialize(0);
  for (int i = 0; i < movable.size(); ++i) {
    btRigidBody& body = *movable[i];
    if (!body.isActive()) continue;
    index_[body.getWorldArrayIndex()] = bodies_.size();
    bodies_.push_back(&body);
  }
  const auto is_asleep = [](const btCollisionObject& object) { return !object.isStaticObject() && !object.isActive(); };
  with_aabb_.resizeNoInitialize(0);
  for (int i = 0; i < objects.size(); ++i) {
    if (!is_asleep(*objects[i])) with_aabb_.push_back(objects[i]);
  }
  joined_.reset(bodies_.size());
  body_of_joint_.resizeNoInitialize(0);
  joints_.resizeNoInitialize(0);
  for (int i = 0; i < joints.size(); ++i) {
    bool asleep = false;
    int body = -1;
    for_each_link(*joints[i], [&](const btRigidBody& a, const btRigidBody& b) {
      asleep = asleep || is_asleep(a) || is_asleep(b);
      if (body < 0) body = index_of(a) >= 0 ? index_of(a) : index_of(b);
    });
    if (asleep) continue;
    joints_.push_back(joints[i]);
    body_of_joint_.push_back(body);
    for_each_link(*joints[i],
                  [&](const btRigidBody& a, const btRigidBody& b) { joined_.unite(index_of(a), index_of(b)); });
  }
  valid_ = true;
}

}  // namespace limber::sim::bullet

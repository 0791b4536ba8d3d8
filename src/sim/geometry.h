// Geometry: what a part collides with and how its mass is spread, built once and shared by all copies. [sim]
#pragma once

#include <memory>
#include <vector>

#include "model/body_model.h"
#include "sim/bullet.h"

namespace limber {

/// A collision shape in a part's centre-of-mass frame (principal axes), with what places that frame in the link's.
struct Geometry {
  std::shared_ptr<btCollisionShape> shape;
  std::vector<std::shared_ptr<btCollisionShape>> children;  ///< Kept alive for `shape`.
  std::vector<std::shared_ptr<const MeshModel>> meshes;
  Pose frame;            ///< The centre-of-mass frame in the link's frame.
  Vec3 unit_inertia{0};  ///< Principal moments for a mass of 1 kg, m².
  double volume = 0;     ///< m³; 0 for a plane.
};

/// Geometry of a link from its collision shapes and its inertial. An inertial without mass: centre and tensor come
/// from the shapes' volume.
std::shared_ptr<const Geometry> make_geometry(const std::vector<PlacedShape>& shapes, const Inertial& inertial);

/// Bullet's vectors are single precision, ours double.
inline btVector3 to_bt(const Vec3& v) {
  return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}
inline btQuaternion to_bt(const Quat& q) {
  return {static_cast<btScalar>(q.x), static_cast<btScalar>(q.y), static_cast<btScalar>(q.z),
          static_cast<btScalar>(q.w)};
}
inline btTransform to_bt(const Pose& p) { return {to_bt(p.rotation), to_bt(p.position)}; }
inline Vec3 from_bt(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat from_bt(const btQuaternion& q) { return quat_xyzw(q.x(), q.y(), q.z(), q.w()); }
inline Pose from_bt(const btTransform& t) { return {from_bt(t.getOrigin()), glm::normalize(from_bt(t.getRotation()))}; }

}  // namespace limber

// Includes Bullet's headers with their warnings disabled, and converts between Bullet's single-precision types and
// ours. No other file includes Bullet directly.
#pragma once

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Woverloaded-virtual"
#pragma GCC diagnostic ignored "-Wdeprecated-copy"
#endif
#include <btBulletDynamicsCommon.h>

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btShapeHull.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "base/vec.h"

namespace limber::sim::bullet {

inline btScalar to_scalar(double v) { return static_cast<btScalar>(v); }
inline btVector3 to_bt(const Vec3& v) { return {to_scalar(v.x), to_scalar(v.y), to_scalar(v.z)}; }
inline btQuaternion to_bt(const Quat& q) { return {to_scalar(q.x), to_scalar(q.y), to_scalar(q.z), to_scalar(q.w)}; }
inline btTransform to_bt(const Pose& p) { return btTransform(to_bt(p.rotation), to_bt(p.position)); }

inline Vec3 from_bt(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat from_bt(const btQuaternion& q) { return quat_xyzw(q.x(), q.y(), q.z(), q.w()); }
inline Pose from_bt(const btTransform& t) { return {from_bt(t.getOrigin()), from_bt(t.getRotation())}; }

}  // namespace limber::sim::bullet

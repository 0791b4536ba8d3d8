// Conservative advancement: the distance of two convex shapes, divided by a bound of their approach, is a time in which
// they can't meet.
#include "sim/collision/time_of_impact.h"

#include <algorithm>
#include <cmath>

#include "sim/collision/closest_points.h"

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

namespace limber::sim::collision {

using bullet::from_bt;
using bullet::to_bt;

namespace {

/// Steps of the advancement. A pair that needs more stops earlier than necessary.
constexpr int kMaxAdvances = 48;
/// Approach per step, m, below which surfaces slide along each other.
constexpr btScalar kMinApproach = 1e-6F;
/// Overlap at the time of impact, m.
constexpr btScalar kImpactDepth = 1e-4F;
/// Surfaces nearer than this at the start of the step touch, m, or this share of the inner radius, if that is less.
constexpr btScalar kTouchDistance = 1e-3F;
constexpr btScalar kTouchShare = 0.1F;
/// Additional overlap of surfaces that touch at the start, as a share of the inner radius.
constexpr btScalar kOverlapShare = 0.25F;
/// A pair that overlaps by more than this share of the inner radius at the start may do so.
constexpr btScalar kDeepShare = 0.5F;
/// The overlap is exact to this share of it.
constexpr btScalar kDepthShare = 0.1F;

/// A convex part of a shape, as placed in it.
struct ConvexPart {
  const btConvexShape* shape;
  btTransform local;

  // Upper bound of the distance of its points from the origin of the whole shape.
  btScalar reach() const {
    btVector3 center;
    btScalar radius = 0;
    shape->getBoundingSphere(center, radius);
    return (local * center).length() + radius;
  }
};

ClosestPoints closest_points(const btConvexShape& a, const btTransform& pose_a, const btStaticPlaneShape& plane,
                             const btTransform& pose_b) {
  const btVector3 normal = pose_b.getBasis() * plane.getPlaneNormal();
  const btVector3 lowest = pose_a(a.localGetSupportingVertex(-(normal * pose_a.getBasis())));
  const btScalar distance = normal.dot(lowest - pose_b.getOrigin()) - plane.getPlaneConstant();
  return {true, distance, normal, lowest - normal * distance};
}

/// Motion of two shapes relative to each other, of which one may stop earlier.
struct Approach {
  const Sweep& a;
  const Sweep& b;
  btScalar reach_a;
  btScalar reach_b;

  static btVector3 velocity(const Sweep& sweep, btScalar time, const btVector3& point) {
    if (time >= sweep.stop) return {0, 0, 0};
    return sweep.linear + sweep.angular.cross(point - sweep.at(time).getOrigin());
  }
  // Decrease of the distance at a point, m per step.
  btScalar speed(btScalar time, const ClosestPoints& at) const {
    return at.normal.dot(velocity(b, time, at.point) - velocity(a, time, at.point));
  }
  // Upper bound of the decrease of the distance along a normal.
  btScalar bound(btScalar time, const btVector3& normal) const {
    btScalar sum = 0;
    if (time < a.stop) sum += a.angular.length() * reach_a - normal.dot(a.linear);
    if (time < b.stop) sum += b.angular.length() * reach_b + normal.dot(b.linear);
    return sum;
  }
  // Time at which one of them stops next.
  btScalar next_stop(btScalar time) const {
    const btScalar first = std::min(a.stop, b.stop);
    return time < first ? first : std::max(a.stop, b.stop);
  }
};

// Overlap at which two shapes stop, given their distance at the start; 0: they don't.
btScalar stopping_depth(const Sweep& a, const Sweep& b, btScalar distance) {
  const btScalar radius = a.radius > 0 && b.radius > 0 ? std::min(a.radius, b.radius) : std::max(a.radius, b.radius);
  if (distance > std::min(kTouchDistance, kTouchShare * radius)) return std::min(kImpactDepth, kTouchShare * radius);
  const btScalar overlap = std::max(-distance, btScalar(0));
  return overlap > kDeepShare * radius ? 0 : overlap + kOverlapShare * radius;
}

template <class PointsAt>
btScalar advance(const Approach& approach, PointsAt&& points_at) {
  const btScalar end = std::max(approach.a.stop, approach.b.stop);
  btScalar depth = 0;
  btScalar time = 0;
  for (int i = 0; i < kMaxAdvances && time < end; ++i) {
    const ClosestPoints at = points_at(time);
    if (!at.found) return 1;
    if (i == 0) depth = stopping_depth(approach.a, approach.b, at.distance);
    if (!(depth > 0)) return 1;
    const btScalar left = at.distance + depth;
    if (left <= kDepthShare * depth) return time;
    const btScalar next = approach.next_stop(time);
    const btScalar speed = approach.speed(time, at);
    // near the impact, it is found by a secant step
    if (at.distance <= depth && speed > kMinApproach && time + left / speed < next) return time + left / speed;
    time = std::min(time + left / std::max(approach.bound(time, at.normal), kMinApproach), next);
  }
  return std::min(time, btScalar(1));
}

// Calls visit(part) for each convex part of a shape that may overlap a box in the shape's frame.
template <class Visit>
void for_each_part(const btCollisionShape& shape, const btTransform& local, const btVector3& low, const btVector3& high,
                   Visit&& visit) {
  if (shape.isConvex()) {
    visit(ConvexPart{static_cast<const btConvexShape*>(&shape), local});
  } else if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i) {
      const btTransform child = local * compound.getChildTransform(i);
      btVector3 child_low;
      btVector3 child_high;
      compound.getChildShape(i)->getAabb(child, child_low, child_high);
      if (TestAabbAgainstAabb2(low, high, child_low, child_high))
        for_each_part(*compound.getChildShape(i), child, low, high, visit);
    }
  } else if (shape.isConcave() && shape.getShapeType() != STATIC_PLANE_PROXYTYPE) {
    struct Triangles : btTriangleCallback {
      explicit Triangles(Visit& v, const btTransform& t) : visit(v), local(t) {}
      void processTriangle(btVector3* corners, int, int) override {
        btTriangleShape triangle(corners[0], corners[1], corners[2]);
        triangle.setMargin(0);
        visit(ConvexPart{&triangle, local});
      }
      Visit& visit;
      const btTransform& local;
    } triangles(visit, local);
    static_cast<const btConcaveShape&>(shape).processAllTriangles(&triangles, low, high);
  }
}

// Boundaries of a sweep in the frame of another one at the start of its motion, enlarged by that motion.
void bounds_in_frame(const Sweep& sweep, const Sweep& frame, btVector3& low, btVector3& high) {
  btVector3 world_low;
  btVector3 world_high;
  sweep.bounds(world_low, world_high);
  btVector3 center;
  btScalar radius = 0;
  frame.shape->getBoundingSphere(center, radius);
  const btScalar motion = frame.linear.length() + frame.angular.length() * (center.length() + radius) + kImpactDepth;
  const btVector3 middle = frame.start.invXform((world_low + world_high) / 2);
  const btVector3 half = (world_high - world_low) / 2;
  const btVector3 extent = frame.start.getBasis().transpose().absolute() * half + btVector3(motion, motion, motion);
  low = middle - extent;
  high = middle + extent;
}

btScalar impact_with_plane(const Sweep& a, const Sweep& plane) {
  btScalar first = 1;
  const auto visit = [&](const ConvexPart& part) {
    const Approach approach{a, plane, part.reach(), 0};
    first = std::min(first, advance(approach, [&](btScalar time) {
                       return closest_points(*part.shape, a.at(time) * part.local,
                                             static_cast<const btStaticPlaneShape&>(*plane.shape), plane.at(time));
                     }));
  };
  const btVector3 everywhere(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  for_each_part(*a.shape, btTransform::getIdentity(), -everywhere, everywhere, visit);
  return first;
}

btScalar inner_radius_of_hull(const btPolyhedralConvexShape& hull) {
  const btConvexPolyhedron* const polyhedron = hull.getConvexPolyhedron();
  if (polyhedron == nullptr || polyhedron->m_vertices.size() == 0) return 0;
  btVector3 center(0, 0, 0);
  for (int i = 0; i < polyhedron->m_vertices.size(); ++i) center += polyhedron->m_vertices[i];
  center /= static_cast<btScalar>(polyhedron->m_vertices.size());
  btScalar radius = BT_LARGE_FLOAT;
  for (int i = 0; i < polyhedron->m_faces.size(); ++i) {
    const btScalar* const plane = polyhedron->m_faces[i].m_plane;
    radius = std::min(radius, -(btVector3(plane[0], plane[1], plane[2]).dot(center) + plane[3]));
  }
  return std::max(radius, btScalar(0)) + hull.getMargin();
}

// True if the bounding spheres of two shapes don't meet during their motion.
bool stay_apart(const Sweep& a, const Sweep& b) {
  btVector3 center_a;
  btVector3 center_b;
  btScalar radius_a = 0;
  btScalar radius_b = 0;
  a.shape->getBoundingSphere(center_a, radius_a);
  b.shape->getBoundingSphere(center_b, radius_b);
  const btScalar reach = radius_a + center_a.length() + radius_b + center_b.length() + kImpactDepth;
  const btScalar first = std::min(a.stop, b.stop);
  const auto relative = [&](btScalar time) { return a.at(time).getOrigin() - b.at(time).getOrigin(); };
  const auto is_near = [&](const btVector3& from, const btVector3& to) {
    const btVector3 motion = to - from;
    const btScalar length2 = motion.length2();
    const btScalar t = length2 > 0 ? std::clamp(-from.dot(motion) / length2, btScalar(0), btScalar(1)) : btScalar(0);
    return (from + motion * t).length2() <= reach * reach;
  };
  const btVector3 at_first = relative(first);
  return !is_near(relative(0), at_first) && !is_near(at_first, relative(std::max(a.stop, b.stop)));
}

}  // namespace

btTransform Sweep::at(btScalar fraction) const {
  const btScalar moved = std::min(fraction, stop);
  const btVector3 position = start.getOrigin() + linear * moved;
  const btScalar angle = angular.length() * moved;
  if (!(angle > SIMD_EPSILON)) return btTransform(start.getBasis(), position);
  return btTransform(
      btMatrix3x3(to_bt(quat_axis(from_bt(angular.normalized()), static_cast<double>(angle)))) * start.getBasis(),
      position);
}

void Sweep::bounds(btVector3& low, btVector3& high) const {
  shape->getAabb(start, low, high);
  btVector3 center;
  btScalar radius = 0;
  shape->getBoundingSphere(center, radius);
  const btScalar turn = std::min(angular.length(), btScalar(2)) * (center.length() + radius);
  btVector3 end_low = low + linear;
  btVector3 end_high = high + linear;
  low.setMin(end_low);
  high.setMax(end_high);
  low -= btVector3(turn, turn, turn);
  high += btVector3(turn, turn, turn);
}

void remove_symmetric_spin(Sweep& sweep) {
  switch (sweep.shape->getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      sweep.angular.setZero();
      break;
    case CYLINDER_SHAPE_PROXYTYPE:
    case CAPSULE_SHAPE_PROXYTYPE:
    case CONE_SHAPE_PROXYTYPE: {
      const btVector3 axis = sweep.start.getBasis().getColumn(2);
      sweep.angular -= axis * axis.dot(sweep.angular);
      break;
    }
    default:
      break;
  }
}

btScalar inner_radius(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return static_cast<const btSphereShape&>(shape).getRadius();
    case BOX_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
      return half[half.minAxis()];
    }
    case CAPSULE_SHAPE_PROXYTYPE:
      return static_cast<const btCapsuleShape&>(shape).getRadius();
    case CYLINDER_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
      return std::min(half.x(), half.z());
    }
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      const btScalar slant = std::sqrt(cone.getRadius() * cone.getRadius() + cone.getHeight() * cone.getHeight());
      return cone.getRadius() * cone.getHeight() / (cone.getRadius() + slant);
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return inner_radius_of_hull(static_cast<const btPolyhedralConvexShape&>(shape));
    case COMPOUND_SHAPE_PROXYTYPE: {
      const auto& compound = static_cast<const btCompoundShape&>(shape);
      btScalar smallest = BT_LARGE_FLOAT;
      for (int i = 0; i < compound.getNumChildShapes(); ++i)
        smallest = std::min(smallest, inner_radius(*compound.getChildShape(i)));
      return smallest;
    }
    default: {
      if (!shape.isConvex()) return 0;
      btVector3 low;
      btVector3 high;
      shape.getAabb(btTransform::getIdentity(), low, high);
      const btVector3 half = (high - low) / 2;
      return half[half.minAxis()];
    }
  }
}

btScalar time_of_impact(const Sweep& a, const Sweep& b) {
  if (a.shape->getShapeType() == STATIC_PLANE_PROXYTYPE) return time_of_impact(b, a);
  if (b.shape->getShapeType() == STATIC_PLANE_PROXYTYPE) return impact_with_plane(a, b);
  if (stay_apart(a, b)) return 1;
  btVector3 low_a(0, 0, 0);
  btVector3 high_a(0, 0, 0);
  btVector3 low_b(0, 0, 0);
  btVector3 high_b(0, 0, 0);
  if (!a.shape->isConvex()) bounds_in_frame(b, a, low_a, high_a);
  if (!b.shape->isConvex()) bounds_in_frame(a, b, low_b, high_b);
  const btTransform identity = btTransform::getIdentity();
  btScalar first = 1;
  for_each_part(*a.shape, identity, low_a, high_a, [&](const ConvexPart& part_a) {
    const auto visit = [&](const ConvexPart& part_b) {
      const Approach approach{a, b, part_a.reach(), part_b.reach()};
      first = std::min(first, advance(approach, [&](btScalar time) {
                         return closest_points(*part_a.shape, a.at(time) * part_a.local, *part_b.shape,
                                               b.at(time) * part_b.local);
                       }));
    };
    for_each_part(*b.shape, identity, low_b, high_b, visit);
  });
  return first;
}

}  // namespace limber::sim::collision

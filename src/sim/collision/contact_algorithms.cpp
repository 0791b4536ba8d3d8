// Planes touch the lowest points of a shape. For two boxes the contact normal is the axis of least overlap (separating
// axis test); for other convex shapes it is the direction of their distance (GJK). If a face of one of them has that
// normal, it is the reference face, and the other's feature is clipped against its sides.
#include "sim/collision/contact_algorithms.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "sim/collision/box_axes.h"
#include "sim/collision/closest_points.h"
#include "sim/collision/contact_clipping.h"
#include "sim/collision/contact_features.h"
#include "sim/collision/manifold_builder.h"
#include "sim/collision/pair_algorithm.h"
#include "sim/collision/surface_algorithm.h"

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>

namespace limber::sim::collision {
namespace {

class PlaneAlgorithm : public PairAlgorithm {
 public:
  PlaneAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                 const btCollisionObjectWrapper* b, bool plane_first)
      : PairAlgorithm(info, plane_first ? b : a, plane_first ? a : b), plane_first_(plane_first) {}

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* out) override {
    const btCollisionObjectWrapper& convex = plane_first_ ? *b : *a;
    const btCollisionObjectWrapper& plane = plane_first_ ? *a : *b;
    out->setPersistentManifold(&manifold());
    const auto& shape = static_cast<const btConvexShape&>(*convex.getCollisionShape());
    const auto& plane_shape = static_cast<const btStaticPlaneShape&>(*plane.getCollisionShape());
    const btTransform& pose = convex.getWorldTransform();
    const btVector3 normal = plane.getWorldTransform().getBasis() * plane_shape.getPlaneNormal();
    const btScalar constant = plane_shape.getPlaneConstant() + normal.dot(plane.getWorldTransform().getOrigin());
    ManifoldBuilder points(manifold(), info.m_timeStep);
    ContactFeature feature;
    const btScalar height = normal.dot(pose.getOrigin()) - constant;
    find_points_on_plane(shape, -(normal * pose.getBasis()), height, points.max_distance(), feature);
    for (int i = 0; i < feature.count; ++i) {
      const btVector3 point = pose(feature[i]) - normal * feature.margin;
      const btScalar distance = normal.dot(point) - constant;
      points.add(point - normal * distance, normal, distance);
    }
    points.write();
  }

 private:
  bool plane_first_;
};

class BoxAlgorithm : public PairAlgorithm {
 public:
  using PairAlgorithm::PairAlgorithm;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* out) override {
    out->setPersistentManifold(&manifold());
    ManifoldBuilder points(manifold(), info.m_timeStep);
    const auto& shape_a = static_cast<const btBoxShape&>(*a->getCollisionShape());
    const auto& shape_b = static_cast<const btBoxShape&>(*b->getCollisionShape());
    const Box box_a(shape_a, a->getWorldTransform());
    const Box box_b(shape_b, b->getWorldTransform());
    if (separating_axis_.separates(box_a, box_b, points)) {
      points.write();
      return;
    }
    const BoxAxis axis = separating_axis_.find(box_a, box_b, points);
    if (axis.kind == BoxAxis::edges) {
      add_edges(box_a, box_b, axis, points);
    } else if (axis.kind != BoxAxis::none) {
      const bool first = axis.kind == BoxAxis::face_a;
      ContactFeature reference;
      ContactFeature incident;
      const btTransform& reference_pose = (first ? a : b)->getWorldTransform();
      const btTransform& incident_pose = (first ? b : a)->getWorldTransform();
      const btVector3 outward = first ? -axis.normal : axis.normal;
      find_feature(first ? shape_a : shape_b, outward * reference_pose.getBasis(), reference);
      find_feature(first ? shape_b : shape_a, -outward * incident_pose.getBasis(), incident);
      reference.transform(reference_pose);
      incident.transform(incident_pose);
      add_face_points(reference, incident, first, points);
    }
    points.write();
  }

 private:
  static void add_edges(const Box& a, const Box& b, const BoxAxis& axis, ManifoldBuilder& points) {
    btVector3 on_a = a.center;
    btVector3 on_b = b.center;
    for (int i = 0; i < 3; ++i) {
      if (i != axis.edge_a) on_a += a.axis(i) * (a.axis(i).dot(axis.normal) > 0 ? -a.half[i] : a.half[i]);
      if (i != axis.edge_b) on_b += b.axis(i) * (b.axis(i).dot(axis.normal) > 0 ? b.half[i] : -b.half[i]);
    }
    const btVector3 u = a.axis(axis.edge_a);
    const btVector3 v = b.axis(axis.edge_b);
    const btVector3 offset = on_b - on_a;
    const btScalar uv = u.dot(v);
    const btScalar scale = 1 / (1 - uv * uv);
    const btScalar along_a = (offset.dot(u) - uv * offset.dot(v)) * scale;
    const btScalar along_b = (uv * offset.dot(u) - offset.dot(v)) * scale;
    // edges that pass each other don't touch
    const btScalar overshoot =
        std::max(std::fabs(along_a) - a.half[axis.edge_a], std::fabs(along_b) - b.half[axis.edge_b]);
    if (axis.separation > 0 && overshoot > kClipSlack) return;
    points.add(on_b + v * along_b, axis.normal, axis.separation);
  }

  SeparatingAxis separating_axis_;  // of the last step
};

class ConvexAlgorithm : public PairAlgorithm {
 public:
  using PairAlgorithm::PairAlgorithm;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* out) override {
    out->setPersistentManifold(&manifold());
    const auto& shape_a = static_cast<const btConvexShape&>(*a->getCollisionShape());
    const auto& shape_b = static_cast<const btConvexShape&>(*b->getCollisionShape());
    ManifoldBuilder points(manifold(), info.m_timeStep);
    const btScalar breaking = manifold().getContactBreakingThreshold();
    const ClosestPoints nearest = closest_points(shape_a, a->getWorldTransform(), shape_b, b->getWorldTransform());
    const bool has_sphere =
        shape_a.getShapeType() == SPHERE_SHAPE_PROXYTYPE || shape_b.getShapeType() == SPHERE_SHAPE_PROXYTYPE;
    if (!nearest.found || nearest.distance > std::max(points.max_distance(), breaking)) {
      points.write();
    } else if (has_sphere) {
      // exactly one point, on the line from the center; more accurate than GJK's
      const bool first = shape_a.getShapeType() == SPHERE_SHAPE_PROXYTYPE;
      const btVector3& center = (first ? a : b)->getWorldTransform().getOrigin();
      const btScalar radius = static_cast<const btSphereShape&>(first ? shape_a : shape_b).getRadius();
      const btVector3 point =
          first ? center - nearest.normal * (radius + nearest.distance) : center + nearest.normal * radius;
      points.add(point, nearest.normal, nearest.distance);
      points.write();
    } else if (add_faces(*a, *b, nearest.normal, points)) {
      points.write();
    } else {
      // edges and round sides: one point per step, as in Bullet
      if (nearest.distance <= breaking) out->addContactPoint(nearest.normal, nearest.point, nearest.distance);
      out->refreshContactPoints();
    }
  }

 private:
  // Returns false if neither a face of one of the shapes nor two parallel edges touch.
  static bool add_faces(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, const btVector3& normal,
                        ManifoldBuilder& points) {
    ContactFeature feature_a;
    ContactFeature feature_b;
    for (const bool first : {true, false}) {
      const btCollisionObjectWrapper& object = first ? a : b;
      find_world_feature(static_cast<const btConvexShape&>(*object.getCollisionShape()), object.getWorldTransform(),
                         first ? -normal : normal, first ? feature_a : feature_b);
    }
    if (feature_a.count == 2 && feature_b.count == 2) return add_parallel_edges(feature_a, feature_b, normal, points);
    const btScalar alignment_a = feature_a.count > 2 ? -normal.dot(feature_a.normal) : btScalar(0);
    const btScalar alignment_b = feature_b.count > 2 ? normal.dot(feature_b.normal) : btScalar(0);
    if (std::max(alignment_a, alignment_b) < kMinAlignment) return false;
    const bool first = alignment_a > alignment_b + (1 - kMinAlignment);
    if (first || alignment_b < kMinAlignment) {
      add_face_points(feature_a, feature_b, true, points);
    } else {
      add_face_points(feature_b, feature_a, false, points);
    }
    return !points.empty();
  }
};

// ellipsoids are custom shapes
constexpr int kConvexShapes[] = {BOX_SHAPE_PROXYTYPE,     CONVEX_HULL_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE,
                                 CAPSULE_SHAPE_PROXYTYPE, CONE_SHAPE_PROXYTYPE,        CYLINDER_SHAPE_PROXYTYPE,
                                 CUSTOM_CONVEX_SHAPE_TYPE};

template <class Algorithm, class... Args>
btCollisionAlgorithm* create(btCollisionAlgorithmConstructionInfo& info, Args&&... args) {
  // the largest algorithm of Bullet determines the size of the blocks
  static_assert(sizeof(Algorithm) <= sizeof(btConvexConcaveCollisionAlgorithm));
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(static_cast<int>(sizeof(Algorithm)));
  return new (memory) Algorithm(info, std::forward<Args>(args)...);
}

}  // namespace

btCollisionAlgorithm* ContactAlgorithms::CreatePlane::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) {
  return create<PlaneAlgorithm>(info, a, b, m_swapped);
}

btCollisionAlgorithm* ContactAlgorithms::CreateSurface::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) {
  return create<SurfaceAlgorithm>(info, a, b, m_swapped);
}

btCollisionAlgorithm* ContactAlgorithms::CreateBox::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                             const btCollisionObjectWrapper* a,
                                                                             const btCollisionObjectWrapper* b) {
  return create<BoxAlgorithm>(info, a, b);
}

btCollisionAlgorithm* ContactAlgorithms::CreateConvex::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) {
  return create<ConvexAlgorithm>(info, a, b);
}

void ContactAlgorithms::install(btCollisionDispatcher& dispatcher) {
  plane_convex_.m_swapped = true;
  surface_convex_.m_swapped = true;
  for (const int convex : kConvexShapes) {
    dispatcher.registerCollisionCreateFunc(convex, STATIC_PLANE_PROXYTYPE, &convex_plane_);
    dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, convex, &plane_convex_);
    dispatcher.registerCollisionCreateFunc(convex, CUSTOM_CONCAVE_SHAPE_TYPE, &convex_surface_);
    dispatcher.registerCollisionCreateFunc(CUSTOM_CONCAVE_SHAPE_TYPE, convex, &surface_convex_);
    for (const int other : kConvexShapes) dispatcher.registerCollisionCreateFunc(convex, other, &convex_convex_);
  }
  dispatcher.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &box_box_);
}

}  // namespace limber::sim::collision

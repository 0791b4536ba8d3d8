// A plane meets the lowest points of a shape. Two boxes meet along the axis of least overlap (separating axis test);
// other convex shapes along the direction of their distance (GJK). Where a face of one of them has that direction, it
// is the reference, and the other's feature is clipped against its sides.
#include "sim/contact_algorithms.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include "sim/contact_features.h"
#include "sim/contact_manifold.h"

namespace limber {
namespace {

/// A face is the reference if its normal is within 1.1 degrees of the direction of contact.
constexpr btScalar kAligned = 0.9998F;
/// Points this far outside of the reference face's sides still count, m.
constexpr btScalar kClipSlack = 1e-5F;
/// Of two axes, one of an edge, or of the second box, is chosen only if it separates by this much more: as part of the
/// separation, and m.
constexpr btScalar kBetterPart = 0.02F;
constexpr btScalar kBetter = 1e-4F;

/// Owns the manifold of a pair.
class PairAlgorithm : public btCollisionAlgorithm {
 public:
  PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                const btCollisionObjectWrapper* b)
      : btCollisionAlgorithm(info),
        manifold_(info.m_dispatcher1->getNewManifold(a->getCollisionObject(), b->getCollisionObject())) {}
  ~PairAlgorithm() override { m_dispatcher->releaseManifold(manifold_); }
  PairAlgorithm(const PairAlgorithm&) = delete;
  PairAlgorithm& operator=(const PairAlgorithm&) = delete;

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override { manifolds.push_back(manifold_); }

 protected:
  btPersistentManifold& manifold() { return *manifold_; }

 private:
  btPersistentManifold* manifold_;
};

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
    ContactManifold points(manifold(), info.m_timeStep);
    ContactFeature feature;
    const btScalar height = normal.dot(pose.getOrigin()) - constant;
    find_points_on_plane(shape, -(normal * pose.getBasis()), height, points.reach(), feature);
    for (int i = 0; i < feature.count; ++i) {
      const btVector3 point = pose(feature[i]) - normal * feature.margin;
      const btScalar distance = normal.dot(point) - constant;
      points.add(point - normal * distance, normal, distance);
    }
    points.finish();
  }

 private:
  bool plane_first_;
};

// The part of a polygon, segment or point that is inside of the plane through `from` with this outward normal.
void cut(const ContactFeature& whole, const btVector3& from, const btVector3& outward, ContactFeature& part) {
  part.count = 0;
  const int sides = whole.count > 2 ? whole.count : whole.count - 1;
  btScalar p_out = outward.dot(whole[0] - from) - kClipSlack;
  if (sides == 0 && p_out <= 0) part.add(whole[0]);
  for (int i = 0; i < sides; ++i) {
    const btVector3& p = whole[i];
    const btVector3& q = whole[i + 1 < whole.count ? i + 1 : 0];
    const btScalar q_out = outward.dot(q - from) - kClipSlack;
    if (p_out <= 0) part.add(p);
    if ((p_out <= 0) != (q_out <= 0)) part.add(p + (q - p) * (p_out / (p_out - q_out)));
    if (whole.count == 2 && q_out <= 0) part.add(q);
    p_out = q_out;
  }
}

// Clips a polygon, segment or point against the sides of the reference face. `incident` is overwritten; the result is
// `incident` or `spare`.
const ContactFeature& clip(const ContactFeature& reference, ContactFeature& incident, ContactFeature& spare) {
  spare.normal = incident.normal;
  spare.margin = incident.margin;
  ContactFeature* whole = &incident;
  ContactFeature* part = &spare;
  for (int side = 0; side < reference.count && whole->count > 0; ++side) {
    const btVector3& from = reference[side];
    const btVector3 edge = reference[side + 1 < reference.count ? side + 1 : 0] - from;
    const btScalar length = edge.length();
    if (!(length > SIMD_EPSILON)) continue;
    cut(*whole, from, edge.cross(reference.normal) / length, *part);
    std::swap(whole, part);
  }
  return *whole;
}

// Points of the incident feature below, or close above, the reference face. `flipped`: the reference is body A's.
void add_points(const ContactFeature& reference, ContactFeature& incident, bool flipped, ContactManifold& points) {
  ContactFeature spare;
  const ContactFeature& clipped = clip(reference, incident, spare);
  const btVector3& normal = reference.normal;
  for (int i = 0; i < clipped.count; ++i) {
    const btVector3 point = clipped[i] - normal * clipped.margin;
    const btScalar distance = normal.dot(point - reference[0]) - reference.margin;
    if (flipped) {
      points.add(point, -normal, distance);
    } else {
      points.add(point - normal * distance, normal, distance);
    }
  }
}

struct Box {
  const btVector3& center;
  const btMatrix3x3& axes;  // columns
  btVector3 half;

  Box(const btBoxShape& shape, const btTransform& pose)
      : center(pose.getOrigin()), axes(pose.getBasis()), half(shape.getHalfExtentsWithoutMargin()) {
    const btScalar margin = shape.getMarginNV();
    half += btVector3(margin, margin, margin);
  }
  btVector3 axis(int i) const { return axes.getColumn(i); }
};

class BoxAlgorithm : public PairAlgorithm {
 public:
  using PairAlgorithm::PairAlgorithm;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* out) override {
    out->setPersistentManifold(&manifold());
    ContactManifold points(manifold(), info.m_timeStep);
    const auto& shape_a = static_cast<const btBoxShape&>(*a->getCollisionShape());
    const auto& shape_b = static_cast<const btBoxShape&>(*b->getCollisionShape());
    const Box box_a(shape_a, a->getWorldTransform());
    const Box box_b(shape_b, b->getWorldTransform());
    if (apart_.separates(box_a, box_b, points)) {
      points.finish();
      return;
    }
    const Axis axis = find_axis(box_a, box_b, points, apart_);
    if (axis.kind == Axis::edges) {
      add_edges(box_a, box_b, axis, points);
    } else if (axis.kind != Axis::none) {
      const bool first = axis.kind == Axis::face_a;
      ContactFeature reference;
      ContactFeature incident;
      const btTransform& of_reference = (first ? a : b)->getWorldTransform();
      const btTransform& of_incident = (first ? b : a)->getWorldTransform();
      const btVector3 outward = first ? -axis.normal : axis.normal;
      find_feature(first ? shape_a : shape_b, outward * of_reference.getBasis(), reference);
      find_feature(first ? shape_b : shape_a, -outward * of_incident.getBasis(), incident);
      reference.transform(of_reference);
      incident.transform(of_incident);
      add_points(reference, incident, first, points);
    }
    points.finish();
  }

 private:
  struct Axis {
    enum Kind : unsigned char { none, face_a, face_b, edges } kind = none;
    btVector3 normal{0, 0, 0};  // from b to a
    btScalar separation = -BT_LARGE_FLOAT;
    int edge_a = 0;
    int edge_b = 0;
  };

  // The axis that separated the boxes in the last step: it most likely does so in the next one, too.
  struct Apart {
    int a = kNone;  // axis of the first box
    int b = kNone;  // of the second; the cross product if both

    // Whether it separates them until the end of the step, by more than rounding errors: find_axis() would find none.
    bool separates(const Box& first, const Box& second, const ContactManifold& points) const {
      if (a == kNone && b == kNone) return false;
      const btVector3 along = b == kNone   ? first.axis(a)
                              : a == kNone ? second.axis(b)
                                           : first.axis(a).cross(second.axis(b));
      const btScalar radius =
          (along * first.axes).absolute().dot(first.half) + (along * second.axes).absolute().dot(second.half);
      const btScalar way = along.dot(second.center - first.center);
      const btScalar length = a == kNone || b == kNone ? btScalar(1) : along.length();
      return std::fabs(way) - radius - closing(way, along.dot(points.way())) > (points.turn_reach() + kBetter) * length;
    }
    static constexpr int kNone = -1;
  };

  // By how much a distance `between` along an axis shrinks when the second box moves by `way` along it.
  static btScalar closing(btScalar between, btScalar way) { return std::max(between > 0 ? -way : way, btScalar(0)); }

  // None, if an axis keeps the boxes apart until the end of the step: then `apart_along` is that axis.
  static Axis find_axis(const Box& a, const Box& b, const ContactManifold& points, Apart& apart_along) {
    const btScalar reach = points.turn_reach();
    const btVector3 way_a = points.way() * a.axes;
    const btVector3 way_b = points.way() * b.axes;
    const btMatrix3x3 turn = a.axes.transposeTimes(b.axes);  // axes of b, seen from a
    const btVector3 from_a = (b.center - a.center) * a.axes;
    const btVector3 from_b = (b.center - a.center) * b.axes;
    btMatrix3x3 size;
    for (int i = 0; i < 3; ++i) size[i] = turn[i].absolute();
    Axis best;
    for (int i = 0; i < 3; ++i) {
      const btScalar apart = std::fabs(from_a[i]) - a.half[i] - size[i].dot(b.half);
      if (apart - closing(from_a[i], way_a[i]) > reach) return none_along(i, Apart::kNone, apart_along);
      if (apart > best.separation + (best.kind == Axis::none ? 0 : kBetter)) {
        best = {Axis::face_a, a.axis(i) * (from_a[i] > 0 ? btScalar(-1) : btScalar(1)), apart, 0, 0};
      }
    }
    for (int i = 0; i < 3; ++i) {
      const btScalar apart = std::fabs(from_b[i]) - b.half[i] - size.getColumn(i).dot(a.half);
      if (apart - closing(from_b[i], way_b[i]) > reach) return none_along(Apart::kNone, i, apart_along);
      if (apart > best.separation + kBetter + kBetterPart * std::fabs(best.separation)) {
        best = {Axis::face_b, b.axis(i) * (from_b[i] > 0 ? btScalar(-1) : btScalar(1)), apart, 0, 0};
      }
    }
    const btScalar least = best.separation + kBetter + kBetterPart * std::fabs(best.separation);
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3;
        const int k2 = (k + 2) % 3;
        // cross product of a's axis i and b's axis k, seen from a: its length is their sine
        const btScalar sine2 = 1 - turn[i][k] * turn[i][k];
        if (sine2 < 1e-4F) continue;
        const btScalar along = from_a[i2] * turn[i1][k] - from_a[i1] * turn[i2][k];
        const btScalar radius_a = a.half[i1] * size[i2][k] + a.half[i2] * size[i1][k];
        const btScalar radius_b = b.half[k1] * size[i][k2] + b.half[k2] * size[i][k1];
        const btScalar scaled = std::fabs(along) - radius_a - radius_b;  // times the sine
        const btScalar least_now = best.kind == Axis::edges ? std::max(least, best.separation + kBetter) : least;
        if (scaled <= std::min(least_now, btScalar(0))) continue;
        const btScalar inverse = 1 / std::sqrt(sine2);
        const btScalar apart = scaled * inverse;
        const btScalar way = (way_a[i2] * turn[i1][k] - way_a[i1] * turn[i2][k]) * inverse;
        if (apart - closing(along, way) > reach) return none_along(i, k, apart_along);
        if (apart > least_now) {
          btVector3 normal = a.axis(i).cross(b.axis(k)) * inverse;
          if (normal.dot(b.center - a.center) > 0) normal = -normal;
          best = {Axis::edges, normal, apart, i, k};
        }
      }
    }
    return best;
  }

  static Axis none_along(int a, int b, Apart& apart) {
    apart = {a, b};
    return {};
  }

  static void add_edges(const Box& a, const Box& b, const Axis& axis, ContactManifold& points) {
    btVector3 on_a = a.center;
    btVector3 on_b = b.center;
    for (int i = 0; i < 3; ++i) {
      if (i != axis.edge_a) on_a += a.axis(i) * (a.axis(i).dot(axis.normal) > 0 ? -a.half[i] : a.half[i]);
      if (i != axis.edge_b) on_b += b.axis(i) * (b.axis(i).dot(axis.normal) > 0 ? b.half[i] : -b.half[i]);
    }
    const btVector3 u = a.axis(axis.edge_a);
    const btVector3 v = b.axis(axis.edge_b);
    const btVector3 between = on_b - on_a;
    const btScalar uv = u.dot(v);
    const btScalar scale = 1 / (1 - uv * uv);
    const btScalar along_a = (between.dot(u) - uv * between.dot(v)) * scale;
    const btScalar along_b = (uv * between.dot(u) - between.dot(v)) * scale;
    // edges that pass beside each other don't touch
    const btScalar beyond =
        std::max(std::fabs(along_a) - a.half[axis.edge_a], std::fabs(along_b) - b.half[axis.edge_b]);
    if (axis.separation > 0 && beyond > kClipSlack) return;
    points.add(on_b + v * along_b, axis.normal, axis.separation);
  }

  Apart apart_;
};

// The nearest points of two convex shapes.
struct Nearest : btDiscreteCollisionDetectorInterface::Result {
  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b, btScalar apart) override {
    found = true;
    normal = normal_on_b;
    point = point_on_b;
    distance = apart;
  }

  bool found = false;
  btVector3 normal{0, 0, 0};
  btVector3 point{0, 0, 0};
  btScalar distance = 0;
};

class ConvexAlgorithm : public PairAlgorithm {
 public:
  ConvexAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                  const btCollisionObjectWrapper* b, btConvexPenetrationDepthSolver& depth_solver)
      : PairAlgorithm(info, a, b), depth_solver_(depth_solver) {}

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* out) override {
    out->setPersistentManifold(&manifold());
    const auto& shape_a = static_cast<const btConvexShape&>(*a->getCollisionShape());
    const auto& shape_b = static_cast<const btConvexShape&>(*b->getCollisionShape());
    ContactManifold points(manifold(), info.m_timeStep);
    Nearest nearest;
    const btScalar breaking = manifold().getContactBreakingThreshold();
    find_nearest(*a, *b, std::max(points.reach(), breaking), nearest);
    const bool alone =
        shape_a.getShapeType() == SPHERE_SHAPE_PROXYTYPE || shape_b.getShapeType() == SPHERE_SHAPE_PROXYTYPE;
    if (!nearest.found) {
      points.finish();
    } else if (alone) {
      // its one point, which is on the line from the center: GJK's is less exact
      const bool first = shape_a.getShapeType() == SPHERE_SHAPE_PROXYTYPE;
      const btVector3& center = (first ? a : b)->getWorldTransform().getOrigin();
      const btScalar radius = static_cast<const btSphereShape&>(first ? shape_a : shape_b).getRadius();
      const btVector3 point =
          first ? center - nearest.normal * (radius + nearest.distance) : center + nearest.normal * radius;
      points.add(point, nearest.normal, nearest.distance);
      points.finish();
    } else if (add_faces(*a, *b, nearest.normal, points)) {
      points.finish();
    } else {
      // edges and round sides: a point a step, as Bullet has them
      if (nearest.distance <= breaking) out->addContactPoint(nearest.normal, nearest.point, nearest.distance);
      out->refreshContactPoints();
    }
  }

 private:
  void find_nearest(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, btScalar reach,
                    Nearest& nearest) {
    const auto& shape_a = static_cast<const btConvexShape&>(*a.getCollisionShape());
    const auto& shape_b = static_cast<const btConvexShape&>(*b.getCollisionShape());
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector detector(&shape_a, &shape_b, &simplex, &depth_solver_);
    btGjkPairDetector::ClosestPointInput input;
    const btScalar far = shape_a.getMargin() + shape_b.getMargin() + reach;
    input.m_maximumDistanceSquared = far * far;
    input.m_transformA = a.getWorldTransform();
    input.m_transformB = b.getWorldTransform();
    detector.getClosestPoints(input, nearest, nullptr);
  }

  // False, if no face of either shape has the direction of the contact.
  static bool add_faces(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b, const btVector3& normal,
                        ContactManifold& points) {
    ContactFeature of_a;
    ContactFeature of_b;
    find(a, -normal, of_a);
    find(b, normal, of_b);
    const btScalar aligned_a = of_a.count > 2 ? -normal.dot(of_a.normal) : btScalar(0);
    const btScalar aligned_b = of_b.count > 2 ? normal.dot(of_b.normal) : btScalar(0);
    if (std::max(aligned_a, aligned_b) < kAligned) return false;
    const bool first = aligned_a > aligned_b + (1 - kAligned);
    if (first || aligned_b < kAligned) {
      add_points(of_a, of_b, true, points);
    } else {
      add_points(of_b, of_a, false, points);
    }
    return !points.empty();
  }

  static void find(const btCollisionObjectWrapper& object, const btVector3& direction, ContactFeature& feature) {
    const btTransform& pose = object.getWorldTransform();
    find_feature(static_cast<const btConvexShape&>(*object.getCollisionShape()), direction * pose.getBasis(), feature);
    feature.transform(pose);
  }

  btConvexPenetrationDepthSolver& depth_solver_;
};

template <class Algorithm, class... Args>
btCollisionAlgorithm* create(btCollisionAlgorithmConstructionInfo& info, Args&&... args) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(static_cast<int>(sizeof(Algorithm)));
  return new (memory) Algorithm(info, std::forward<Args>(args)...);
}

}  // namespace

btCollisionAlgorithm* ContactAlgorithms::CreatePlane::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) {
  return create<PlaneAlgorithm>(info, a, b, m_swapped);
}

btCollisionAlgorithm* ContactAlgorithms::CreateBox::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                             const btCollisionObjectWrapper* a,
                                                                             const btCollisionObjectWrapper* b) {
  return create<BoxAlgorithm>(info, a, b);
}

btCollisionAlgorithm* ContactAlgorithms::CreateConvex::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) {
  return create<ConvexAlgorithm>(info, a, b, depth_solver);
}

void ContactAlgorithms::install(btCollisionDispatcher& dispatcher) {
  plane_convex_.m_swapped = true;
  for (const int convex : {BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE,
                           CAPSULE_SHAPE_PROXYTYPE, CONE_SHAPE_PROXYTYPE, CYLINDER_SHAPE_PROXYTYPE}) {
    dispatcher.registerCollisionCreateFunc(convex, STATIC_PLANE_PROXYTYPE, &convex_plane_);
    dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, convex, &plane_convex_);
  }
  for (const int solid :
       {BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, CONE_SHAPE_PROXYTYPE, CYLINDER_SHAPE_PROXYTYPE}) {
    for (const int other : {BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, CONE_SHAPE_PROXYTYPE,
                            CYLINDER_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE, CAPSULE_SHAPE_PROXYTYPE}) {
      dispatcher.registerCollisionCreateFunc(solid, other, &convex_convex_);
      dispatcher.registerCollisionCreateFunc(other, solid, &convex_convex_);
    }
  }
  dispatcher.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &box_box_);
}

}  // namespace limber

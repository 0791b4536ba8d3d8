// Contacts of a convex shape with each triangle near it, from their closest points.
#include "sim/collision/surface_algorithm.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/mesh/hull.h"
#include "sim/collision/contact_clipping.h"
#include "sim/collision/contact_features.h"
#include "sim/collision/surface_shape.h"

#include <BulletCollision/CollisionShapes/btTriangleShape.h>

namespace limber::sim::collision {
namespace {

using bullet::from_bt;
using bullet::to_bt;
using bullet::to_scalar;

/// Contacts share a manifold if the cosine of the angle between their normals is larger than this (20 degrees).
constexpr btScalar kSameManifold = 0.94F;
/// An edge stands out if the next triangle bends away by more than this sine (0.06 degrees).
constexpr btScalar kFlatSine = 1e-3F;
/// A point is on an edge within this distance, m.
constexpr btScalar kOnEdge = 1e-5F;
/// A face is touched beside the nearest point if the shape isn't deeper in it by more than this share of the inner
/// radius than at that point.
constexpr btScalar kDepthShare = 0.25F;

/// A triangle as seen from the side on which the shape is.
struct Facet {
  Facet(const model::Surface& surface, unsigned index, const btVector3& eye) {
    const model::Surface::Triangle triangle = surface.triangle(index);
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = to_bt(triangle.corner[i]);
      has_beyond[i] = triangle.beyond[i] != model::Surface::kNone;
      if (has_beyond[i]) beyond[i] = to_bt(surface.vertex(triangle.beyond[i]));
    }
    normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    if (normal.dot(eye - corner[0]) >= 0) return;
    normal = -normal;
    std::swap(corner[1], corner[2]);
    std::swap(beyond[0], beyond[2]);
    std::swap(has_beyond[0], has_beyond[2]);
  }

  std::array<btVector3, 3> corner;  // counter-clockwise about the normal
  std::array<btVector3, 3> beyond;  // of the edge from corner i to the next: third vertex of the next triangle
  std::array<bool, 3> has_beyond;
  btVector3 normal;
};

enum class Touch { none, face, edge };

// How a shape touches a triangle at `nearest`, a point of its border, in another direction than that of its face.
Touch touch_of_border(const Facet& facet, const ClosestPoints& nearest) {
  Touch touch = Touch::edge;
  for (std::size_t i = 0; i < 3; ++i) {
    const btVector3& from = facet.corner[i];
    const btVector3 edge = (facet.corner[(i + 1) % 3] - from).normalized();
    const btVector3 inward = facet.normal.cross(edge);
    if (inward.dot(nearest.point - from) > kOnEdge || !facet.has_beyond[i]) continue;
    btVector3 outward = facet.beyond[i] - from;
    outward -= edge * outward.dot(edge);
    outward.normalize();
    if (facet.normal.dot(outward) > -kFlatSine) {
      touch = Touch::face;
      continue;
    }
    // the next triangle is nearer, or touched in its face
    if (nearest.normal.dot(outward) > 0 || nearest.normal.dot(outward.cross(edge)) > kMinAlignment) return Touch::none;
  }
  return touch;
}

btScalar lowest(const btConvexShape& shape, const btTransform& pose, const Facet& facet) {
  const btVector3 point = pose(shape.localGetSupportingVertex(-facet.normal * pose.getBasis()));
  return facet.normal.dot(point - facet.corner[0]);
}

// The corners of a triangle that are farthest in a direction: an edge, or a point.
void find_border(const Facet& facet, const btVector3& direction, ContactFeature& feature) {
  const auto height = [&](std::size_t i) { return direction.dot(facet.corner[i]); };
  const btScalar top = std::max({height(0), height(1), height(2)});
  const btScalar size = (facet.corner[1] - facet.corner[0]).length() + (facet.corner[2] - facet.corner[0]).length();
  for (std::size_t i = 0; i < 3; ++i) {
    if (height(i) > top - size * kFlatSine) feature.add(facet.corner[i]);
  }
  feature.normal = direction;
}

}  // namespace

/// One step of a pair.
class SurfaceAlgorithm::Step {
 public:
  Step(SurfaceAlgorithm& pair, const btCollisionObjectWrapper& convex, const btCollisionObjectWrapper& ground,
       btScalar h)
      : pair_(pair),
        h_(h),
        shape_(static_cast<const btConvexShape&>(*convex.getCollisionShape())),
        world_(convex.getWorldTransform()),
        ground_(ground.getWorldTransform()),
        pose_(ground_.inverseTimes(world_)),
        is_sphere_(shape_.getShapeType() == SPHERE_SHAPE_PROXYTYPE),
        radius_(convex.getCollisionObject()->getCcdMotionThreshold()),
        breaking_(pair.manifolds_[0]->getContactBreakingThreshold()) {
    builders_[0].emplace(*pair.manifolds_[0], h);
  }

  void find(const model::Surface& surface) {
    const btScalar reach = std::max(builders_[0]->max_distance(), breaking_);
    btVector3 low;
    btVector3 high;
    shape_.getAabb(pose_, low, high);
    const btVector3 margin(reach, reach, reach);
    const Vec3 center = from_bt((low + high) / 2);
    const auto radius = static_cast<double>((is_sphere_ ? (high - low).x() / 2 : (high - low).length() / 2) + reach);
    surface.for_each_near(from_bt(low - margin), from_bt(high + margin), [&](unsigned index) {
      // most triangles in the box are too far from a sphere; this is faster than their closest points
      const auto [a, b, c] = surface.triangle(index).corner;
      const Vec3 point = model::nearest_on_triangle(center, a, b, c);
      const double distance = glm::length(center - point);
      if (distance > radius) return;
      const Facet facet(surface, index, pose_.getOrigin());
      if (is_sphere_) {
        touch(facet, closest_points_of_sphere(center, point, distance), reach);
      } else if (lowest(shape_, pose_, facet) <= reach) {
        btTriangleShape triangle(facet.corner[0], facet.corner[1], facet.corner[2]);
        triangle.setMargin(0);
        touch(facet, closest_points(shape_, pose_, triangle, btTransform::getIdentity()), reach);
      }
    });
  }

  void write() {
    for (std::size_t i = 0; i < pair_.count_; ++i) {
      if (used_[i]) {
        builders_[i]->write();
      } else {
        pair_.manifolds_[i]->setNumContacts(0);
      }
    }
  }

 private:
  ClosestPoints closest_points_of_sphere(const Vec3& center, const Vec3& point, double distance) const {
    if (distance == 0) return {};
    return {true, to_scalar(distance) - shape_.getMargin(), to_bt((center - point) / distance), to_bt(point)};
  }

  void touch(const Facet& facet, const ClosestPoints& nearest, btScalar reach) {
    if (nearest.found && nearest.distance > reach) return;
    if (!nearest.found) {  // the center of a round shape is on the triangle
      touch_face(facet, nearest, false);
      return;
    }
    const btScalar alignment = nearest.normal.dot(facet.normal);
    // a normal to the other side: the shape's center is on this one, so it must leave to here
    const bool in_face = std::fabs(alignment) >= kMinAlignment;
    const Touch touch = in_face ? Touch::face : touch_of_border(facet, nearest);
    if (touch == Touch::edge) {
      touch_edge(facet, nearest);
    } else if (touch == Touch::face) {
      const btScalar depth = std::min(nearest.distance, btScalar(0)) - kDepthShare * radius_;
      if (in_face || lowest(shape_, pose_, facet) >= depth) touch_face(facet, nearest, alignment >= kMinAlignment);
    }
  }

  void touch_face(const Facet& facet, const ClosestPoints& nearest, bool aligned) {
    ContactFeature reference;
    for (const btVector3& corner : facet.corner) reference.add(corner);
    reference.normal = facet.normal;
    reference.transform(ground_);
    ContactFeature incident;
    find_world_feature(shape_, world_, -reference.normal, incident);
    ManifoldBuilder& points = builder(reference.normal);
    const int before = points.count();
    add_face_points(reference, incident, false, points);
    // round sides
    if (aligned && points.count() == before) points.add(ground_(nearest.point), reference.normal, nearest.distance);
  }

  void touch_edge(const Facet& facet, const ClosestPoints& nearest) {
    ContactFeature edge;
    find_border(facet, nearest.normal, edge);
    edge.transform(ground_);
    const btVector3& normal = edge.normal;
    ManifoldBuilder& points = builder(normal);
    ContactFeature feature;
    find_world_feature(shape_, world_, -normal, feature);
    const int before = points.count();
    if (feature.count > 2 && -normal.dot(feature.normal) >= kMinAlignment) {
      add_face_points(feature, edge, true, points);
    } else if (feature.count == 2 && edge.count == 2) {
      add_parallel_edges(feature, edge, normal, points);
    }
    if (points.count() == before) points.add(ground_(nearest.point), normal, nearest.distance);
  }

  btVector3 normal_of(std::size_t i) const {
    return {pair_.normals_[i][0], pair_.normals_[i][1], pair_.normals_[i][2]};
  }

  // the builder for contacts with a normal
  ManifoldBuilder& builder(const btVector3& normal) {
    std::size_t best = pair_.count_;
    btScalar best_cosine = pair_.count_ < kMaxManifolds ? kSameManifold : btScalar(-2);
    for (std::size_t i = 0; i < pair_.count_; ++i) {
      const btScalar cosine = normal.dot(normal_of(i));
      if (cosine > best_cosine) {
        best = i;
        best_cosine = cosine;
      }
    }
    if (best_cosine <= kSameManifold) {
      const auto* const unused = std::find(used_.begin(), used_.begin() + pair_.count_, false);
      const auto free = static_cast<std::size_t>(unused - used_.begin());
      if (free < pair_.count_) best = free;
    }
    if (best == pair_.count_) {
      const btPersistentManifold& first = *pair_.manifolds_[0];
      pair_.manifolds_[pair_.count_++] = pair_.m_dispatcher->getNewManifold(first.getBody0(), first.getBody1());
    }
    if (!builders_[best]) builders_[best].emplace(*pair_.manifolds_[best], h_);
    if (!used_[best]) pair_.normals_[best] = {normal.x(), normal.y(), normal.z()};
    used_[best] = true;
    return *builders_[best];
  }

  SurfaceAlgorithm& pair_;
  btScalar h_;
  const btConvexShape& shape_;
  const btTransform& world_;
  const btTransform& ground_;
  btTransform pose_;  // of the shape in the surface's frame
  bool is_sphere_;
  btScalar radius_;
  btScalar breaking_;
  std::array<std::optional<ManifoldBuilder>, kMaxManifolds> builders_;
  std::array<bool, kMaxManifolds> used_{};
};

SurfaceAlgorithm::SurfaceAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                                   const btCollisionObjectWrapper* b, bool surface_first)
    : PairAlgorithm(info, surface_first ? b : a, surface_first ? a : b), surface_first_(surface_first) {
  manifolds_[0] = &manifold();
}

SurfaceAlgorithm::~SurfaceAlgorithm() {
  for (std::size_t i = 1; i < count_; ++i) m_dispatcher->releaseManifold(manifolds_[i]);
}

void SurfaceAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  for (std::size_t i = 0; i < count_; ++i) manifolds.push_back(manifolds_[i]);
}

void SurfaceAlgorithm::processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                                        const btDispatcherInfo& info, btManifoldResult* out) {
  const btCollisionObjectWrapper& convex = surface_first_ ? *b : *a;
  const btCollisionObjectWrapper& ground = surface_first_ ? *a : *b;
  out->setPersistentManifold(&manifold());
  Step step(*this, convex, ground, info.m_timeStep);
  step.find(static_cast<const SurfaceShape&>(*ground.getCollisionShape()).surface());
  step.write();
}

}  // namespace limber::sim::collision

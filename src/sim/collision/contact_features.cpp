// Features of boxes, hulls, cylinders, cones, capsules and spheres, in closed form.
#include "sim/collision/contact_features.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::collision {
namespace {

constexpr int kCapCorners = 12;
/// The lowest point of a cap's rim is added if it can be at least this much deeper than the corners, m.
constexpr btScalar kRimDepth = 1e-4F;
/// (1 - cos(pi / kCapCorners)): distance between the middle of a rim's side and the circle, per radius.
constexpr btScalar kRimSag = 0.0341F;
/// A cap is level if its rim is at most this much deeper than its center, m.
constexpr btScalar kLevel = 1e-3F;
/// Directions nearer than this (sine) to a cap's axis have no unique lowest point on the rim.
constexpr btScalar kFlat = 1e-6F;

struct Corner {
  btScalar x;
  btScalar y;
};

const std::array<Corner, kCapCorners>& unit_circle() {
  static const std::array<Corner, kCapCorners> circle = [] {
    std::array<Corner, kCapCorners> corners{};
    for (int i = 0; i < kCapCorners; ++i) {
      const double angle = 2 * kPi * i / kCapCorners;
      corners[static_cast<std::size_t>(i)] = {bullet::to_scalar(fixed::cos(angle)),
                                              bullet::to_scalar(fixed::sin(angle))};
    }
    return corners;
  }();
  return circle;
}

// Adds the corners of a cap at height z that faces up (side 1) or down (-1).
void add_cap(ContactFeature& feature, btScalar radius, btScalar z, btScalar side) {
  for (const Corner& c : unit_circle()) feature.add({radius * c.x, side * radius * c.y, z});
}

struct Radial {  // part of a direction perpendicular to the z axis
  btScalar length;
  btVector3 unit;  // x if the length is about 0
};

Radial radial_of(const btVector3& direction) {
  const btScalar length = std::sqrt(direction.x() * direction.x() + direction.y() * direction.y());
  if (length < kFlat) return {0, {1, 0, 0}};
  return {length, {direction.x() / length, direction.y() / length, 0}};
}

void add_box_face(const btVector3& half, const btVector3& direction, int axis, ContactFeature& feature) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const btScalar side = direction[axis] < 0 ? btScalar(-1) : btScalar(1);
  feature.normal.setZero();
  feature.normal[axis] = side;
  for (int i = 0; i < 4; ++i) {
    btVector3 corner = half;
    corner[axis] *= side;
    corner[u] *= i == 1 || i == 2 ? 1 : -1;
    corner[v] *= (i >= 2 ? 1 : -1) * side;
    feature.add(corner);
  }
}

void find_cylinder_feature(const btCylinderShape& shape, const btVector3& direction, ContactFeature& feature) {
  const btVector3 half = shape.getHalfExtentsWithMargin();
  const Radial radial = radial_of(direction);
  const btScalar side = direction.z() < 0 ? btScalar(-1) : btScalar(1);
  if (std::fabs(direction.z()) > radial.length) {
    feature.normal.setValue(0, 0, side);
    add_cap(feature, half.x(), side * half.z(), side);
    return;
  }
  feature.normal = radial.unit;
  for (const btScalar end : {-half.z(), half.z()}) feature.add(radial.unit * half.x() + btVector3(0, 0, end));
}

void find_cone_feature(const btConeShape& shape, const btVector3& direction, ContactFeature& feature) {
  const btScalar radius = shape.getRadius();
  const btScalar height = shape.getHeight();
  const btScalar slant = std::sqrt(radius * radius + height * height);
  const Radial radial = radial_of(direction);
  feature.margin = shape.getMargin();
  const btVector3 side = radial.unit * (height / slant) + btVector3(0, 0, radius / slant);
  if (-direction.z() > side.dot(direction)) {
    feature.normal.setValue(0, 0, -1);
    add_cap(feature, radius, -height / 2, -1);
    return;
  }
  feature.normal = side;
  feature.add(radial.unit * radius - btVector3(0, 0, height / 2));
  feature.add({0, 0, height / 2});
}

void find_capsule_feature(const btCapsuleShape& shape, const btVector3& direction, ContactFeature& feature) {
  const Radial radial = radial_of(direction);
  feature.margin = shape.getRadius();
  feature.normal = radial.length > 0 ? radial.unit : direction;
  for (const btScalar end : {-shape.getHalfHeight(), shape.getHalfHeight()}) feature.add({0, 0, end});
}

void find_hull_feature(const btPolyhedralConvexShape& shape, const btVector3& direction, ContactFeature& feature) {
  const btConvexPolyhedron& polyhedron = *shape.getConvexPolyhedron();
  int best = -1;
  btScalar largest = -2;
  for (int i = 0; i < polyhedron.m_faces.size(); ++i) {
    const btScalar* plane = polyhedron.m_faces[i].m_plane;
    const btScalar along = direction.x() * plane[0] + direction.y() * plane[1] + direction.z() * plane[2];
    if (along > largest) {
      largest = along;
      best = i;
    }
  }
  if (best < 0) return;
  const btFace& face = polyhedron.m_faces[best];
  feature.normal.setValue(face.m_plane[0], face.m_plane[1], face.m_plane[2]);
  feature.margin = shape.getMargin();
  const int stride = (face.m_indices.size() + ContactFeature::kMaxPoints - 1) / ContactFeature::kMaxPoints;
  for (int i = 0; i < face.m_indices.size(); i += stride) feature.add(polyhedron.m_vertices[face.m_indices[i]]);
}

void find_support(const btConvexShape& shape, const btVector3& direction, ContactFeature& feature) {
  feature.normal = direction;
  feature.margin = 0;
  feature.add(shape.localGetSupportingVertex(direction));
}

// For a rim that faces down, with its lowest point `depth` below the plane: adds its cap if it is nearly level, and its
// lowest point if the cap's corners miss that.
void add_lowest_points(const Radial& radial, btScalar radius, btScalar z, btScalar side, btScalar depth,
                       ContactFeature& feature) {
  const bool level = radial.length * radius < kLevel + std::max(depth, btScalar(0));
  if (level) add_cap(feature, radius, z, side);
  if (!level || radial.length * radius * kRimSag > kRimDepth) {
    feature.add(radial.unit * radius + btVector3(0, 0, z));
  }
}

bool has_z_axis(const btConvexShape& shape) {
  switch (shape.getShapeType()) {
    case CYLINDER_SHAPE_PROXYTYPE:
      return static_cast<const btCylinderShape&>(shape).getUpAxis() == 2;
    case CONE_SHAPE_PROXYTYPE:
      return static_cast<const btConeShape&>(shape).getConeUpIndex() == 2;
    case CAPSULE_SHAPE_PROXYTYPE:
      return static_cast<const btCapsuleShape&>(shape).getUpAxis() == 2;
    default:
      return true;
  }
}

}  // namespace

void ContactFeature::transform(const btTransform& pose) {
  for (int i = 0; i < count; ++i) (*this)[i] = pose((*this)[i]);
  normal = pose.getBasis() * normal;
}

void find_feature(const btConvexShape& shape, const btVector3& direction, ContactFeature& feature) {
  feature.count = 0;
  feature.margin = 0;
  if (!has_z_axis(shape)) return find_support(shape, direction, feature);
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return add_box_face(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin(), direction,
                          direction.absolute().maxAxis(), feature);
    case CYLINDER_SHAPE_PROXYTYPE:
      return find_cylinder_feature(static_cast<const btCylinderShape&>(shape), direction, feature);
    case CONE_SHAPE_PROXYTYPE:
      return find_cone_feature(static_cast<const btConeShape&>(shape), direction, feature);
    case CAPSULE_SHAPE_PROXYTYPE:
      return find_capsule_feature(static_cast<const btCapsuleShape&>(shape), direction, feature);
    case CONVEX_HULL_SHAPE_PROXYTYPE: {
      const auto& hull = static_cast<const btPolyhedralConvexShape&>(shape);
      if (hull.getConvexPolyhedron() != nullptr) find_hull_feature(hull, direction, feature);
      break;
    }
    default:
      break;
  }
  if (feature.count == 0) find_support(shape, direction, feature);
}

void find_points_on_plane(const btConvexShape& shape, const btVector3& direction, btScalar plane, btScalar max_distance,
                          ContactFeature& feature) {
  feature.count = 0;
  feature.margin = 0;
  feature.normal = direction;
  if (!has_z_axis(shape)) return find_support(shape, direction, feature);
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE: {
      // the lowest face contains the lowest corner and the three next ones
      const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
      return add_box_face(half, direction, (half * direction).absolute().maxAxis(), feature);
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
      const Radial radial = radial_of(direction);
      const btScalar side = direction.z() < 0 ? btScalar(-1) : btScalar(1);
      const btScalar lowest = radial.length * half.x() + std::fabs(direction.z()) * half.z();
      add_lowest_points(radial, half.x(), side * half.z(), side, lowest - plane, feature);
      feature.add(radial.unit * half.x() - btVector3(0, 0, side * half.z()));
      return;
    }
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      const Radial radial = radial_of(direction);
      feature.margin = cone.getMargin();
      const btScalar lowest =
          radial.length * cone.getRadius() - direction.z() * cone.getHeight() / 2 + cone.getMargin();
      add_lowest_points(radial, cone.getRadius(), -cone.getHeight() / 2, -1, lowest - plane, feature);
      feature.add({0, 0, cone.getHeight() / 2});
      return;
    }
    case CAPSULE_SHAPE_PROXYTYPE: {
      find_capsule_feature(static_cast<const btCapsuleShape&>(shape), direction, feature);
      return;
    }
    case SPHERE_SHAPE_PROXYTYPE:
      feature.margin = static_cast<const btSphereShape&>(shape).getRadius();
      feature.add({0, 0, 0});
      return;
    case CONVEX_HULL_SHAPE_PROXYTYPE: {
      const auto& hull = static_cast<const btConvexHullShape&>(shape);
      const btVector3* points = hull.getUnscaledPoints();
      feature.margin = hull.getMargin();
      btScalar largest = -BT_LARGE_FLOAT;
      int lowest = 0;
      for (int i = 0; i < hull.getNumPoints(); ++i) {
        const btScalar along = points[i].dot(direction);
        if (along > largest) {
          largest = along;
          lowest = i;
        }
      }
      if (hull.getNumPoints() > 0) feature.add(points[lowest]);
      for (int i = 0; i < hull.getNumPoints(); ++i) {
        if (i != lowest && points[i].dot(direction) + feature.margin >= plane - max_distance) feature.add(points[i]);
      }
      return;
    }
    default:
      return find_support(shape, direction, feature);
  }
}

}  // namespace limber::sim::collision

// Geometry: converts placed shapes and an inertial to a Bullet shape in the center-of-mass frame.
#include "sim/shapes/geometry.h"

#include <algorithm>
#include <utility>

#include "model/mesh/mass_properties.h"
#include "model/pieces/pieces.h"
#include "sim/bullet/bullet.h"
#include "sim/collision/surface_shape.h"
#include "sim/shapes/ellipsoid_shape.h"

namespace limber::sim {

namespace {

constexpr btScalar kMargin = 0.001f;  // hulls and cones are enlarged by it; Bullet's default of 4 cm would be visible

bool is_identity(const Pose& pose) {
  return glm::length(pose.position) < 1e-9 && std::abs(std::abs(pose.rotation.w) - 1) < 1e-12;
}

std::shared_ptr<btCollisionShape> hull_shape(const model::MeshModel& mesh, const Pose& at) {
  auto hull = std::make_shared<btConvexHullShape>();
  for (const Vec3& v : mesh.hull) hull->addPoint(bullet::to_bt(at * v), false);
  hull->setMargin(kMargin);
  hull->recalcLocalAabb();
  hull->initializePolyhedralFeatures();  // contact manifolds need its faces
  return hull;
}

std::shared_ptr<btCollisionShape> primitive_shape(const model::ShapeModel& m) {
  const btScalar radius = bullet::to_scalar(m.radius);
  const btScalar height = bullet::to_scalar(m.height);
  const btScalar half = height / 2;
  switch (m.kind) {
    case model::ShapeKind::plane:
      return std::make_shared<btStaticPlaneShape>(bullet::to_bt(m.normal), btScalar(0));
    case model::ShapeKind::sphere:
      return std::make_shared<btSphereShape>(radius);
    case model::ShapeKind::box:
      return std::make_shared<btBoxShape>(bullet::to_bt(m.size * 0.5));
    case model::ShapeKind::ellipsoid:
      return std::make_shared<EllipsoidShape>(m.size * 0.5);
    case model::ShapeKind::cylinder:
      return std::make_shared<btCylinderShapeZ>(btVector3(radius, radius, half));
    case model::ShapeKind::capsule:
      return std::make_shared<btCapsuleShapeZ>(radius, height);
    case model::ShapeKind::cone: {
      auto cone = std::make_shared<btConeShapeZ>(radius, height);
      cone->setMargin(std::min({kMargin, radius / 10, height / 10}));
      return cone;
    }
    default:
      return nullptr;
  }
}

// Sets the center, the principal axes, and the moments per kilogram.
void set_mass_properties(Geometry& geometry, const model::Inertial& inertial) {
  geometry.frame.position = inertial.center;
  const Mat3 tensor = inertial.tensor / inertial.mass;
  const double trace = tensor[0][0] + tensor[1][1] + tensor[2][2];
  const double off_diagonal = std::abs(tensor[0][1]) + std::abs(tensor[0][2]) + std::abs(tensor[1][2]);
  if (off_diagonal <= 1e-9 * trace) {
    // the tensor is diagonal already: shapes keep their axes, and no rotated compound is needed
    geometry.unit_inertia = {tensor[0][0], tensor[1][1], tensor[2][2]};
  } else {
    const model::PrincipalAxes principal = model::principal_axes(tensor);
    geometry.unit_inertia = principal.moments;
    geometry.frame.rotation = glm::normalize(glm::quat_cast(principal.axes));
  }
  // a lower bound: the rotation about the axis of a thin rod would grow without bound in single precision
  const double largest = std::max({geometry.unit_inertia.x, geometry.unit_inertia.y, geometry.unit_inertia.z, 1e-9});
  geometry.unit_inertia = glm::max(geometry.unit_inertia, Vec3(1e-3 * largest));
}

// Returns the mass distribution of the shapes' volume, with a density of 1.
model::Inertial solid_inertial(const std::vector<model::PlacedShape>& shapes) {
  std::vector<model::Inertial> solids;
  for (const model::PlacedShape& placed : shapes) {
    if (!model::is_ground(placed.shape))
      solids.push_back(model::transformed(model::unit_inertial_of(placed.shape), placed.origin));
  }
  return model::combined(solids);
}

// Limits the margin of a box that is a piece of a mesh. Bullet rounds the edges of boxes by their margin, by default up
// to a tenth of the shortest half edge; pieces need edges as sharp as those of hulls, so that their union is the mesh.
void sharpen(btCollisionShape& shape) {
  if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) shape.setMargin(std::min(kMargin, shape.getMargin()));
}

// The collision shape; `at`: its pose relative to the center of mass, which hulls include in their points.
std::shared_ptr<btCollisionShape> collision_shape(const model::ShapeModel& shape, const Pose& at, bool is_hull) {
  if (is_hull) return hull_shape(*shape.mesh, at);
  if (shape.surface != nullptr) return std::make_shared<collision::SurfaceShape>(shape.surface);
  return primitive_shape(shape);
}

// Sets the collision shape: a single shape if possible, else a compound.
void set_collision_shape(Geometry& geometry) {
  std::vector<model::PlacedShape> shapes;
  std::vector<bool> is_piece;
  for (const model::PlacedShape& placed : geometry.placed) {
    if (placed.shape.mesh != nullptr) geometry.meshes.push_back(placed.shape.mesh);
    for (model::PlacedShape& convex : model::convex_shapes(placed)) shapes.push_back(std::move(convex));
    is_piece.resize(shapes.size(), model::has_pieces(placed.shape));
  }
  const Pose to_center = geometry.frame.inverse();
  auto compound = std::make_shared<btCompoundShape>(shapes.size() > 4);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const model::PlacedShape& placed = shapes[i];
    const Pose at = to_center * placed.origin;
    const bool is_hull =
        placed.shape.kind == model::ShapeKind::mesh && placed.shape.mesh != nullptr && placed.shape.surface == nullptr;
    std::shared_ptr<btCollisionShape> shape = collision_shape(placed.shape, at, is_hull);
    if (shape == nullptr) continue;
    if (is_piece[i]) sharpen(*shape);
    if (shapes.size() == 1 && (is_hull || is_identity(at))) {
      geometry.shape = shape;
      return;
    }
    compound->addChildShape(is_hull ? btTransform::getIdentity() : bullet::to_bt(at), shape.get());
    geometry.children.push_back(std::move(shape));
  }
  geometry.shape = compound;
}

}  // namespace

std::shared_ptr<const Geometry> make_geometry(const std::vector<model::PlacedShape>& shapes,
                                              const model::Inertial& inertial) {
  auto geometry = std::make_shared<Geometry>();
  geometry->placed = shapes;
  const model::Inertial solid = solid_inertial(shapes);
  geometry->volume = solid.mass;
  const bool given = inertial.mass > 0 && inertial.tensor[0][0] > 0;
  if (given || solid.mass > 0) set_mass_properties(*geometry, given ? inertial : solid);
  set_collision_shape(*geometry);
  return geometry;
}

}  // namespace limber::sim

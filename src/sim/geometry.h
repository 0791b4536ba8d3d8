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
  std::vector<PlacedShape> placed;  ///< What it was made of, in the link's frame.
  Pose frame;                       ///< The centre-of-mass frame in the link's frame.
  Vec3 unit_inertia{0};             ///< Principal moments for a mass of 1 kg, m².
  double volume = 0;                ///< m³; 0 for a plane.
};

/// Geometry of a link from its collision shapes and its inertial. An inertial without mass: centre and tensor come
/// from the shapes' volume.
std::shared_ptr<const Geometry> make_geometry(const std::vector<PlacedShape>& shapes, const Inertial& inertial);

}  // namespace limber

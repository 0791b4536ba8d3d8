// Geometry: the collision shape and mass distribution of a part, built once and shared by all copies. [sim]
#pragma once

#include <memory>
#include <vector>

#include "model/body_model.h"

class btCollisionShape;

namespace limber::sim {

/// A collision shape in a part's center-of-mass frame (principal axes), and the pose of that frame in the link's
/// frame.
struct Geometry {
  std::shared_ptr<btCollisionShape> shape;
  std::vector<std::shared_ptr<btCollisionShape>> children;  ///< Keeps the children of `shape` alive.
  std::vector<std::shared_ptr<const model::MeshModel>> meshes;
  std::vector<model::PlacedShape> placed;  ///< The shapes that it was built from, in the link's frame.
  Pose frame;                              ///< The center-of-mass frame in the link's frame.
  Vec3 unit_inertia{0};                    ///< Principal moments for a mass of 1 kg, m².
  double volume = 0;                       ///< m³; 0 for a plane.
};

/// Builds the geometry of a link from its collision shapes and its inertial. If its mass or tensor is missing (0),
/// center and tensor are computed from the shapes' volume instead.
std::shared_ptr<const Geometry> make_geometry(const std::vector<model::PlacedShape>& shapes,
                                              const model::Inertial& inertial);

}  // namespace limber::sim

// Mesh: triangles as one vertex formula draws them: place = corner·extent + normal·round. Boxes with bevels, capsules
// and cylinders of any size come out of one mesh each with true radii.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber {

struct MeshVertex {
  float corner[3];
  float normal[3];
};

/// Triangles, counter-clockwise seen from outside; three vertices each, none shared.
using MeshVertices = std::vector<MeshVertex>;

/// Levels of detail: 0 is the finest.
inline constexpr int kDetails = 4;

/// A primitive's; empty for planes, meshes, compounds. [any]
MeshVertices primitive_mesh(ShapeKind kind, int detail);
/// A file's: normals are smooth over edges of less than 35°; coarser details gather what is near to each other. [any]
MeshVertices model_mesh(const MeshModel& model, int detail);

/// The same triangles with each vertex once, so that a graphics card works each out once.
struct IndexedMesh {
  MeshVertices vertices;
  std::vector<std::uint32_t> indices;  ///< Three a triangle.
};
IndexedMesh indexed(const MeshVertices& triangles);

/// The two numbers of the formula for a primitive: half its size without the rounding, and the radius of that.
struct MeshSize {
  Vec3 extent{1, 1, 1};
  double round = 0;
};
MeshSize mesh_size(const ShapeModel& shape);

}  // namespace limber

// Meshes for drawing. The vertex shader computes position = corner·extent + normal·radius, so that one mesh per
// primitive gives beveled boxes, capsules and cylinders of any size with exact radii.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::render {

struct MeshVertex {
  float corner[3];
  float normal[3];
};

/// Triangles, counter-clockwise seen from outside; three vertices each, not shared.
using MeshVertices = std::vector<MeshVertex>;

/// Number of levels of detail; level 0 is the finest.
inline constexpr int kDetailLevels = 4;

/// The mesh of a primitive; empty for planes, meshes and compounds. [any]
MeshVertices primitive_mesh(model::ShapeKind kind, int detail);
/// The mesh of a file, with smooth normals across edges of less than 35°. Coarser levels of detail merge nearby
/// vertices. [any]
MeshVertices model_mesh(const model::MeshModel& model, int detail);

/// Triangles with shared vertices, so that a GPU transforms each vertex once.
struct IndexedMesh {
  MeshVertices vertices;
  std::vector<std::uint32_t> indices;  ///< Three per triangle.
};
/// Merges equal vertices and removes degenerate triangles. [any]
IndexedMesh with_shared_vertices(const MeshVertices& triangles);

/// The inputs of the vertex formula for a primitive: half its size without the rounding, and the rounding's radius.
struct MeshSize {
  Vec3 extent{1, 1, 1};
  double rounding_radius = 0;
};
MeshSize mesh_size(const model::ShapeModel& shape);

}  // namespace limber::render

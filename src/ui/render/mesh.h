// Meshes for drawing. The vertex shader computes position = corner·extent + normal·radius, so that one mesh per
// primitive gives beveled boxes, capsules and cylinders of any size with exact radii.
#pragma once

#include <cstdint>
#include <memory>
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

/// A vertex of a mesh with colors of its own.
struct ColoredVertex {
  float corner[3];
  float normal[3];
  float texcoord[2];
  std::uint8_t color[4];  ///< sRGB-encoded, as is `emission`; multiplied by the texture and the instance's color.
  std::uint8_t emission[4];
};
using ColoredVertices = std::vector<ColoredVertex>;

/// How a mesh is colored: in the instance's color only, in its own colors, or with a texture of the model file.
enum class MeshColoring : std::uint8_t { plain, own, textured };
/// The coloring of a shape. [any]
MeshColoring coloring_of(const model::ShapeModel& shape);

/// Triangles of a mesh that are drawn at once.
struct MeshPart {
  std::shared_ptr<const model::Image> texture;  ///< Null: none.
  double alpha = 1;
  bool operator==(const MeshPart&) const = default;
};
/// The parts of a shape that isn't plain: one for each texture and alpha of its materials. [any]
std::vector<MeshPart> mesh_parts(const model::ShapeModel& shape);

/// Number of levels of detail; level 0 is the finest.
inline constexpr int kDetailLevels = 4;

/// The mesh of a primitive; empty for planes, meshes and compounds. [any]
MeshVertices primitive_mesh(model::ShapeKind kind, int detail);
/// The mesh of a file, with smooth normals across edges of less than 35°. Coarser levels of detail merge nearby
/// vertices. [any]
MeshVertices model_mesh(const model::MeshModel& model, int detail);

/// The mesh of a shape that isn't plain: the triangles of each of its parts, in the order of mesh_parts(). Boxes have
/// the texture on each face, other primitives around their axis. [any]
std::vector<ColoredVertices> colored_meshes(const model::ShapeModel& shape, int detail);

/// Triangles with shared vertices, so that a GPU transforms each vertex once.
template <class Vertex>
struct IndexedVertices {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< Three per triangle.
};
using IndexedMesh = IndexedVertices<MeshVertex>;
/// Merges equal vertices and removes degenerate triangles. [any]
IndexedMesh with_shared_vertices(const MeshVertices& triangles);
IndexedVertices<ColoredVertex> with_shared_vertices(const ColoredVertices& triangles);

/// The inputs of the vertex formula for a primitive: half its size without the rounding, and the rounding's radius.
struct MeshSize {
  Vec3 extent{1, 1, 1};
  double rounding_radius = 0;
};
MeshSize mesh_size(const model::ShapeModel& shape);

}  // namespace limber::render

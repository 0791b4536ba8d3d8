// Approximate convex decomposition: cuts a closed mesh into few convex hulls that leave its hollows free.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "model/body_model.h"
#include "model/mesh/hull.h"

namespace limber::model {

/// Larger meshes aren't decomposed, to bound the time to a few seconds.
inline constexpr std::size_t kMaxDecomposedTriangles = 100'000;
/// The same for all meshes of a model file.
inline constexpr std::size_t kMaxDecomposedTrianglesOfFile = 400'000;

struct DecompositionLimits {
  std::size_t max_pieces = 32;
  double tolerance = 0.02;  ///< Depth of a hollow that may be filled, relative to the mesh's largest extent.
  double hollow = 0.1;      ///< Volume that may be filled, relative to the hull that fills it.
};

struct Decomposition {
  std::vector<Hull> hulls;  ///< One: the mesh is convex within the tolerance.
  /// Depth of the deepest hollow that a hull fills, measured along the normals of sampled points, meters.
  double filled_depth = 0;
};

/// Decomposes a closed surface. Begins with the bounding box as the only cell, and repeatedly cuts the cell whose hull
/// has the largest volume outside of the mesh. Of several planes orthogonal to an axis, it chooses the one after which
/// the hulls fill the least. Stops when all cells are within both limits, or there are `max_pieces`; then joins cells
/// whose common hull is hardly larger than the two. The axes are those of the mesh's frame, or of its inertia
/// (align_to_axes()). The hulls contain the mesh. The result depends on the triangles, but not on their order. [any]
Decomposition decompose(std::span<const Vec3> vertices, std::span<const unsigned> triangles,
                        const DecompositionLimits& limits = {});

/// Returns a mesh with the pieces of its decomposition. A convex mesh and one whose objects are convex keep their
/// shapes. So does a mesh that is open or too large, which gets a problem (MeshModel::collision_problems). [any]
std::shared_ptr<const MeshModel> decomposed(const std::shared_ptr<const MeshModel>& mesh);

}  // namespace limber::model

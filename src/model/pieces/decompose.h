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
  /// The largest distance along the normal of a sampled point of the surface that a hull fills in front of it, meters.
  double filled_depth = 0;
};

/// Decomposes a closed surface. Repeatedly cuts the cell whose hull has the largest volume outside of the mesh, at one
/// of the planes orthogonal to an axis, chosen by what the hulls of both sides fill; then joins hulls that fill nothing
/// together. The axes are those of the mesh's frame, or of its inertia (align_to_axes()). A cell is cut no further if
/// it is within both limits, or there are `max_pieces`. The hulls contain the mesh. Depends on the triangles only, not
/// on their order. [any]
Decomposition decompose(std::span<const Vec3> vertices, std::span<const unsigned> triangles,
                        const DecompositionLimits& limits = {});

/// Returns a mesh with the pieces of its decomposition. A convex mesh, one whose objects are convex, and one that can't
/// be decomposed because it is open or too large (which it reports), stays as it is. [any]
std::shared_ptr<const MeshModel> decomposed(const std::shared_ptr<const MeshModel>& mesh);

}  // namespace limber::model

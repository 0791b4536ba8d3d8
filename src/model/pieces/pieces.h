// Convex pieces: the shapes that a mesh of several objects, or a decomposed one, collides as instead of one hull.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/body_model.h"
#include "model/mesh/hull.h"

namespace limber::model {

/// Largest number of pieces of a mesh. A file with more objects collides as one hull, which is reported.
inline constexpr std::size_t kMaxPieces = 64;

/// Returns the volume of a hull. [any]
double volume_of(const Hull& hull);

/// True if a shape collides as the pieces of its mesh. [any]
bool has_pieces(const ShapeModel& shape);
/// Returns the convex shapes that a shape collides as, placed in the same frame: the pieces of a mesh that has some,
/// otherwise the shape itself. [any]
std::vector<PlacedShape> convex_shapes(const PlacedShape& placed);

/// Makes a piece of a complete hull: the box, sphere or capsule that it matches, else its reduced hull. [any]
PlacedShape piece_of(const Hull& complete, const HullLimits& limits = {});
/// Sets the pieces of a mesh, in their order, and the error and the volume of its hulls. [any]
void set_pieces(MeshModel& mesh, std::span<const Hull> hulls, const HullLimits& limits = {});

/// Returns a mesh that collides as one hull, without problems. [any]
std::shared_ptr<const MeshModel> without_pieces(const MeshModel& mesh);

/// True if each edge is used equally often in both directions, as in the surface of one or more solids that may touch.
/// [any]
bool is_watertight(std::span<const unsigned> triangles);

/// The objects of a mesh file as solids.
struct ObjectSolids {
  bool watertight = false;  ///< All are closed surfaces, and there are several.
  Inertial inertial;        ///< Sum of their mass properties at density 1; open ones count as their hulls.
};
/// Sets the pieces of a mesh whose file has several objects. `objects`: the object of each triangle; empty: unknown.
/// Open objects that share vertices are patches of one surface and become one piece; an object inside the hull of
/// another needs none. Leaves the mesh as it is if one piece remains; with more than kMaxPieces also reports it. [any]
ObjectSolids split_objects(MeshModel& mesh, std::span<const std::uint32_t> objects);

}  // namespace limber::model

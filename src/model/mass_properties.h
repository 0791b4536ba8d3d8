// Mass, centre of mass and inertia tensor: of triangle meshes by signed tetrahedra, of primitives by formula; sums,
// moves, and what to do with tensors that no body can have.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber {

/// A tensor along its own axes: `axes` turns from these axes to the frame that the tensor was given in.
struct Principal {
  Vec3 moments{0, 0, 0};  ///< Ascending.
  Mat3 axes{1};           ///< Columns: the principal axes, right-handed.
};
/// Of a symmetric tensor (Jacobi's method). [any]
Principal principal_of(const Mat3& tensor);

/// What a closed surface encloses at density 1 (mass = volume, negative when the triangles face inwards). [any]
Inertial solid_of(std::span<const Vec3> vertices, std::span<const unsigned> triangles);

/// Whether every edge is shared by exactly two triangles that run along it in opposite directions. [any]
bool is_closed(std::span<const unsigned> triangles);

/// A shape at density 1, in its own frame. Planes have no mass; a mesh has what `MeshModel::solid` says. [any]
Inertial solid_of(const ShapeModel& shape);

/// The same body seen from the frame in which its own frame lies at `pose`. [any]
Inertial moved(const Inertial& body, const Pose& pose);
/// The same body of another density. [any]
Inertial scaled(const Inertial& body, double factor);
/// Rigidly joined bodies, all given in one frame. [any]
Inertial sum_of(std::span<const Inertial> bodies);

/// Why no body can have this tensor ("not positive", "triangle inequality"), or empty. [any]
std::string tensor_fault(const Mat3& tensor);

/// The tensor with its principal moments raised to at least 1/1000 of the largest and 1e-6 kg·m², which single
/// precision needs; `raised` tells whether that changed anything. [any]
Mat3 solvable_tensor(const Mat3& tensor, bool& raised);

}  // namespace limber

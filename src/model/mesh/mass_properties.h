// Mass, center of mass and inertia tensor of triangle meshes (by signed tetrahedra) and of primitives (by formula),
// with functions to combine, transform, validate and regularize them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::model {

/// Eigenvalues and eigenvectors of an inertia tensor: tensor = axes * diag(moments) * transpose(axes).
struct PrincipalAxes {
  Vec3 moments{0, 0, 0};  ///< Ascending.
  Mat3 axes{1};           ///< Columns: the principal axes, right-handed.
};
/// Diagonalizes a symmetric tensor by Jacobi's method. [any]
PrincipalAxes principal_axes(const Mat3& tensor);

/// Mass properties of the volume inside a closed surface at density 1. The mass is the volume; it is negative if the
/// triangles face inwards. [any]
Inertial unit_inertial_of(std::span<const Vec3> vertices, std::span<const unsigned> triangles);

/// True if the mesh is watertight: exactly two triangles share each edge, in opposite directions. [any]
bool is_closed(std::span<const unsigned> triangles);

/// Mass properties of a shape at density 1, in its own frame: `MeshModel::unit_inertial` for a mesh, 0 for planes and
/// compounds. [any]
Inertial unit_inertial_of(const ShapeModel& shape);

/// Transforms mass properties from a frame that lies at `pose` into the frame that `pose` is given in. [any]
Inertial transformed(const Inertial& body, const Pose& pose);
/// Multiplies the density, and with it mass and tensor, by `factor`. [any]
Inertial scaled(const Inertial& body, double factor);
/// Mass properties of rigidly joined bodies, all in one frame, by the parallel axis theorem. [any]
Inertial combined(std::span<const Inertial> bodies);

/// Returns the reason why a tensor is physically impossible (not finite, not positive, violates the triangle
/// inequality); empty if it is valid. [any]
std::string tensor_error(const Mat3& tensor);

/// Returns the tensor with its principal moments raised to at least 1/1000 of the largest and 1e-6 kg·m², because
/// smaller moments are unstable in single precision. Sets `raised` to true if that changed the tensor. [any]
Mat3 regularized_tensor(const Mat3& tensor, bool& raised);

}  // namespace limber::model

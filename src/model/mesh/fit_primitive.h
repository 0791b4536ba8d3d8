// Recognizes meshes that are boxes, spheres or capsules: primitives collide more accurately and faster than hulls.
#pragma once

#include <optional>

#include "model/body_model.h"
#include "model/mesh/hull.h"

namespace limber::model {

/// Returns the primitive that matches a mesh's convex hull, with `origin` in the mesh's frame: a box (faces orthogonal
/// within 0.1 %), or a sphere or capsule (each vertex within 1 % of the radius of the surface). Empty if none does.
/// [any]
std::optional<PlacedShape> recognize_primitive(const Hull& whole);

}  // namespace limber::model

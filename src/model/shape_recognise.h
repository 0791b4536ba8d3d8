// Recognises boxes, spheres and capsules in meshes: as primitives they collide better and cost less than as hulls.
#pragma once

#include <optional>

#include "model/body_model.h"
#include "model/hull.h"

namespace limber {

/// The primitive that the mesh's hull is, with `origin` in the mesh's frame: box (faces square to 0.1 %), sphere or
/// capsule (every vertex within 1 % of the radius from the surface). Nothing when it is none. [any]
std::optional<PlacedShape> recognise(const Hull& whole);

}  // namespace limber

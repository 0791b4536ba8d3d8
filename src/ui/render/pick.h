// Picking: finds the part that the user points at.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/output/snapshot.h"
#include "ui/render/camera.h"

namespace limber::render {

/// A part that the user points at.
struct Picked {
  std::uint32_t part_offset = 0;  ///< Offset of the part's values in Snapshot::transient.
  Vec3 point{0};                  ///< Hit point on its surface, world.
  double distance = 0;            ///< Distance from the eye, m.
};

/// Returns the nearest part at a point in normalized device coordinates (-1..1, right and up). Ignores planes and
/// disabled parts. Tests the exact shape of spheres and boxes, and the triangles of other shapes. [any]
std::optional<Picked> pick(const engine::Snapshot& current, const CameraMatrices& camera, double x, double y);

/// Returns the unit direction from the eye through a point in normalized device coordinates. [any]
Vec3 ray_through(const CameraMatrices& camera, double x, double y);

}  // namespace limber::render

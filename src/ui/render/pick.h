// Picking: finds the part under a point of the view.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/output/snapshot.h"
#include "ui/render/camera.h"

namespace limber {

/// The part under a point of the view.
struct Picked {
  std::uint32_t part_offset = 0;  ///< Offset of the part's values in Snapshot::transient.
  Vec3 point{0};                  ///< Hit point on its surface, world.
  double distance = 0;            ///< Distance from the eye, m.
};

/// Returns the nearest part at a point of the view (-1..1, right and up). Ignores planes and disabled parts. Tests the
/// exact shape of spheres and boxes, and the triangles of other shapes. [any]
std::optional<Picked> pick(const Snapshot& now, const ViewCamera& camera, double x, double y);

/// Unit direction from the eye through a point of the view (-1..1, right and up). [any]
Vec3 ray_through(const ViewCamera& camera, double x, double y);

/// World pose of a part. [any]
Pose part_pose(const Snapshot& now, std::uint32_t part_offset);

}  // namespace limber

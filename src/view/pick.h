// Picking: which part lies under a place of the picture.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/snapshot.h"
#include "view/lens.h"

namespace limber {

struct Picked {
  std::uint32_t part_at = 0;  ///< Where the part's block begins in Snapshot::live.
  Vec3 point{0};              ///< Of its surface, world.
  double distance = 0;        ///< From the eye, m.
};

/// The nearest at that place (-1 .. 1, right and up), seen as that lens sees it; planes and what is not drawn are none.
/// By its true form: balls, boxes, and the triangles of all else. [any]
std::optional<Picked> pick(const Snapshot& now, const Lens& lens, double x, double y);

/// A direction from the eye through that place.
Vec3 ray_through(const Lens& lens, double x, double y);

/// Where the part is. [any]
Pose part_pose(const Snapshot& now, std::uint32_t part_at);

}  // namespace limber

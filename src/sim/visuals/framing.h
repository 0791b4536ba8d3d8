// Framing: a view that shows a set of objects as large as possible. [any]
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::sim {

class World;

/// A sphere that a view shall contain, in world coordinates.
struct FramedSphere {
  Vec3 center{0};
  double radius = 0;
};

/// A view from `eye` to `target`.
struct FramedView {
  Vec3 eye{0};
  Vec3 target{0};
};

/// The opening and near clipping distance of a camera.
struct FrameShape {
  double fovy = 40;    ///< Vertical field of view, degrees.
  double aspect = 1;   ///< Width / height.
  double near = 0.05;  ///< Near clipping distance, m; the view keeps four times this distance.
};

/// Adds spheres that enclose a shape at this pose: its corners, or the ends of a capsule. A plane adds none.
void add_framed_shape(const model::ShapeModel& shape, const Pose& pose, std::vector<FramedSphere>& out);

/// Returns the nearest view along `direction` (from the target to the eye) that contains all spheres, with a margin;
/// nothing without spheres. Its target is the center of their bounding box. The result depends on the arguments only.
std::optional<FramedView> frame(std::span<const FramedSphere> spheres, const Vec3& direction, const FrameShape& shape);

/// Returns spheres around the bodies that can move or, if there are none, around all. Bodies without collision shapes
/// have those of their visuals. [sim]
std::vector<FramedSphere> framed_bodies(const World& world);

/// Makes a view of these bodies the default view of the camera, unless its pose was set or there are none. The
/// direction is that of the table's default. It fits into views with an aspect ratio of at least 4:3. [sim]
void frame_scene(World& world);

}  // namespace limber::sim

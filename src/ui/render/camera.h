// CameraMatrices: computed from a camera's properties. Orbit: camera control by mouse.
#pragma once

#include <glm/mat4x4.hpp>

#include "engine/output/render_scene.h"

namespace limber::render {

/// A camera: matrices and the vectors they were computed from.
struct CameraMatrices {
  glm::mat4 view;
  glm::mat4 projection;
  Vec3 eye{0};
  Vec3 forward{0, 1, 0};
  Vec3 up{0, 0, 1};
  Vec3 target{0};
  double focal_pixels = 0;  ///< Focal length in pixels: size of 1 m at a distance of 1 m.
};
/// The part of a view that is not covered by panels, relative to the view's size, from its top left corner, 0..1.
struct FreeArea {
  double x = 0, y = 0, width = 1, height = 1;
};
/// Computes the camera for a view of that size, pixels. The field of view spans the height of `free_area`, centered
/// in it; the view extends beyond it. [any]
CameraMatrices camera_matrices(const engine::CameraSettings& camera, int width, int height,
                               const FreeArea& free_area = {});

/// An orbit camera with a target point. Angles in radians; the camera stays upright.
struct Orbit {
  Vec3 eye{0};
  Vec3 target{0};

  /// Orbits around the target: `right` rotates the world to the right, `up` raises the eye, at most to almost straight
  /// above or below.
  void orbit(double right, double up);
  /// Pans eye and target in the view plane, so that the target moves by these fractions of the view's height.
  void pan(double right, double up, double fovy_degrees);
  /// Multiplies the distance from the target by `factor`; it stays positive.
  void zoom(double factor);
};

}  // namespace limber::render

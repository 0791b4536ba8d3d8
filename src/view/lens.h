// Lens: the camera's rows as matrices, and what a mouse makes of them.
#pragma once

#include <glm/mat4x4.hpp>

#include "engine/drawing.h"

namespace limber {

struct Lens {
  glm::mat4 view;
  glm::mat4 projection;
  Vec3 eye{0};
  Vec3 forward{0, 1, 0};
  Vec3 up{0, 0, 1};
  Vec3 target{0};
  double pixels = 0;  ///< What a metre takes at a metre's distance.
};
/// The part of a picture that nothing lies over, from its top left corner, 0 .. 1.
struct FreePart {
  double x = 0, y = 0, width = 1, height = 1;
};
/// For a picture of that size. What the camera sees from bottom to top fills the free part's height, about its middle;
/// the picture goes on beyond it. [any]
Lens lens_of(const CameraView& camera, int width, int height, const FreePart& free = {});

/// Two points that a hand moves: where it looks from, and at. Angles in radians; the eye stays upright.
struct Orbit {
  Vec3 eye{0};
  Vec3 target{0};

  /// About the target: `right` turns the world to the right, `up` raises the eye, at most straight above or below.
  void turn(double right, double up);
  /// Both, in the picture's plane, as far as the target seems to move by these parts of the picture's height.
  void shift(double right, double up, double fovy_degrees);
  /// Nearer, for factors below 1; it never arrives.
  void zoom(double factor);
};

}  // namespace limber

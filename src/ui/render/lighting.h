// Lighting: computes the shaders' uniform block of a frame from the appearance properties, the camera and the scene's
// bounds.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/output/render_scene.h"
#include "ui/render/camera.h"

namespace limber {

/// The uniform block `Frame` of shaders/common.glsl, with the same layout.
struct FrameBlock {
  glm::mat4 view_proj;
  glm::mat4 clip_to_world;
  glm::mat4 lamp_map;
  glm::mat4 ground_map;
  glm::vec4 eye;
  glm::vec4 lamp_at;
  glm::vec4 lamp_aim;
  glm::vec4 lamp_color;
  glm::vec4 sky;
  glm::vec4 ground;
  glm::vec4 rim;
  glm::vec4 horizon;
  glm::vec4 zenith;
  glm::vec4 floor_color;
  glm::vec4 grid;
  glm::vec4 tone;
  glm::vec4 soft;
};

/// Bounds of the scene (a sphere around nearly all of it), floor height and shadow map size.
struct SceneBounds {
  glm::vec3 center{0};
  float radius = 1;
  float floor_height = 0;
  int shadow_map_size = 1024;  ///< Side of the lamp's shadow map, pixels.
};

/// Inputs of all passes of one frame.
struct Lighting {
  FrameBlock frame;       ///< Uniforms of the main pass.
  glm::mat4 lamp_clip;    ///< World to clip space of the lamp's shadow map.
  glm::mat4 ground_clip;  ///< World to clip space of the ground map, a depth map of the space just above the floor.
  bool has_shadows = true;
  bool has_mirror = false;      ///< The floor is reflective.
  float floor_half_width = 10;  ///< Half the floor's width, m.
};
/// Computes the lighting of a frame. `far`: the camera's far plane, m. [any]
Lighting compute_lighting(const AppearanceView& appearance, const ViewCamera& camera, double far,
                          const SceneBounds& bounds);

}  // namespace limber

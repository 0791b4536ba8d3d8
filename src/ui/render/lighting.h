// Lighting: computes the shaders' uniform block of a frame from the appearance properties, the camera and the scene's
// bounds.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/output/render_scene.h"
#include "ui/render/camera.h"

namespace limber::render {

/// The uniform block `Frame` of shaders/common.glsl, with the same layout.
struct FrameUniforms {
  glm::mat4 view_proj;
  glm::mat4 clip_to_world;
  glm::mat4 shadow_map;
  glm::mat4 ground_map;
  glm::vec4 eye;              ///< w 1: mirror pass.
  glm::vec4 light_position;   ///< w 1: position of the light; w 0: direction to it.
  glm::vec4 light_direction;  ///< Direction in which it shines; w: cosine of the cone's outer angle.
  glm::vec4 light_color;      ///< w: cosine of the cone's inner angle.
  glm::vec4 sky;
  glm::vec4 ground;
  glm::vec4 rim;
  glm::vec4 horizon;
  glm::vec4 zenith;
  glm::vec4 floor_color;  ///< w: reflectivity.
  glm::vec4 grid;         ///< w: opacity.
  float exposure;
  float fog_density;  ///< 1/m
  float floor_height;
  float shadow_strength;
  glm::vec4 soft;  ///< Penumbra radius in shadow map units and in m, contact shadow radius in ground map units.
};

/// Bounds of the scene (a sphere around nearly all of it), floor height and shadow map size.
struct SceneBounds {
  glm::vec3 center{0};
  float radius = 1;
  float floor_height = 0;
  int shadow_map_size = 1024;  ///< Side of the shadow map, pixels.
};

/// Inputs of all passes of one frame.
struct Lighting {
  FrameUniforms frame;    ///< Uniforms of the main pass.
  glm::mat4 shadow_clip;  ///< World to clip space of the shadow map.
  glm::mat4 ground_clip;  ///< World to clip space of the ground map, a depth map of the space just above the floor.
  bool has_shadows = true;
  bool has_mirror = false;      ///< The floor is reflective.
  float floor_half_width = 10;  ///< Half the floor's width, m.
};
/// Computes the lighting of a frame. `far`: the camera's far plane, m. [any]
Lighting compute_lighting(const engine::AppearanceSettings& appearance, const CameraMatrices& camera, double far,
                          const SceneBounds& bounds);

}  // namespace limber::render

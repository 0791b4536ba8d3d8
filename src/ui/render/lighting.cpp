// The two styles (stage and studio), and the placement of light, maps and fog for a scene's size.
#include "ui/render/lighting.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/color.h"

namespace limber::render {

namespace {

struct Style {
  glm::vec3 to_light;
  glm::vec3 light_color;
  glm::vec3 sky;
  glm::vec3 ground;
  glm::vec3 rim;
  glm::vec3 background;  // sRGB, not tone mapped
  float zenith;          // brightness of the background straight above, relative to the horizon
  glm::vec3 floor;
  float mirror;
  glm::vec3 grid;  // linear, not tone mapped
  float grid_strength;
  float fog;  // 1/m
  bool spot;
};

const Style kStage = {{0.62F, 0.50F, 0.95F},
                      glm::vec3(1.0F, 0.90F, 0.78F) * 4.4F,
                      {0.20F, 0.23F, 0.31F},
                      {0.05F, 0.05F, 0.06F},
                      glm::vec3(0.30F, 0.52F, 1.0F) * 1.05F,
                      {0.033F, 0.0406F, 0.06F},
                      0.5F,
                      {0.0205F, 0.0210F, 0.0225F},
                      0.46F,
                      {0.10F, 0.19F, 0.42F},
                      0.30F,
                      0.030F,
                      true};
const Style kStudio = {{0.72F, -0.12F, 0.92F},
                       glm::vec3(1.0F, 0.96F, 0.89F) * 1.6F,
                       {0.30F, 0.35F, 0.44F},
                       {0.26F, 0.26F, 0.26F},
                       glm::vec3(0.9F, 0.95F, 1.0F) * 0.10F,
                       {0.890F, 0.895F, 0.903F},
                       0.90F,
                       {0.66F, 0.66F, 0.655F},
                       0.0F,
                       {0.45F, 0.48F, 0.52F},
                       0.22F,
                       0.026F,
                       false};

constexpr float kMinLitRadius = 0.6F;  // m, minimum radius of the scene for lighting

float as_float(double v) { return static_cast<float>(v); }

glm::vec3 linear(const glm::vec3& displayed) { return glm::pow(displayed, glm::vec3(2.2F)); }

glm::mat4 look_at_matrix(const glm::vec3& from, const glm::vec3& to) {
  const bool upright = std::abs(glm::normalize(to - from).z) > 0.99F;
  return glm::lookAt(from, to, upright ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1));
}

// clip space to texture coordinates and depth
const glm::mat4& to_map() {
  static const glm::mat4 matrix =
      glm::translate(glm::mat4(1), glm::vec3(0.5F)) * glm::scale(glm::mat4(1), glm::vec3(0.5F));
  return matrix;
}

// sets the light's position and cone, and the projection of its shadow map, which covers the lit area
void set_light(const Style& style, const SceneBounds& bounds, float radius, Lighting& out) {
  const glm::vec3 direction = glm::normalize(style.to_light);
  // aims below the scene's center, so that the floor is lit, too
  glm::vec3 target = bounds.center;
  target.z = glm::mix(bounds.floor_height, bounds.center.z, 0.5F);
  FrameUniforms& frame = out.frame;
  float map_width = 0;  // width of the map, m
  if (style.spot) {
    const float away = 3.2F * radius;
    const glm::vec3 from = target + direction * away;
    const float outer = std::atan(1.9F * radius / away);
    const float inner = std::atan(0.4F * radius / away);
    frame.light_position = glm::vec4(from, 1);
    frame.light_direction = glm::vec4(-direction, std::cos(outer));
    frame.light_color.w = std::cos(inner);
    map_width = 2 * away * std::tan(outer);
    out.shadow_clip = glm::perspective(2 * outer, 1.0F, 0.25F * away, away + 6 * radius) * look_at_matrix(from, target);
  } else {
    const float half = 2.4F * radius;
    frame.light_position = glm::vec4(direction, 0);
    // no cone: every direction is inside, since its cosine is at least -1
    frame.light_direction = glm::vec4(-direction, -2);
    frame.light_color.w = -1;
    map_width = 2 * half;
    out.shadow_clip = glm::ortho(-half, half, -half, half, 0.0F, 9 * radius) *
                      look_at_matrix(target + direction * 4.5F * radius, target);
  }
  frame.shadow_map = to_map() * out.shadow_clip;
  const float texels = 3.2F;
  frame.soft.x = texels / static_cast<float>(bounds.shadow_map_size);
  frame.soft.y = frame.soft.x * map_width;
}

// the ground map is an orthographic depth map, seen from below, of the layer just above the floor, which is 0.15 to
// 0.6 m thick
void set_ground_map(const SceneBounds& bounds, float radius, Lighting& out) {
  const float half = 1.6F * radius;
  const float range = std::clamp(0.25F * radius, 0.15F, 0.6F);
  glm::mat4 clip(1);
  clip[0][0] = 1 / half;
  clip[1][1] = 1 / half;
  clip[2][2] = 2 / range;
  clip[3] = glm::vec4(-bounds.center.x / half, -bounds.center.y / half, -1 - 2 * bounds.floor_height / range, 1);
  out.ground_clip = clip;
  out.frame.ground_map = to_map() * clip;
  out.frame.soft.z = 0.45F * range / (2 * half);
}

}  // namespace

Lighting compute_lighting(const engine::AppearanceSettings& appearance, const CameraMatrices& camera, double far,
                          const SceneBounds& bounds) {
  const Style& style = appearance.studio ? kStudio : kStage;
  Lighting out{};
  FrameUniforms& frame = out.frame;
  const float radius = std::max(bounds.radius, kMinLitRadius);
  frame.view_proj = camera.projection * camera.view;
  frame.clip_to_world = glm::inverse(frame.view_proj);
  frame.eye = glm::vec4(glm::vec3(camera.eye), 0);

  const glm::vec3 background =
      appearance.custom_background ? glm::vec3(rgb_of(appearance.background)) : style.background;
  frame.horizon = glm::vec4(linear(background), 1);
  frame.zenith = frame.horizon * style.zenith;
  // a user-defined background tints the ambient light and the floor
  glm::vec3 tint(1);
  if (appearance.custom_background) {
    const float bright = std::max({background.x, background.y, background.z, 1e-3F});
    tint = glm::mix(tint, linear(background / bright), 0.5F);
  }
  frame.sky = glm::vec4(style.sky * tint * as_float(appearance.ambient), 0);
  frame.ground = glm::vec4(style.ground * tint * as_float(appearance.ambient), 0);
  frame.rim = glm::vec4(style.rim * as_float(appearance.rim), 0);
  frame.light_color = glm::vec4(style.light_color * as_float(appearance.lamp), 0);
  set_light(style, bounds, radius, out);
  set_ground_map(bounds, radius, out);
  out.has_shadows = appearance.shadow > 0 && appearance.lamp > 0;

  const float mirror = std::min(style.mirror * as_float(appearance.mirror), 0.95F);
  const bool above = camera.eye.z > bounds.floor_height;
  out.has_mirror = mirror > 0 && above && appearance.floor;
  frame.floor_color = glm::vec4(style.floor * tint, out.has_mirror ? mirror : 0);
  frame.grid = glm::vec4(style.grid, std::min(style.grid_strength * as_float(appearance.grid), 1.0F));
  // large scenes seen from afar get thinner fog; but it always hides the far plane
  const float view_distance = as_float(glm::distance(camera.eye, Vec3(bounds.center))) + radius;
  const float fog = style.fog * as_float(appearance.fog) / std::max(1.0F, view_distance / 14);
  const float min_fog = as_float(2.6 / std::max(far, 1e-3));
  frame.exposure = as_float(appearance.exposure);
  frame.fog_density = std::max(fog, min_fog);
  frame.floor_height = bounds.floor_height;
  frame.shadow_strength = as_float(appearance.shadow);
  out.floor_half_width = 3.0F / frame.fog_density;
  return out;
}

}  // namespace limber::render

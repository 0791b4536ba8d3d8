// The two styles, and where lamp, maps and fog go for a scene of that size.
#include "view/lighting.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/color.h"

namespace limber {

namespace {

struct Style {
  glm::vec3 lamp_way;  // towards it
  glm::vec3 lamp_color;
  glm::vec3 sky;
  glm::vec3 ground;
  glm::vec3 rim;
  glm::vec3 background;  // as it is shown, sRGB
  float zenith;          // the background straight above, as a part of that at the horizon
  glm::vec3 floor;
  float mirror;
  glm::vec3 grid;  // as it is shown, linear
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

constexpr float kSmallest = 0.6F;  // m: a scene is lit as if it were at least as large

float as_float(double v) { return static_cast<float>(v); }

glm::vec3 linear(const glm::vec3& shown) { return glm::pow(shown, glm::vec3(2.2F)); }

glm::mat4 looking(const glm::vec3& from, const glm::vec3& to) {
  const bool upright = std::abs(glm::normalize(to - from).z) > 0.99F;
  return glm::lookAt(from, to, upright ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1));
}

// clip space to a map's place and depth
const glm::mat4& to_map() {
  static const glm::mat4 matrix =
      glm::translate(glm::mat4(1), glm::vec3(0.5F)) * glm::scale(glm::mat4(1), glm::vec3(0.5F));
  return matrix;
}

// the lamp, its cone, and its map over all that it reaches
void place_lamp(const Style& style, const Stand& stand, float radius, Lighting& out) {
  const glm::vec3 way = glm::normalize(style.lamp_way);
  // it aims below the middle: the floor belongs to the picture
  glm::vec3 aim = stand.center;
  aim.z = glm::mix(stand.floor, stand.center.z, 0.5F);
  FrameBlock& frame = out.frame;
  float metres = 0;  // that the map is wide
  if (style.spot) {
    const float away = 3.2F * radius;
    const glm::vec3 from = aim + way * away;
    const float outer = std::atan(1.9F * radius / away);
    const float inner = std::atan(0.4F * radius / away);
    frame.lamp_at = glm::vec4(from, 1);
    frame.lamp_aim = glm::vec4(-way, std::cos(outer));
    frame.lamp_color.w = std::cos(inner);
    metres = 2 * away * std::tan(outer);
    out.lamp_clip = glm::perspective(2 * outer, 1.0F, 0.25F * away, away + 6 * radius) * looking(from, aim);
  } else {
    const float half = 2.4F * radius;
    frame.lamp_at = glm::vec4(way, 0);
    frame.lamp_aim = glm::vec4(-way, -2);
    frame.lamp_color.w = -1;
    metres = 2 * half;
    out.lamp_clip = glm::ortho(-half, half, -half, half, 0.0F, 9 * radius) * looking(aim + way * 4.5F * radius, aim);
  }
  frame.lamp_map = to_map() * out.lamp_clip;
  const float texels = 3.2F;
  frame.soft.x = texels / static_cast<float>(stand.map);
  frame.soft.y = frame.soft.x * metres;
}

// seen from below: what stands up to a hand's or an arm's length above the floor
void place_ground_map(const Stand& stand, float radius, Lighting& out) {
  const float half = 1.6F * radius;
  const float range = std::clamp(0.25F * radius, 0.15F, 0.6F);
  glm::mat4 clip(1);
  clip[0][0] = 1 / half;
  clip[1][1] = 1 / half;
  clip[2][2] = 2 / range;
  clip[3] = glm::vec4(-stand.center.x / half, -stand.center.y / half, -1 - 2 * stand.floor / range, 1);
  out.ground_clip = clip;
  out.frame.ground_map = to_map() * clip;
  out.frame.soft.z = 0.45F * range / (2 * half);
}

}  // namespace

Lighting light(const LookView& look, const Lens& lens, double far, const Stand& stand) {
  const Style& style = look.studio ? kStudio : kStage;
  Lighting out{};
  FrameBlock& frame = out.frame;
  const float radius = std::max(stand.radius, kSmallest);
  frame.view_proj = lens.projection * lens.view;
  frame.clip_to_world = glm::inverse(frame.view_proj);
  frame.eye = glm::vec4(glm::vec3(lens.eye), 0);

  const glm::vec3 shown = look.own_background ? glm::vec3(rgb_of(look.background)) : style.background;
  frame.horizon = glm::vec4(linear(shown), 1);
  frame.zenith = frame.horizon * style.zenith;
  // a background of one's own tints what comes from everywhere, and the floor
  glm::vec3 tint(1);
  if (look.own_background) {
    const float bright = std::max({shown.x, shown.y, shown.z, 1e-3F});
    tint = glm::mix(tint, linear(shown / bright), 0.5F);
  }
  frame.sky = glm::vec4(style.sky * tint * as_float(look.ambient), 0);
  frame.ground = glm::vec4(style.ground * tint * as_float(look.ambient), 0);
  frame.rim = glm::vec4(style.rim * as_float(look.rim), 0);
  frame.lamp_color = glm::vec4(style.lamp_color * as_float(look.lamp), 0);
  place_lamp(style, stand, radius, out);
  place_ground_map(stand, radius, out);
  out.casts = look.shadow > 0 && look.lamp > 0;

  const float mirror = std::min(style.mirror * as_float(look.mirror), 0.95F);
  const bool above = lens.eye.z > stand.floor;
  out.mirrors = mirror > 0 && above && look.floor;
  frame.floor_color = glm::vec4(style.floor * tint, out.mirrors ? mirror : 0);
  frame.grid = glm::vec4(style.grid, std::min(style.grid_strength * as_float(look.grid), 1.0F));
  // a large scene, seen from far, has thinner fog; but what is no longer drawn is always in it
  const float reach = as_float(glm::distance(lens.eye, Vec3(stand.center))) + radius;
  const float fog = style.fog * as_float(look.fog) / std::max(1.0F, reach / 14);
  const float hidden = as_float(2.6 / std::max(far, 1e-3));
  frame.tone = glm::vec4(as_float(look.exposure), std::max(fog, hidden), stand.floor, as_float(look.shadow));
  out.floor_reach = 3.0F / frame.tone.y;
  return out;
}

}  // namespace limber

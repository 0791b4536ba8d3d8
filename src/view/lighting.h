// Lighting: what a look's rows and the scene's size make of one pass's numbers, as the shaders read them.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/drawing.h"
#include "view/lens.h"

namespace limber {

/// The block `Frame` of shaders/common.glsl, number for number.
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

/// What stands there: a ball in which nearly all of it is, and the floor's height.
struct Stand {
  glm::vec3 center{0};
  float radius = 1;
  float floor = 0;
  int map = 1024;  ///< Pixels of the lamp's map, a side.
};

struct Lighting {
  FrameBlock frame;        ///< Of the picture itself.
  glm::mat4 lamp_clip;     ///< World to the lamp's map, as it is drawn.
  glm::mat4 ground_clip;   ///< The same of what stands just above the floor.
  bool casts = true;       ///< There is any shadow.
  bool mirrors = false;    ///< The floor does.
  float floor_reach = 10;  ///< Half the floor's width, m.
};
Lighting light(const LookView& look, const Lens& lens, double far, const Stand& stand);

}  // namespace limber

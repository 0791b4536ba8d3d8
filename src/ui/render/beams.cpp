// Beams: cones with a brightness that decreases with the distance from its origin.
#include "ui/render/beams.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/color.h"

namespace limber::render {

namespace {

constexpr int kBeamSides = 40;
constexpr double kBeamStartRadius = 0.04;  // m
constexpr double kMinBeamLight = 1e-3;
// Distances from its origin, m, and the brightness there.
struct BeamRing {
  double distance, brightness;
};
constexpr std::array<BeamRing, 6> kBeamRings = {{{0, 0.5}, {0.5, 0.4}, {2, 0.24}, {5, 0.12}, {9, 0.05}, {15, 0}}};

engine::Beam interpolate_beam(const engine::Beam& previous, const engine::Beam& current, double mix) {
  engine::Beam beam;
  beam.origin = glm::mix(previous.origin, current.origin, mix);
  const Vec3 direction = normalized(glm::mix(previous.direction, current.direction, mix));
  beam.direction = direction == Vec3(0) ? current.direction : direction;
  beam.light = glm::mix(previous.light, current.light, mix);
  beam.angle = glm::mix(previous.angle, current.angle, mix);
  return beam;
}

void set_vector(float* to, const Vec3& v, double last) {
  for (int i = 0; i < 3; i++) to[i] = static_cast<float>(v[i]);
  to[3] = static_cast<float>(last);
}

}  // namespace

void add_beam(const engine::Beam& beam, std::vector<BeamVertex>& triangles) {
  if (std::max({beam.light.x, beam.light.y, beam.light.z}) < kMinBeamLight) return;
  if (!is_finite(beam.origin) || !is_finite(beam.direction)) return;
  const Vec3 any = std::abs(beam.direction.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 side = glm::normalize(glm::cross(beam.direction, any));
  const Vec3 up = glm::cross(beam.direction, side);
  const Vec3 light(linear_light_of(std::min(beam.light.x, 1.0)), linear_light_of(std::min(beam.light.y, 1.0)),
                   linear_light_of(std::min(beam.light.z, 1.0)));
  const double slope = std::tan(std::clamp(beam.angle / 2, 0.001, 1.5));
  const auto vertex = [&](const BeamRing& ring, int i) {
    const double angle = 2 * kPi * i / kBeamSides;
    const Vec3 out = side * std::cos(angle) + up * std::sin(angle);
    BeamVertex v{};
    set_vector(v.corner,
               beam.origin + beam.direction * ring.distance + out * (kBeamStartRadius + slope * ring.distance),
               ring.brightness);
    set_vector(v.normal, glm::normalize(out - beam.direction * slope), 0);
    set_vector(v.light, light, 0);
    return v;
  };
  for (std::size_t r = 1; r < kBeamRings.size(); r++) {
    for (int i = 0; i < kBeamSides; i++) {
      const BeamVertex a = vertex(kBeamRings[r - 1], i);
      const BeamVertex b = vertex(kBeamRings[r - 1], i + 1);
      const BeamVertex c = vertex(kBeamRings[r], i);
      const BeamVertex d = vertex(kBeamRings[r], i + 1);
      triangles.insert(triangles.end(), {a, b, c, c, b, d});
    }
  }
}

void Beams::draw(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, Shaders& shaders) {
  triangles_.clear();
  const bool interpolates =
      mix < 1 && previous.render_scene == current.render_scene && previous.transient.size() == current.transient.size();
  for (const engine::RenderBeam& each : current.render_scene->beams) {
    engine::Beam beam = engine::beam_of(current, each);
    if (interpolates) beam = interpolate_beam(engine::beam_of(previous, each), beam, mix);
    add_beam(beam, triangles_);
  }
  if (triangles_.empty()) return;
  glBindVertexArray(*array_);
  glBindBuffer(GL_ARRAY_BUFFER, *buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles_.size() * sizeof(BeamVertex)), triangles_.data(),
               GL_STREAM_DRAW);
  constexpr std::array<std::size_t, 3> kOffsets = {offsetof(BeamVertex, corner), offsetof(BeamVertex, normal),
                                                   offsetof(BeamVertex, light)};
  for (GLuint i = 0; i < kOffsets.size(); i++) {
    glEnableVertexAttribArray(i);
    // OpenGL takes offsets in a buffer as pointers: NOLINTNEXTLINE(performance-no-int-to-ptr)
    glVertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, sizeof(BeamVertex), reinterpret_cast<const void*>(kOffsets[i]));
  }
  glUseProgram(shaders.program("beam"));
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(triangles_.size()));
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
}

}  // namespace limber::render

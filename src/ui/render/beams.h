// Beams: the light of fixtures, drawn as translucent cones and added to the image.
#pragma once

#include <vector>

#include "engine/output/snapshot.h"
#include "ui/render/gl.h"
#include "ui/render/shaders.h"

namespace limber::render {

/// A corner of a cone, in the layout of shaders/beam.vert.
struct BeamVertex {
  float corner[4];  ///< Position, and the brightness at this distance from its origin.
  float normal[4];
  float light[4];  ///< Linear.
};

/// Appends the triangles of the cone of a beam; none if it is dark.
void add_beam(const engine::Beam& beam, std::vector<BeamVertex>& triangles);

/// [main]
class Beams {
 public:
  Beams() : buffer_(GlBuffer::make()), array_(GlVertexArray::make()) {}
  /// Draws the beams, interpolated between two snapshots of the same scene. The uniforms of the frame must be bound.
  void draw(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, Shaders& shaders);

 private:
  std::vector<BeamVertex> triangles_;
  GlBuffer buffer_;
  GlVertexArray array_;
};

}  // namespace limber::render

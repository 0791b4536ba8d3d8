// OverlayLines: the lines of the debug overlay, interpolated between two snapshots.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/output/snapshot.h"

namespace limber::render {

/// One line, in the layout of shaders/overlay.vert.
struct OverlayLine {
  float from[3];
  float width;  ///< Pixels.
  float to[3];
  float unused;
  float color[4];  ///< Linear.
};

/// [main]
class OverlayLines {
 public:
  /// Rebuilds the lines. `mix`: interpolation from 0 (`previous`) to 1 (`current`); marks that are only in `current`
  /// are not interpolated. `pixels`: width of a symbol's lines. Allocates only when it grows. [main]
  void update(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, double pixels);
  std::span<const OverlayLine> lines() const { return lines_; }

 private:
  void draw(const sim::OverlayMark& mark);
  void hinge(const sim::OverlayMark& mark);
  void slider(const sim::OverlayMark& mark);
  void arrow(const Vec3& from, const Vec3& vector, double head);
  void cross(const Vec3& at, const Quat& rotation, double half);
  void arc(const Vec3& at, const Vec3& x, const Vec3& y, double low, double high);
  void line(const Vec3& from, const Vec3& to, double width = 1);

  std::vector<OverlayLine> lines_;
  glm::vec3 color_{1};
  double width_ = 1;
};

}  // namespace limber::render

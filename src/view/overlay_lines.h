// OverlayLines: the debug picture as lines: what stands in two snapshots' overlays, moved in between.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/snapshot.h"

namespace limber {

/// As the shader reads it.
struct OverlayLine {
  float from[3];
  float width;  ///< Pixels.
  float to[3];
  float unused;
  float paint[4];  ///< Linear.
};

class OverlayLines {
 public:
  /// `mix`: 0 is `before`, 1 is `now`; marks that are only in `now` stand as they are there. Allocates only while it
  /// grows. `pixels`: what a symbol's line is wide. [main]
  void gather(const Snapshot& before, const Snapshot& now, double mix, double pixels);
  std::span<const OverlayLine> lines() const { return lines_; }

 private:
  void draw(const OverlayMark& mark);
  void turn(const OverlayMark& mark);
  void shift(const OverlayMark& mark);
  void arrow(const Vec3& from, const Vec3& way, double head);
  void cross(const Vec3& at, const Quat& turn, double half);
  void arc(const Vec3& at, const Vec3& x, const Vec3& y, double low, double high);
  void line(const Vec3& from, const Vec3& to, double wide = 1);

  std::vector<OverlayLine> lines_;
  glm::vec3 paint_{1};
  double width_ = 1;
};

}  // namespace limber

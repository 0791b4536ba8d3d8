// Drawing: what a picture needs beside poses: who is drawn with which form, and the numbers of materials, camera and
// look as a snapshot carries them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber {

struct Snapshot;
class World;

/// A geometry and its material; shared by all pieces that look alike.
struct DrawnForm {
  ShapeModel shape;
  std::uint32_t material = 0;  ///< For material_of().
};

/// One form on one part.
struct DrawnPiece {
  std::uint32_t part_at = 0;     ///< Where the part's block begins in Snapshot::live.
  std::uint32_t enabled_at = 0;  ///< Where its body's `enabled` (1 or 0) stands there.
  std::uint32_t form = 0;
  Pose origin;  ///< In the part's link frame.
};

/// Made anew only when bodies or shapes come, go or change; shared by all snapshots in between.
struct Drawing {
  explicit Drawing(const World& world);  ///< [sim]

  std::vector<DrawnForm> forms;
  std::vector<DrawnPiece> pieces;

  /// Copies what snapshots carry as `visuals`. Allocates only while that grows. [sim]
  void copy_visuals(std::span<const double> kept, std::vector<double>& to) const;

 private:
  struct Block {
    std::uint32_t at = 0;  // in the kept block
    std::uint32_t width = 0;
  };
  std::vector<Block> blocks_;  // visuals, camera, look, then materials
};

/// What shapes of a form are painted with; colours as hue, saturation, brightness.
struct Material {
  double transparency = 0;
  double ambient_scale = 0;
  double diffuse_scale = 0;
  double specular_scale = 0;
  double specular_pow = 0;
  Vec3 ambient_color{0};
  Vec3 diffuse_color{0};
};
Material material_of(const Snapshot& snapshot, std::uint32_t material);

/// The view is T(position)·Rx·Ry·Rz, in degrees.
struct CameraView {
  Vec3 position{0};
  Vec3 rotation{0};
  double fovy = 40;
  double aspect = 0;  ///< 0: the picture's.
  double near = 0.05;
  double far = 200;
  double distance = 1;
};
CameraView camera_of(const Snapshot& snapshot);

/// The rows of /visuals/look, and the background.
struct LookView {
  bool studio = false;
  double exposure = 1;
  double ambient = 1;
  double lamp = 1;
  double rim = 1;
  double shadow = 1;
  double fog = 1;
  double grid = 1;
  double mirror = 1;
  bool floor = true;
  Vec3 background{0};           ///< Hue, saturation, brightness.
  bool own_background = false;  ///< It is not the default, which stands for the style's own.
};
LookView look_of(const Snapshot& snapshot);

}  // namespace limber

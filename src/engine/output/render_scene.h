// RenderScene: the data that a renderer needs besides poses: render shapes and their instances on parts, and the
// properties of materials, camera and appearance in a snapshot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::sim {
class World;
}  // namespace limber::sim

namespace limber::engine {

struct Snapshot;

/// A geometry and its material, shared by its instances.
struct RenderShape {
  model::ShapeModel geometry;
  std::uint32_t material = 0;  ///< For material_of().
};

/// An instance of a render shape on a part.
struct RenderInstance {
  std::uint32_t part_offset = 0;     ///< Index of the part's block in Snapshot::transient.
  std::uint32_t enabled_offset = 0;  ///< Index of its body's `enabled` (1 or 0) in Snapshot::transient.
  std::uint32_t shape = 0;
  Pose origin;             ///< In the part's link frame.
  std::uint32_t tint = 0;  ///< For tint_of().
};

/// A tendon, drawn as a line through its points.
struct RenderTendon {
  struct Point {
    std::uint32_t part_offset = 0;  ///< Index of the part's block in Snapshot::transient.
    Vec3 position{0};               ///< In the part's link frame.
  };
  std::vector<Point> points;
  std::uint32_t enabled_offset = 0;  ///< Index of its body's `enabled` (1 or 0) in Snapshot::transient.
  std::uint32_t force_offset = 0;    ///< Index of its `force` there, N.
  std::uint32_t radius = 0;          ///< For radius_of().
};

/// The beam of a lighting fixture, drawn as a translucent cone.
struct RenderBeam {
  std::uint32_t offset = 0;  ///< Index of the fixture's block in Snapshot::transient; for beam_of().
};

/// Rebuilt only when bodies or shapes are added, removed or changed; shared by the snapshots in between.
struct RenderScene {
  explicit RenderScene(const sim::World& world);  ///< [sim]

  std::vector<RenderShape> shapes;
  std::vector<RenderInstance> instances;
  std::vector<RenderTendon> tendons;
  std::vector<RenderBeam> beams;

  /// Copies the persistent values of visuals, camera, look, materials, tints and radii of tendons to Snapshot::visuals.
  /// Allocates only if they have grown. [sim]
  void copy_visuals(std::span<const double> persistent, std::vector<double>& to) const;

 private:
  struct Block {
    std::uint32_t offset = 0;  // index in the persistent values
    std::uint32_t width = 0;
  };
  void add_tendons(const sim::World& world, std::uint32_t offset);

  std::vector<Block> blocks_;  // visuals, camera, look, materials, the tints of parts, then the radii of tendons
};

/// A material. Colors are hue, saturation, brightness.
struct Material {
  double transparency = 0;
  double ambient_scale = 0;
  double diffuse_scale = 0;
  double specular_scale = 0;
  double specular_pow = 0;
  Vec3 ambient_color{0};  ///< The diffuse color if the property has its default.
  Vec3 diffuse_color{0};
};
Material material_of(const Snapshot& snapshot, std::uint32_t material);

/// The tint of a part.
struct Tint {
  Vec3 color{1};  ///< Red, green, blue; multiplies the colors of the part's shapes.
  double transparency = 0;
};
Tint tint_of(const Snapshot& snapshot, const RenderInstance& instance);

/// Radius of a tendon, m.
double radius_of(const Snapshot& snapshot, const RenderTendon& tendon);

/// A beam of light.
struct Beam {
  Vec3 origin{0};           ///< Where it begins, world, m.
  Vec3 direction{0, 0, 1};  ///< Unit vector, world.
  Vec3 light{0};            ///< Red, green, blue.
  double angle = 0;         ///< Full angle of its cone, rad.
};
Beam beam_of(const Snapshot& snapshot, const RenderBeam& beam);

/// The camera. The view matrix is T(position)·Rx·Ry·Rz, with rotations in degrees.
struct CameraSettings {
  Vec3 position{0};
  Vec3 rotation{0};
  double fovy = 40;
  double aspect = 0;  ///< 0: of the render target.
  double near = 0.05;
  double far = 200;
  double distance = 1;
};
CameraSettings camera_of(const Snapshot& snapshot);

/// The properties of /visuals/look, and the background.
struct AppearanceSettings {
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
  Vec3 background{0};              ///< Hue, saturation, brightness.
  bool custom_background = false;  ///< `background` was set; else the style's own background is used.
};
AppearanceSettings appearance_of(const Snapshot& snapshot);

}  // namespace limber::engine

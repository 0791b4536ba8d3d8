// DrawList: instances to draw, interpolated between two snapshots and batched by mesh and level of detail, and the
// bounds of the scene.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/output/snapshot.h"
#include "ui/render/mesh.h"

namespace limber::render {

/// Per-instance vertex attributes, in the layout of shaders/shape.vert.
struct Instance {
  float position[3];
  float rounding_radius;
  float rotation[4];  // x y z w
  float extent[3];
  float specular;
  float diffuse[3];  // linear, scaled
  float alpha;
  float ambient[3];
  float specular_exponent;
};

/// Identifies a mesh: a primitive's, or one from a file (`model` is set), or a part of one that isn't plain.
struct MeshKey {
  model::ShapeKind kind = model::ShapeKind::box;
  const model::MeshModel* model = nullptr;
  MeshColoring coloring = MeshColoring::plain;
  std::uint32_t part = 0;  ///< Index of mesh_parts().
  const model::Image* texture = nullptr;
  // NOLINTNEXTLINE(modernize-use-nullptr): reported for the comparison that the compiler generates
  auto operator<=>(const MeshKey&) const = default;
};

/// Consecutive instances of one mesh and level of detail, for one draw call.
struct Batch {
  MeshKey mesh;
  int detail = 0;  ///< Level of detail; 0 is the finest.
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool casts_shadow = true;  ///< False for instances with an alpha below 0.5.
};

/// An infinite plane of the scene.
struct RenderPlane {
  glm::vec3 origin;
  glm::vec3 normal;
  glm::vec3 tint;  ///< Linear.
  float alpha = 1;
};

/// The camera, for choosing levels of detail and sorting transparent instances.
struct DrawCamera {
  Vec3 position{0};
  Vec3 forward{0, 1, 0};
  double focal_pixels = 1000;  ///< Focal length in pixels: size of 1 m at a distance of 1 m.
  int detail_bias = 0;         ///< Number of finest levels of detail to skip.
};

/// [main]
class DrawList {
 public:
  /// Rebuilds the lists. `mix`: interpolation from 0 (`previous`) to 1 (`current`). Snapshots of different scenes are
  /// not interpolated: then only `current` is used. [main]
  void update(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, const DrawCamera& camera);

  const std::vector<Instance>& instances() const { return instances_; }
  const std::vector<Batch>& opaque() const { return opaque_; }
  /// Transparent batches, farthest first.
  const std::vector<Batch>& transparent() const { return transparent_; }
  const std::vector<RenderPlane>& planes() const { return planes_; }
  /// Center and radius of a sphere around nearly all instances; robust against a few stray bodies.
  const glm::vec3& center() const { return center_; }
  float radius() const { return radius_; }
  /// The scene of the last update(); null before the first.
  const std::shared_ptr<const engine::RenderScene>& scene() const { return scene_; }
  /// The meshes from files that the scene uses.
  const std::map<const model::MeshModel*, std::shared_ptr<const model::MeshModel>>& models() const { return models_; }
  /// The images that the scene uses as textures.
  const std::map<const model::Image*, std::shared_ptr<const model::Image>>& images() const { return images_; }

 private:
  struct InstanceSize {
    float extent[3];
    float rounding_radius;
  };
  struct InstanceMaterial {
    float specular, specular_exponent, alpha;
    float diffuse[3], ambient[3];
  };
  // a render shape, or a part of one that isn't plain
  struct ShapeDraw {
    MeshKey mesh;
    std::uint32_t mesh_index = 0;
    bool first_part = true;
    float alpha = 1;  // of the part's materials
    InstanceSize size;
    double bounding_radius = 0;  // m
    Pose offset;                 // pose of the mesh in the shape's frame
    std::uint32_t material = 0;
    Vec3 normal{0, 0, 1};  // planes only
  };
  struct VisibleInstance {
    Instance instance{};
    std::uint32_t key = 0;  // mesh_index * kDetailLevels + detail
    float depth = 0;
  };
  static InstanceMaterial instance_material(const engine::Material& m);
  void rebuild_shapes(const engine::Snapshot& current);
  void update_materials(const engine::Snapshot& current);
  void update_tints(const engine::Snapshot& current);
  void add_instance(const ShapeDraw& shape, const Pose& pose, const float* tint, const DrawCamera& camera);
  void add_tendon(const engine::RenderTendon& tendon, const engine::Snapshot& current, const DrawCamera& camera);
  void compute_bounds();
  void sort_opaque();
  void sort_transparent();
  void add_in_order(std::vector<Batch>& batches, const std::vector<VisibleInstance>& visible);
  void build_batches();

  std::shared_ptr<const engine::RenderScene> scene_;
  std::uint64_t materials_version_ = 0;
  std::vector<MeshKey> meshes_;  // by mesh number
  std::vector<ShapeDraw> shapes_;
  std::vector<std::uint32_t> first_part_;  // by render shape: index of its first part in shapes_; one more at the end
  ShapeDraw tendon_shape_;                 // a cylinder
  std::vector<Vec3> tendon_points_;        // scratch: of one tendon, world
  std::vector<InstanceMaterial> materials_;
  std::map<const model::MeshModel*, std::shared_ptr<const model::MeshModel>> models_;
  std::map<const model::Image*, std::shared_ptr<const model::Image>> images_;
  std::vector<float> tints_;  // by instance: linear red, green and blue, and alpha
  std::vector<VisibleInstance> opaque_instances_, transparent_instances_;
  std::vector<std::uint32_t> first_, order_;  // scratch
  std::vector<glm::vec3> positions_;
  std::vector<float> radii_, scratch_numbers_;
  std::vector<Instance> instances_;
  std::vector<Batch> opaque_, transparent_;
  std::vector<RenderPlane> planes_;
  glm::vec3 center_{0};
  float radius_ = 1;
};

}  // namespace limber::render

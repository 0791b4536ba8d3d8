// DrawList: what is drawn of two snapshots: an instance for each piece that is to be seen, moved in between, put
// together by mesh; and where the bodies are.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/snapshot.h"
#include "view/mesh.h"

namespace limber {

/// As the shader reads it.
struct Instance {
  float place[3];
  float round;
  float turn[4];  // x y z w
  float extent[3];
  float specular;
  float diffuse[3];  // linear, scaled
  float alpha;
  float ambient[3];
  float power;
};

/// A primitive's mesh, or a file's.
struct MeshKey {
  ShapeKind kind = ShapeKind::box;
  const MeshModel* model = nullptr;
  // NOLINTNEXTLINE(modernize-use-nullptr): seen in the comparison that the compiler writes
  auto operator<=>(const MeshKey&) const = default;
};

/// Instances of one mesh and one level of detail, one behind the other.
struct Batch {
  MeshKey mesh;
  int detail = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool casts = true;  ///< A shadow: glass does not.
};

/// An endless plane of the scene.
struct PlaneView {
  glm::vec3 origin;
  glm::vec3 normal;
  glm::vec3 tint;  ///< Linear.
  float alpha = 1;
};

/// Where it is seen from: what decides on details and on the order of what shines through.
struct DrawEye {
  Vec3 at{0};
  Vec3 forward{0, 1, 0};
  double pixels = 1000;  ///< What a metre takes at a metre's distance.
  int coarser = 0;       ///< Levels of detail that are left out.
};

class DrawList {
 public:
  /// `mix`: 0 is `before`, 1 is `now`. Snapshots of two drawings don't mix: `now` alone counts. [main]
  void gather(const Snapshot& before, const Snapshot& now, double mix, const DrawEye& eye);

  const std::vector<Instance>& instances() const { return instances_; }
  const std::vector<Batch>& opaque() const { return opaque_; }
  /// What shines through, furthest first.
  const std::vector<Batch>& clear() const { return clear_; }
  const std::vector<PlaneView>& planes() const { return planes_; }
  /// A ball in which nearly all of it stands; stray bodies don't count.
  const glm::vec3& center() const { return center_; }
  float radius() const { return radius_; }
  /// What it was made for last; null before.
  const std::shared_ptr<const Drawing>& drawing() const { return drawing_; }
  /// The meshes of files.
  const std::map<const MeshModel*, std::shared_ptr<const MeshModel>>& models() const { return models_; }

 private:
  struct Form {
    MeshKey mesh;
    std::uint32_t mesh_number = 0;
    Instance size{};   // its size alone
    double reach = 0;  // radius of a ball around it, m
    Pose offset;       // of the mesh
    std::uint32_t material = 0;
    Vec3 normal{0, 0, 1};  // of a plane
  };
  struct Seen {
    Instance instance{};
    std::uint32_t key = 0;  // mesh and detail
    float depth = 0;
  };
  void learn(const Snapshot& now);
  void paint(const Snapshot& now);
  void see(const Form& form, const Pose& pose, const DrawEye& eye);
  void measure();
  void order_solid();
  void order_glassy();
  void add_in_order(std::vector<Batch>& batches, const std::vector<Seen>& seen);
  void put_together();

  std::shared_ptr<const Drawing> drawing_;
  std::uint64_t painted_ = 0;
  std::vector<MeshKey> meshes_;  // by their number in Seen::key
  std::vector<Form> forms_;
  std::vector<Instance> paints_;  // by material: its colours alone
  std::map<const MeshModel*, std::shared_ptr<const MeshModel>> models_;
  std::vector<Seen> solid_, glassy_;
  std::vector<std::uint32_t> first_, order_;  // scratch
  std::vector<glm::vec3> places_;
  std::vector<float> reaches_, numbers_;
  std::vector<Instance> instances_;
  std::vector<Batch> opaque_, clear_;
  std::vector<PlaneView> planes_;
  glm::vec3 center_{0};
  float radius_ = 1;
};

}  // namespace limber

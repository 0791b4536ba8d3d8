// MjcfFileReader: reads the sections of an MJCF file in MuJoCo's order. Internal to the module: only src/model includes
// it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/mjcf/document.h"
#include "model/mjcf/file.h"
#include "model/mjcf/heightfields.h"
#include "model/mjcf/reader.h"
#include "model/mjcf/spatial_tendons.h"

namespace limber::model {

inline constexpr std::size_t kMaxMjcfBodies = 10'000;

/// Path of a file that an asset names, relative to the model's folder. [any]
std::string mjcf_asset_path(const MjcfCompiler& compiler, const std::string& folder, const std::string& file);

class MjcfFileReader {
 public:
  MjcfFileReader(const MjcfDocument& document, MjcfReader& reader) : document_(document), reader_(reader) {}

  /// `fallback_name` is the model's name if the file has none. The error starts with a line number and a colon.
  Result<MjcfFile> run(const std::string& fallback_name);

 private:
  struct MeshAsset {
    const MjcfElement* element = nullptr;
    std::string uri;                        // empty: `mesh`
    std::shared_ptr<const MeshModel> mesh;  // of vertices in the file; null: in a file, or invalid
    Vec3 scale{1, 1, 1};
    Pose reference;  // of the shape's frame in that of the scaled mesh
  };
  struct Site {
    int body = 0;
    MjcfSite site;
  };
  struct TendonJoint {
    MjcfJoint* joint = nullptr;
    double factor = 1;
  };
  struct Material {
    std::optional<Vec3> color;
    double alpha = 1;
    std::string texture;  // its name; empty: none
  };

  // file_reader.cpp
  void read_compiler(const MjcfElement& element);
  void read_mass_settings(const MjcfElement& element);
  void read_body(const MjcfElement& element, int parent, MjcfClass inherited, const Pose& frame);
  void read_content(const MjcfElement& element, int body, MjcfClass inherited, const Pose& frame);
  void report_unknown(const MjcfElement& element, const MjcfElement& parent);
  void read_site(const MjcfElement& element, int body, MjcfClass inherited, const Pose& frame);
  void read_inertial(const MjcfElement& element, MjcfBody& body, const Pose& frame);
  bool read_tensor(const MjcfElement& element, UrdfInertial& out);
  // joints.cpp
  void read_joint(const MjcfElement& element, MjcfBody& body, MjcfClass inherited, const Pose& frame);
  void read_limits(const MjcfElement& element, MjcfClass cls, MjcfJoint& joint);
  void read_spring(const MjcfElement& element, MjcfClass cls, double stiffness, MjcfJoint& joint);
  void read_passive_forces(const MjcfElement& element, MjcfClass cls, MjcfJoint& joint);
  // geoms.cpp
  void read_geom(const MjcfElement& element, MjcfBody& body, MjcfClass inherited, const Pose& frame);
  bool read_shape(const MjcfElement& element, MjcfClass cls, const Pose& frame, MjcfGeom& geom);
  bool read_size(const MjcfElement& element, MjcfClass cls, std::string_view type, const Pose& frame, MjcfGeom& geom);
  bool read_from_to(const MjcfElement& element, MjcfClass cls, std::string_view type, const Pose& frame,
                    MjcfGeom& geom);
  bool set_mesh(const MjcfElement& element, const std::string& mesh, MjcfGeom& geom);
  void read_color(const MjcfElement& element, MjcfClass cls, MjcfGeom& geom);
  // assets.cpp
  void read_assets(const MjcfElement& element);
  void read_mesh(const MjcfElement& element);
  void read_inline_mesh(const MjcfElement& element, MjcfClass cls, MeshAsset& asset);
  void read_material(const MjcfElement& element);
  void read_texture(const MjcfElement& element);
  // relations.cpp
  void read_actuator(const MjcfElement& element);
  void limit_joint(const MjcfElement& element, MjcfClass cls, double lever, MjcfJoint& joint);
  void read_contacts(const MjcfElement& section);
  // tendons.cpp
  void read_tendons(const MjcfElement& section);
  void read_fixed_tendon(const MjcfElement& element);
  // equality.cpp
  void read_equality(const MjcfElement& element);
  void read_loop(const MjcfElement& element, MjcfClass cls);
  void set_weld(const MjcfElement& element, MjcfClass cls, const Vec3& anchor, MjcfLoop& loop);
  void couple_joints(const MjcfElement& element, MjcfClass cls);
  void couple_tendon(const MjcfElement& element, MjcfClass cls);
  const Site* site_named(const MjcfElement& element, const char* attribute);
  // sensors.cpp
  void read_sensors(const MjcfElement& section);
  // relations.cpp
  void read_keyframes(const MjcfElement& section);
  void apply_keyframe(const MjcfElement& element);
  void index_names();
  int body_named(const MjcfElement& element, const char* attribute);
  MjcfJoint* joint_named(const MjcfElement& element, const char* attribute, const std::string& use);
  void report_section(const MjcfElement& section);

  MjcfBody& body(int index) { return file_.bodies[static_cast<std::size_t>(index)]; }
  // each section of the root with this name
  template <class Read>
  void for_each_section(std::string_view name, Read read) {
    for (const MjcfElement& e : document_.root.children) {
      if (e.name == name) read(e);
    }
  }

  const MjcfDocument& document_;
  MjcfReader& reader_;
  MjcfFile file_;
  std::map<std::string, int, std::less<>> body_index_;
  std::map<std::string, MjcfJoint*, std::less<>> joint_index_;
  std::vector<std::string> joint_names_;  // the first ones, for suggestions
  std::map<std::string, Site, std::less<>> sites_;
  std::map<std::string, std::vector<TendonJoint>, std::less<>> fixed_tendons_;  // the joints of each
  SpatialTendons spatial_tendons_{reader_, file_.tendons};
  std::map<std::string, MeshAsset, std::less<>> meshes_;
  MjcfHeightfields heightfields_;
  std::map<std::string, Material, std::less<>> materials_;
  std::map<std::string, std::string, std::less<>> textures_;  // the images of textures in files
};

}  // namespace limber::model

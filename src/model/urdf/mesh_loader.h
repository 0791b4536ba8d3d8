// MeshLoader: loads the meshes that the shapes of one model file name. Internal to the module: only src/model includes
// it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf/file.h"
#include "model/urdf/import.h"
#include "model/urdf/tree.h"

namespace limber::model {

class MeshLoader {
 public:
  /// `path`: the model file, whose folder relative URIs start from.
  MeshLoader(const std::string& path, const ImportOptions& options, MeshLibrary& meshes, Problems& problems);

  /// Loads the meshes used by the tree's links; removes and reports shapes with a mesh that can't be loaded.
  void run(UrdfFile& file, const std::vector<UrdfNode>& tree);
  /// Loads the mesh and the texture of a shape, if it has them; reports a mesh that can't be loaded as one of `owner`,
  /// and returns false. If the shape is `drawn`, reports colors and textures that are not drawn, once per file.
  /// Problems of collision shapes are reported by report_collision().
  bool load(UrdfShape& shape, const std::string& owner, bool drawn = true);
  /// Replaces the concave mesh of a shape by one that collides as several convex pieces, if the file's limit of
  /// triangles allows it; otherwise reports that it collides as it is.
  void decompose(UrdfShape& shape, const std::string& owner);
  /// Reports the problems of a mesh as a collision shape (MeshModel::collision_problems), once per file.
  void report_collision(const UrdfShape& shape, const std::string& owner);
  /// Appends the mesh files, with their hashes and URIs, to the model's lists.
  void list_files(BodyModel& model) const;
  /// Hash of the meshes' keys and contents, continued from `start`.
  std::uint64_t combined_hash(std::uint64_t start) const;

 private:
  using MeshResult = Result<std::shared_ptr<const MeshModel>>;

  bool load_mesh(UrdfShape& shape, const std::string& owner);
  bool load_heights(UrdfShape& shape, const std::string& owner);
  const Result<std::shared_ptr<const Image>>& image_at(const std::string& uri);
  void load_texture(UrdfShape& shape, const std::string& owner);
  Result<std::shared_ptr<const Image>> read_image(const std::string& uri);
  void report_look(const UrdfShape& shape, const MeshModel& mesh);
  const MeshResult& get(const std::string& uri, const Vec3& scale);
  MeshResult read(const std::string& uri, const Vec3& scale);

  Result<std::string> find(const std::string& uri);

  std::string folder_;
  std::string target_folder_;  // of the file that the model file is a symbolic link to; empty: it is none
  const ImportOptions& options_;
  MeshLibrary& meshes_;
  Problems& problems_;
  std::map<std::string, MeshResult> results_;
  std::set<const MeshModel*> decomposed_;
  std::size_t decomposed_triangles_ = 0;
  std::map<std::string, std::uint64_t> file_hashes_;  // by file; 0: it could not be loaded
  std::map<std::string, std::string> paths_by_uri_;
  std::map<std::string, Result<std::shared_ptr<const Image>>> images_;  // by URI
  std::set<std::string> reported_;                                      // files and textures
};

}  // namespace limber::model

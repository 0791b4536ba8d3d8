// MeshLoader: loads the meshes that the shapes of one model file name. Internal to the module: only src/model includes
// it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
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
  /// Loads the mesh of a shape, if it has one; reports a mesh that can't be loaded as one of `owner`, and returns
  /// false.
  bool load(UrdfShape& shape, const std::string& owner);
  /// Appends the mesh files, with their hashes and URIs, to the model's lists.
  void list_files(BodyModel& model) const;
  /// Hash of the meshes' keys and contents, continued from `start`.
  std::uint64_t combined_hash(std::uint64_t start) const;

 private:
  using MeshResult = Result<std::shared_ptr<const MeshModel>>;

  const MeshResult& get(const std::string& uri, const Vec3& scale);
  MeshResult read(const std::string& uri, const Vec3& scale);

  std::string folder_;
  const ImportOptions& options_;
  MeshLibrary& meshes_;
  Problems& problems_;
  std::map<std::string, MeshResult> results_;
  std::map<std::string, std::uint64_t> file_hashes_;  // by file; 0: it could not be loaded
  std::map<std::string, std::string> paths_by_uri_;
};

}  // namespace limber::model

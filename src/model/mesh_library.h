// Finds mesh files by the URIs that URDF files use, and keeps what was loaded: one file and scale, one shared mesh.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "model/body_model.h"
#include "model/file_set.h"
#include "model/file_stamp.h"

namespace limber {

/// Where `uri` (package://, model://, file://, relative or absolute path) leads from the folder of the URDF: first as
/// it stands, then below each of `package_paths`, then from the folder upwards, with and without its leading parts.
/// The error says where it looked. Nothing is fetched from a network. [any]
Result<std::string> find_mesh(const std::string& uri, const std::string& folder,
                              const std::vector<std::string>& package_paths);

/// Loaded meshes by file and scale. Never more than one of each is kept; a changed file is loaded anew. [any]
class MeshLibrary {
 public:
  /// `instead`: what is looked into in place of the disk.
  explicit MeshLibrary(std::shared_ptr<const FileSet> instead = nullptr) : instead_(std::move(instead)) {}

  /// As find_mesh().
  Result<std::string> find(const std::string& uri, const std::string& folder,
                           const std::vector<std::string>& package_paths) const;
  Result<std::shared_ptr<const MeshModel>> load(const std::string& path, const Vec3& scale);

 private:
  struct Entry {
    FileStamp stamp;
    std::shared_ptr<const MeshModel> mesh;
  };

  Result<std::shared_ptr<const MeshModel>> load_kept(const std::string& path, const Vec3& scale) const;

  std::shared_ptr<const FileSet> instead_;
  std::mutex mutex_;
  std::map<std::string, Entry> meshes_;
};

}  // namespace limber

// Keeps imported bodies: the same file with the same options twice is one shared, immutable model.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "model/body_model.h"
#include "model/mesh_library.h"
#include "model/urdf_import.h"

namespace limber {

/// Everything that makes two imports the same, as one text. [any]
std::string model_key(const std::string& path, const ImportOptions& options);

/// Models by file and options. A model is imported anew when the content of its URDF or of one of its meshes has
/// changed on disk; who holds the old one keeps it. [any]
class ModelLibrary {
 public:
  /// `instead`: what is read in place of the disk.
  explicit ModelLibrary(std::shared_ptr<const FileSet> instead = nullptr)
      : instead_(instead), meshes_(std::move(instead)) {}

  Result<std::shared_ptr<const BodyModel>> load_urdf(const std::string& path, const ImportOptions& options = {});
  /// The meshes that the models share.
  MeshLibrary& meshes() { return meshes_; }

 private:
  struct Entry {
    std::shared_ptr<const BodyModel> model;
    std::vector<FileStamp> stamps;  ///< Of BodyModel::files, in order.
  };

  bool is_fresh(Entry& entry) const;
  Result<std::shared_ptr<const BodyModel>> load_kept(const std::string& path, const ImportOptions& options);

  std::shared_ptr<const FileSet> instead_;
  std::mutex mutex_;
  MeshLibrary meshes_;
  std::map<std::string, Entry> models_;
};

}  // namespace limber

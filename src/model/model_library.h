// ModelLibrary: cache of imported bodies. Loading the same file with the same options returns the same shared,
// immutable model.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "model/body_model.h"
#include "model/import_options.h"
#include "model/mesh/library.h"

namespace limber::model {

/// The cache key of an import: canonical path and options. [any]
std::string model_key(const std::string& path, const ImportOptions& options);

/// Models by file and options. A model is imported again if its file, an included file or a mesh has changed on disk;
/// holders of the old model are not affected. [any]
class ModelLibrary {
 public:
  /// `memory_files`: files to read instead of the disk; null: use the disk.
  explicit ModelLibrary(std::shared_ptr<const FileSet> memory_files = nullptr)
      : memory_files_(memory_files), meshes_(std::move(memory_files)) {}

  /// Returns the model of a URDF or MJCF file, from the cache if its files are unchanged.
  Result<std::shared_ptr<const BodyModel>> load(const std::string& path, const ImportOptions& options = {});
  /// The cache of meshes shared by the models.
  MeshLibrary& meshes() { return meshes_; }

 private:
  struct Entry {
    std::shared_ptr<const BodyModel> model;
    std::vector<FileStamp> stamps;  ///< One for each of BodyModel::files, in order.
  };

  bool is_current(Entry& entry) const;
  Result<std::shared_ptr<const BodyModel>> load_from_memory(const std::string& path, const ImportOptions& options);

  std::shared_ptr<const FileSet> memory_files_;
  std::mutex mutex_;
  MeshLibrary meshes_;
  std::map<std::string, Entry> models_;
};

}  // namespace limber::model

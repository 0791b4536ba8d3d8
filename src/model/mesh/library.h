// Resolves the mesh URIs of model files and caches loaded meshes: one shared mesh for each file and scale.
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
#include "model/look/file_lookup.h"

namespace limber::model {

/// Resolves `uri` (package://, model://, file://, relative or absolute path) to a file. Searches for the path as
/// written (relative to the model file's folder), then below each of `package_paths`, then in the folder and its
/// parents, with and without the path's leading components; then the same with %20 and other escapes decoded; then, in
/// the folder, its nearest parents and the package paths, with any case of letters. The error lists the searched
/// folders. Never accesses a network. [any]
Result<std::string> find_mesh(const std::string& uri, const std::string& folder,
                              const std::vector<std::string>& package_paths);

/// True if the name of a file that was found differs from its URI in the case of letters. [any]
bool differs_in_case(const std::string& uri, const std::string& path);

/// Cache of loaded meshes by file and scale, and of their decompositions. A file that has changed on disk is loaded
/// again. [any]
class MeshLibrary {
 public:
  /// `memory_files`: files to read instead of the disk; null: use the disk.
  explicit MeshLibrary(std::shared_ptr<const FileSet> memory_files = nullptr)
      : memory_files_(std::move(memory_files)) {}

  /// Resolves a URI like find_mesh(), or among the in-memory files.
  Result<std::string> find(const std::string& uri, const std::string& folder,
                           const std::vector<std::string>& package_paths) const;
  /// Reads a file of at most `max_bytes`, from the disk or among the in-memory files.
  Result<std::string> read(const std::string& path, std::size_t max_bytes) const;
  /// Returns the mesh of a file, scaled, from the cache if the file is unchanged.
  Result<std::shared_ptr<const MeshModel>> load(const std::string& path, const Vec3& scale);
  /// Returns the mesh with the pieces of its decomposition (decompose.h), from the cache if load() has returned it.
  std::shared_ptr<const MeshModel> decomposed(const std::shared_ptr<const MeshModel>& mesh);
  /// Returns the image of a PNG or JPEG file. The error starts with the path.
  Result<std::shared_ptr<const Image>> image(const std::string& path) {
    return images_.load(path, memory_files_.get());
  }

 private:
  struct Entry {
    FileStamp stamp;
    std::shared_ptr<const MeshModel> mesh;
    std::shared_ptr<const MeshModel> decomposed;  // null: not yet
    std::vector<FileStamp> look_stamps;           // of MeshLook::files

    bool is_current(const std::string& path);
  };

  Entry* entry_of(const MeshModel& mesh);
  Result<std::shared_ptr<const MeshModel>> load_from_memory(const std::string& path, const Vec3& scale);

  std::shared_ptr<const FileSet> memory_files_;
  std::mutex mutex_;
  std::map<std::string, Entry> meshes_;
  ImageCache images_;
};

}  // namespace limber::model

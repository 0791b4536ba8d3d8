// FileSet: in-memory copies of files that importers read instead of the disk, so that a model can be rebuilt after its
// files have changed or been deleted. [any]
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace limber::model {

struct FileSet {
  std::map<std::string, std::shared_ptr<const std::string>> contents;  ///< By the path that was used to read the file.
  std::map<std::string, std::string> mesh_paths;                       ///< Paths of meshes, by mesh_key().

  /// The bytes of a file; null if the set does not contain it.
  const std::string* content(const std::string& path) const {
    const auto file = contents.find(path);
    return file == contents.end() ? nullptr : file->second.get();
  }
  /// The key of a mesh in `mesh_paths`: the folder of the URDF and the mesh's URI in that URDF.
  static std::string mesh_key(std::string_view folder, std::string_view uri) {
    return std::string(folder) + '\n' + std::string(uri);
  }
};

}  // namespace limber::model

// FileSet: files that stand in for the disk, so that models can be made again where theirs have changed or gone. [any]
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace limber {

struct FileSet {
  std::map<std::string, std::shared_ptr<const std::string>> contents;  ///< By path, as it was given when it was read.
  std::map<std::string, std::string> found;                            ///< Paths of meshes, by mesh_key().

  const std::string* content(const std::string& path) const {
    const auto file = contents.find(path);
    return file == contents.end() ? nullptr : file->second.get();
  }
  /// How a mesh is known: by the folder of the URDF that names it, and the name there.
  static std::string mesh_key(std::string_view folder, std::string_view uri) {
    return std::string(folder) + '\n' + std::string(uri);
  }
};

}  // namespace limber

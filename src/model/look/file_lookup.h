// FileLookup: finds and reads the files that a mesh file names, on the disk or among in-memory files.
// Internal to the module: only src/model includes it.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/file_set.h"
#include "model/file_stamp.h"
#include "model/look/soup_look.h"

namespace limber::model {

/// Cache of decoded images by path, so that meshes share them. It doesn't keep images alive. [any]
class ImageCache {
 public:
  /// `memory_files`: files to read instead of the disk; null: use the disk. The error starts with the path.
  Result<std::shared_ptr<const Image>> load(const std::string& path, const FileSet* memory_files);

 private:
  struct Entry {
    FileStamp stamp;
    std::weak_ptr<const Image> image;
  };
  std::mutex mutex_;
  std::map<std::string, Entry> images_;
};

class FileLookup final : public LookFiles {
 public:
  /// `mesh`: path of the mesh file. Files are searched for relative to its folder, then by their name alone in that
  /// folder and in the usual folders of textures next to it; then in any letter case.
  FileLookup(std::string mesh, ImageCache& images, const FileSet* memory_files)
      : mesh_(std::move(mesh)), images_(images), memory_files_(memory_files) {}

  Result<std::string> read(const std::string& name, std::string_view extension, std::size_t max_bytes) override;
  Result<std::shared_ptr<const Image>> image(const std::string& name) override;
  std::vector<std::pair<std::string, std::uint64_t>> used() const override { return {used_.begin(), used_.end()}; }
  std::vector<std::string> misspelled() const override { return misspelled_; }

 private:
  Result<std::string> find(const std::string& name);
  bool exists(const std::string& path) const;
  std::string find_misspelled(const std::string& path) const;

  std::string mesh_;
  ImageCache& images_;
  const FileSet* memory_files_;
  std::map<std::string, std::uint64_t> used_;
  std::vector<std::string> misspelled_;
};

/// Replaces %20 and other escapes of a URI by the bytes that they stand for; leaves invalid escapes. [any]
std::string percent_decoded(std::string_view text);
/// A file of this folder whose name differs from `name` in the case of ASCII letters only; empty: none. [any]
std::string find_in_any_case(const std::string& folder, std::string_view name);

}  // namespace limber::model

// ScriptFiles: the folders around a scene, and the search rules for files that it names. [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::script {

/// True if the file, after resolving symlinks, is inside the folder or a subfolder. The file need not exist.
bool is_inside(const std::string& file, const std::string& folder);

class ScriptFiles {
 public:
  ScriptFiles() = default;
  /// `scene`: path of the scene file. `data_dir`: the installed data; empty: none.
  ScriptFiles(const std::string& scene, std::string data_dir);

  /// The nearest folder at or above the scene's that contains `scripts/`, else the scene's own.
  const std::string& show_folder() const { return show_folder_; }
  /// Returns a path for messages: relative to the show folder if inside it.
  std::string display_path(const std::string& path) const;
  /// Finds a file: the path as given, then relative to the scene's folder and each parent, then in the installed data.
  /// The error lists all places. `tried` receives the places without the file; a file that appears there later changes
  /// the result.
  Result<std::string> find(std::string_view name, std::vector<std::string>* tried = nullptr) const;
  /// Finds the file for `require "a.b"` in a scene: scripts/lib/a/b.lua of the show, then of the installed data.
  /// Rejects links that lead outside.
  Result<std::string> find_lib(std::string_view name, std::vector<std::string>* tried = nullptr) const;
  /// Finds the file for `require` in a behavior: lib/ beside its file, then behaviors_lua/lib of the show and of the
  /// data.
  Result<std::string> find_behavior_lib(std::string_view name, const std::string& behavior,
                                        std::vector<std::string>* tried = nullptr) const;
  /// Finds the file of a behavior type by the naming rule: in behaviors_lua/ beside the scene and each parent, then in
  /// the installed data. Returns an empty string if there is none.
  std::string find_behavior(std::string_view type, std::vector<std::string>* tried = nullptr) const;
  /// The folders searched for behavior files, nearest first, whether they exist or not.
  std::vector<std::string> behavior_folders() const;
  /// Names of the types with a file there, without duplicates.
  std::vector<std::string> behavior_names() const;

 private:
  std::string scene_folder_;
  std::string show_folder_;
  std::string data_dir_;
};

/// Reads a whole file unchanged. Errors: not found, not readable, larger than `max_bytes`.
Result<std::string> read_text(const std::string& path, std::uintmax_t max_bytes);
/// Reads a whole script unchanged. Errors: not found, not readable, larger than 1 MB.
Result<std::string> read_script(const std::string& path);

}  // namespace limber::script

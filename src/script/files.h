// ScriptFiles: the folders around a scene, and how the files that it names are found. [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber {

/// Whether a file lies in a folder or below when all links are followed, whether it exists or not.
bool is_inside(const std::string& file, const std::string& folder);

class ScriptFiles {
 public:
  ScriptFiles() = default;
  /// `scene`: the scene's file. `data_dir`: the installed data, or empty.
  ScriptFiles(const std::string& scene, std::string data_dir);

  /// The nearest folder at or above the scene's that holds `scripts/`, else the scene's own.
  const std::string& show_folder() const { return show_; }
  /// A path as messages show it: from the show's folder on when it lies there.
  std::string shown(const std::string& path) const;
  /// As given, then from the scene's folder upwards, then in the installed data. The error lists every place. `passed`
  /// gets the places where it was not: a file that comes there is another answer.
  Result<std::string> find(std::string_view name, std::vector<std::string>* passed = nullptr) const;
  /// The file of a scene's `require "a.b"`: scripts/lib/a/b.lua of the show, then of the installed data; never outside.
  Result<std::string> find_lib(std::string_view name, std::vector<std::string>* passed = nullptr) const;
  /// The file of a behaviour's `require`: lib/ beside its file, then behaviors_lua/lib of the show and of the data.
  Result<std::string> find_behavior_lib(std::string_view name, const std::string& behavior,
                                        std::vector<std::string>* passed = nullptr) const;
  /// The file of a behaviour's type, by the naming rule: behaviors_lua/ beside the scene, above it, then of the
  /// installed data; empty: there is none.
  std::string find_behavior(std::string_view type, std::vector<std::string>* passed = nullptr) const;
  /// The folders where behaviours' files are looked for, the nearest first, whether they exist or not.
  std::vector<std::string> behavior_folders() const;
  /// Names of the types that have a file there, each once.
  std::vector<std::string> behavior_names() const;

 private:
  std::string scene_folder_;
  std::string show_;
  std::string data_dir_;
};

/// A whole script, byte by byte. Errors: not there, not readable, above 1 MB.
Result<std::string> read_script(const std::string& path);

}  // namespace limber

// ImportOptions: how a model file becomes a body.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace limber::model {

struct ImportOptions {
  std::optional<bool> fixed_base;      ///< Unset: as the file says; URDF: a root without mass is fixed to the world.
  bool keep_fixed = false;             ///< Keep fixed joints as joints if their child has mass.
  std::map<std::string, double> pose;  ///< Start values of joints, rad or m; clamped to the limits.
  std::vector<std::string> package_paths;  ///< Folders for package://, besides the file's folder and its parents.
  /// MJCF: the top-level body to import, with its children; "world": all of them in one body. Empty: the first that
  /// moves.
  std::string root;

  bool operator==(const ImportOptions&) const = default;
};
/// A string that is equal for equal options, as part of a cache key. [any]
std::string options_key(const ImportOptions& options);

}  // namespace limber::model

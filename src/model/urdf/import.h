// Imports URDF files as body models: parses, validates, repairs and merges. The entry point of this module.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/body_model.h"
#include "model/mesh/library.h"

namespace limber::model {

struct ImportOptions {
  std::optional<bool> fixed_base;          ///< Unset: a root without mass is fixed to the world.
  bool keep_fixed = false;                 ///< Keep fixed joints as joints if their child has mass.
  std::map<std::string, double> pose;      ///< Start values of joints, rad or m; clamped to the limits.
  std::vector<std::string> package_paths;  ///< Folders for package://, besides the URDF's folder and its parents.

  bool operator==(const ImportOptions&) const = default;
};
/// A string that is equal for equal options, as part of a cache key. [any]
std::string options_key(const ImportOptions& options);

/// Imports the body that a URDF file describes. Invalid content is skipped or repaired and listed in
/// `BodyModel::problems`; returns an error ("file:line: problem. Fix.") only if the file contains no body or the
/// options are invalid. Bounded in time and memory for any input; never throws. [any]
Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options = {});
/// Imports with a cache of meshes that outlives the call. [any]
Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options,
                                                     MeshLibrary& meshes);
/// Imports from text; `path` is used for messages and to resolve mesh paths. [any]
Result<std::shared_ptr<const BodyModel>> import_urdf_text(std::string_view text, const std::string& path,
                                                          const ImportOptions& options, MeshLibrary& meshes);

}  // namespace limber::model

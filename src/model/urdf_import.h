// URDF files into body models: the front door of this room. Parsing, checking, merging, repairs; no simulation.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/body_model.h"
#include "model/mesh_library.h"

namespace limber {

struct ImportOptions {
  std::optional<bool> fixed_base;          ///< Unset: a root without mass is fixed to the world.
  bool keep_fixed = false;                 ///< Fixed joints stay joints, where the child has mass.
  std::map<std::string, double> pose;      ///< Start values of joints, rad or m; clamped to the limits.
  std::vector<std::string> package_paths;  ///< Where package:// is looked for, besides the URDF's folder and above.

  bool operator==(const ImportOptions&) const = default;
};
/// Everything by which two imports of a file differ, in one text. [any]
std::string options_key(const ImportOptions& options);

/// The body that a URDF file describes. What is wrong in the file is left out or repaired and listed in
/// `BodyModel::problems`; the error ("file:line: what. Cure.") comes only when there is no body in it. Bounded in time
/// and memory for any input; never throws. [any]
Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options = {});
/// The same with a library of meshes that is kept. [any]
Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options,
                                                     MeshLibrary& meshes);
/// The same from text; `path` says where it would lie, for messages and mesh paths. [any]
Result<std::shared_ptr<const BodyModel>> import_urdf_text(std::string_view text, const std::string& path,
                                                          const ImportOptions& options, MeshLibrary& meshes);

}  // namespace limber

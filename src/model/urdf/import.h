// Imports URDF files as body models: parses, validates, repairs and merges.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/body_model.h"
#include "model/import_options.h"
#include "model/mesh/library.h"

namespace limber::model {

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

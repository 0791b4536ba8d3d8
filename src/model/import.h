// Imports model files of any supported format. The entry point of this module.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/body_model.h"
#include "model/import_options.h"
#include "model/mesh/library.h"

namespace limber::model {

/// Imports the body that a URDF or MJCF file describes; the root element decides which. See import_urdf() and
/// import_mjcf_text() for errors. [any]
Result<std::shared_ptr<const BodyModel>> import_model(const std::string& path, const ImportOptions& options,
                                                      MeshLibrary& meshes);
/// Imports with a new cache of meshes. [any]
Result<std::shared_ptr<const BodyModel>> import_model(const std::string& path, const ImportOptions& options = {});
/// Imports from text; `path` is used for messages and to resolve the paths of other files. [any]
Result<std::shared_ptr<const BodyModel>> import_model_text(std::string_view text, const std::string& path,
                                                           const ImportOptions& options, MeshLibrary& meshes);

}  // namespace limber::model

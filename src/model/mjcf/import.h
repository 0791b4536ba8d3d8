// Imports MJCF files, the models of MuJoCo, as body models.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/body_model.h"
#include "model/import_options.h"
#include "model/mesh/library.h"

namespace limber::model {

/// Imports one body of an MJCF file: the tree of the top-level body `options.root`, else of the first one that moves.
/// Content that is invalid or has no counterpart is skipped, approximated or repaired and listed in
/// `BodyModel::problems`; returns an error ("file:line: problem. Fix.") only if the file contains no body or the
/// options are invalid. Bounded in time and memory for any input; never throws. [any]
Result<std::shared_ptr<const BodyModel>> import_mjcf_text(std::string_view text, const std::string& path,
                                                          const ImportOptions& options, MeshLibrary& meshes);

}  // namespace limber::model

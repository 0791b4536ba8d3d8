// Model files on the command line and on the window: which files are models, and the model in a folder.
#pragma once

#include <string>

#include "base/result.h"

namespace limber::app {

/// True if the name is that of a model file: its extension is .urdf, .xml or .mjcf in any case. [any]
bool has_model_name(const std::string& path);

/// Returns the model to load: the file itself, or the only model in a folder. A folder's own files are searched first,
/// then those of the folders in it; an .xml file counts if it begins with <mujoco> or <robot>. The error lists the
/// models if there are several, and names the accepted kinds if the file is none. [any]
Result<std::string> find_model(const std::string& path);

}  // namespace limber::app

// PlayedFile: the scene that a name on the command line means: a script, or the generated scene of a model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/viewer/model_scene.h"

namespace limber::app {

struct PlayedFile {
  std::string scene;                ///< Path of the scene file; that of a script as it was found.
  std::optional<ModelScene> model;  ///< The model that it plays, if the name is that of a model or a folder.
};

/// Finds a scene or a model: as given, else in the data folder. A model's scene is written to the user's state folder.
/// `package_paths`, `root`: see ImportOptions. Errors: the places searched, a folder without a model or with several,
/// an invalid model, a file of another kind. [any]
Result<PlayedFile> find_played(const std::string& name, const std::vector<std::string>& package_paths = {},
                               const std::string& root = "");

}  // namespace limber::app

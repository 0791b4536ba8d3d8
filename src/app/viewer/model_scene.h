// ModelScene: the scene that plays a model: a commented Lua text that loads it and puts it on a floor.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "engine/reload/added_model.h"
#include "model/body_model.h"

namespace limber::app {

/// A model to be played.
struct ModelScene {
  std::string model;                       ///< Absolute path of the model file.
  std::vector<std::string> package_paths;  ///< Folders for package://, absolute.
  std::string root;                        ///< MJCF: see ImportOptions.
  std::vector<engine::AddedModel> added;   ///< Models that the user has added.
};

/// Returns the text of the scene that plays the model. `scene_name`: its file name, for its first lines;
/// `path`: the path of the model to write; `body`: the imported model. [any]
std::string model_scene_text(const ModelScene& scene, const std::string& scene_name, const std::string& path,
                             const model::BodyModel& body);

/// Returns the path by which a scene finds a model: relative to the scene's folder, or to the one above a folder
/// scripts/, if the model is inside; else the absolute path. Both paths are absolute. [any]
std::string model_path_in_scene(const std::string& model, const std::string& scene);

/// Imports the model and writes its scene to a file. An existing file is an error unless `overwrite`. [any]
Result<void> save_model_scene(const ModelScene& scene, const std::string& file, bool overwrite);

/// Imports the model and writes its scene to the user's state folder, unless the file is up to date. Returns the path
/// of the scene, which is always the same for a model: presets, takes and recovered values are stored beside it. [any]
Result<std::string> write_model_scene(const ModelScene& scene);

}  // namespace limber::app

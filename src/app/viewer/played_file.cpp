// Decides by the extension of the name.
#include "app/viewer/played_file.h"

#include <filesystem>

#include <fmt/format.h>

#include "app/paths.h"
#include "app/viewer/model_file.h"
#include "base/text.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;

// scripts without an extension are accepted, too
bool has_scene_name(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  return extension.empty() || extension == ".lua";
}

}  // namespace

Result<PlayedFile> find_played(const std::string& name, const std::vector<std::string>& package_paths,
                               const std::string& root) {
  std::vector<std::string> searched;
  const std::string found = find_file_or_folder(name, searched);
  if (found.empty()) return Error{scene_not_found(name, searched)};
  std::error_code error;
  if (!fs::is_directory(found, error) && has_scene_name(found)) return PlayedFile{found, std::nullopt};
  const Result<std::string> model = find_model(found);
  if (!model) return Error{model.error()};
  PlayedFile played;
  played.model.emplace();
  played.model->model = absolute_path(*model);
  played.model->root = root;
  for (const std::string& path : package_paths) played.model->package_paths.push_back(absolute_path(path));
  Result<std::string> scene = write_model_scene(*played.model);
  if (!scene) return Error{scene.error()};
  played.scene = std::move(*scene);
  return played;
}

}  // namespace limber::app

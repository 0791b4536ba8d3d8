// Recognizes models by their extension, and .xml files in folders by their root element, because folders of robots
// contain other .xml files, too.
#include "app/viewer/model_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/system/file.h"
#include "base/text.h"
#include "model/xml_text.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;

constexpr int kMaxDepth = 3;                // folders within folders that are searched
constexpr std::size_t kMaxEntries = 20000;  // files and folders that are examined
constexpr std::size_t kMaxListed = 8;       // models in an error
constexpr std::size_t kHeadBytes = 1u << 16;
constexpr const char* kKinds = "a model is a .urdf or .xml (MJCF) file or a folder with one, a scene is a .lua file";

bool has_extension(const fs::path& path, std::string_view extension) {
  return same_in_any_case(path.extension().string(), extension);
}

// the root element of an XML file, from its beginning
std::string root_of(const fs::path& path) {
  const system::Descriptor file = system::open_file(path.string(), system::OpenMode::read);
  std::string head(kHeadBytes, '\0');
  const std::ptrdiff_t size = file.is_open() ? system::read_some(file.fd(), head.data(), head.size()) : -1;
  head.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return std::string(model::root_element_name(head));
}

bool is_model(const fs::path& path) {
  if (has_extension(path, ".urdf")) return true;
  if (!has_extension(path, ".xml") && !has_extension(path, ".mjcf")) return false;
  const std::string root = root_of(path);
  return root == "mujoco" || root == "robot";
}

// adds the models of the folder, sorted, or if it has none, those of the folders in it
void add_models(const fs::path& folder, int depth, std::size_t& entries, std::vector<std::string>& models) {
  std::vector<fs::path> files;
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (++entries > kMaxEntries) break;
    std::error_code ignored;
    if (at->path().filename().string().starts_with('.')) continue;
    if (at->is_regular_file(ignored)) files.push_back(at->path());
    if (at->is_directory(ignored)) folders.push_back(at->path());
  }
  std::ranges::sort(files);
  std::ranges::sort(folders);
  const std::size_t before = models.size();
  for (const fs::path& file : files) {
    if (is_model(file)) models.push_back(file.string());
  }
  if (models.size() > before || depth == kMaxDepth) return;
  for (const fs::path& inner : folders) add_models(inner, depth + 1, entries, models);
}

// the first scene of a show's folder, in the order of names; empty if it is none
std::string scene_of_show(const fs::path& folder) {
  std::vector<std::string> scenes;
  std::error_code error;
  for (fs::directory_iterator at(folder / "scripts", error), end; !error && at != end; at.increment(error)) {
    if (at->path().extension() == ".lua") scenes.push_back(at->path().string());
  }
  return scenes.empty() ? "" : *std::ranges::min_element(scenes);
}

Result<std::string> model_in_folder(const std::string& folder) {
  if (const std::string scene = scene_of_show(folder); !scene.empty())
    return Error{fmt::format("'{}' is the folder of a show; name one of its scenes, such as {}", printable(folder),
                             printable(scene))};
  std::vector<std::string> models;
  std::size_t entries = 0;
  add_models(folder, 0, entries, models);
  if (models.size() == 1) return models.front();
  if (models.empty()) return Error{fmt::format("'{}' contains no model; {}", printable(folder), kKinds)};
  std::string list;
  for (std::size_t i = 0; i < std::min(models.size(), kMaxListed); i++) list += "\n  " + printable(models[i]);
  if (models.size() > kMaxListed) list += fmt::format("\n  and {} more", models.size() - kMaxListed);
  return Error{fmt::format("'{}' contains {} models; name one of them:{}", printable(folder), models.size(), list)};
}

}  // namespace

bool has_model_name(const std::string& path) {
  return has_extension(path, ".urdf") || has_extension(path, ".xml") || has_extension(path, ".mjcf");
}

Result<std::string> find_model(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return model_in_folder(path);
  if (has_model_name(path)) return path;
  if (has_extension(path, ".xacro"))
    return Error{fmt::format("'{}' is a xacro macro, which becomes a URDF with: xacro {} > robot.urdf", printable(path),
                             printable(fs::path(path).filename().string()))};
  return Error{fmt::format("'{}' is not a model; {}", printable(path), kKinds)};
}

}  // namespace limber::app

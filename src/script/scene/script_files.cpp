// File search: beside the scene, in parent folders, in the installed data.
#include "script/scene/script_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "sim/behavior/behavior_type.h"

namespace limber::script {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxBytes = 1u << 20;

bool is_file(const fs::path& path) {
  std::error_code fault;
  return fs::is_regular_file(path, fault);
}

fs::path absolute_of(const fs::path& path) {
  std::error_code fault;
  const fs::path full = fs::absolute(path, fault);
  return (fault ? path : full).lexically_normal();
}

// appends unless already present
void add_unique(std::vector<fs::path>& paths, const fs::path& path) {
  if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
}

// the folder and all its parents up to the root
std::vector<fs::path> folder_and_parents(fs::path folder) {
  std::vector<fs::path> list;
  while (true) {
    list.push_back(folder);
    const fs::path above = folder.parent_path();
    if (above.empty() || above == folder) return list;
    folder = above;
  }
}

// names of the Lua files in a folder without extension, sorted; empty if the folder does not exist
std::vector<std::string> lua_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code fault;
  for (fs::directory_iterator at(folder, fault); !fault && at != fs::directory_iterator(); at.increment(fault)) {
    const fs::path& path = at->path();
    if (path.extension() == ".lua" && is_file(path)) names.push_back(path.stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// finds "a.b" as a/b.lua in the first folder that has it; rejects links that lead out of the folder
Result<std::string> find_module(std::string_view name, const std::vector<fs::path>& folders,
                                std::vector<std::string>* tried) {
  std::string file(name);
  std::replace(file.begin(), file.end(), '.', '/');
  std::string searched;
  for (const fs::path& folder : folders) {
    const fs::path candidate = folder / (file + ".lua");
    searched += fmt::format("\n  {}", candidate.string());
    if (!is_file(candidate)) {
      if (tried != nullptr) tried->push_back(candidate.string());
      continue;
    }
    if (!is_inside(candidate.string(), folder.string())) {
      return Error{fmt::format("'{}' leads out of {}; keep the file itself there", name, folder.string())};
    }
    return candidate.string();
  }
  return Error{fmt::format("there is no module '{}'; looked for{}", name, searched)};
}

}  // namespace

bool is_inside(const std::string& file, const std::string& folder) {
  std::error_code fault;
  const fs::path real = fs::weakly_canonical(absolute_of(file), fault);
  if (fault) return false;
  const fs::path inside = real.lexically_relative(fs::weakly_canonical(absolute_of(folder), fault));
  return !fault && !inside.empty() && *inside.begin() != "..";
}

ScriptFiles::ScriptFiles(const std::string& scene, std::string data_dir) : data_dir_(std::move(data_dir)) {
  const fs::path folder = absolute_of(scene).parent_path();
  scene_folder_ = folder.string();
  show_folder_ = scene_folder_;
  for (const fs::path& place : folder_and_parents(folder)) {
    std::error_code fault;
    if (!fs::is_directory(place / "scripts", fault)) continue;
    show_folder_ = place.string();
    break;
  }
}

std::string ScriptFiles::display_path(const std::string& path) const {
  const fs::path relative = absolute_of(path).lexically_relative(show_folder_);
  if (relative.empty() || *relative.begin() == "..") return path;
  return relative.string();
}

Result<std::string> ScriptFiles::find(std::string_view name, std::vector<std::string>* tried) const {
  if (name.empty()) return Error{"the file name must not be empty"};
  std::vector<fs::path> candidates = {absolute_of(fs::path(name))};
  if (!fs::path(name).is_absolute()) {
    for (const fs::path& folder : folder_and_parents(scene_folder_)) add_unique(candidates, absolute_of(folder / name));
    if (!data_dir_.empty()) add_unique(candidates, absolute_of(fs::path(data_dir_) / name));
  }
  std::string searched;
  for (const fs::path& candidate : candidates) {
    if (is_file(candidate)) return candidate.string();
    if (tried != nullptr) tried->push_back(candidate.string());
    searched += fmt::format("\n  {}", candidate.string());
  }
  return Error{fmt::format("there is no file '{}'; looked for{}", name, searched)};
}

Result<std::string> ScriptFiles::find_lib(std::string_view name, std::vector<std::string>* tried) const {
  std::vector<fs::path> folders;
  for (const std::string& root : {show_folder_, data_dir_}) {
    if (!root.empty()) add_unique(folders, absolute_of(fs::path(root) / "scripts" / "lib"));
  }
  return find_module(name, folders, tried);
}

Result<std::string> ScriptFiles::find_behavior_lib(std::string_view name, const std::string& behavior,
                                                   std::vector<std::string>* tried) const {
  std::vector<fs::path> folders = {absolute_of(fs::path(behavior).parent_path() / "lib")};
  for (const std::string& root : {show_folder_, data_dir_}) {
    if (!root.empty()) add_unique(folders, absolute_of(fs::path(root) / "behaviors_lua" / "lib"));
  }
  return find_module(name, folders, tried);
}

std::vector<std::string> ScriptFiles::behavior_folders() const {
  std::vector<std::string> folders;
  for (const fs::path& place : folder_and_parents(scene_folder_)) folders.push_back((place / "behaviors_lua").string());
  const std::string installed = (absolute_of(data_dir_) / "behaviors_lua").string();
  const bool known = std::find(folders.begin(), folders.end(), installed) != folders.end();
  if (!data_dir_.empty() && !known) folders.push_back(installed);
  return folders;
}

std::string ScriptFiles::find_behavior(std::string_view type, std::vector<std::string>* tried) const {
  const std::string wanted = sim::normalized_type_name(type);
  for (const std::string& folder : behavior_folders()) {
    for (const std::string& name : lua_files(folder)) {
      if (sim::normalized_type_name(name) == wanted) return (fs::path(folder) / (name + ".lua")).string();
    }
    if (tried != nullptr) tried->push_back((fs::path(folder) / (wanted + ".lua")).string());
  }
  return {};
}

std::vector<std::string> ScriptFiles::behavior_names() const {
  std::vector<std::string> names;
  for (const std::string& folder : behavior_folders()) {
    for (std::string& name : lua_files(folder)) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    }
  }
  return names;
}

Result<std::string> read_script(const std::string& path) {
  std::error_code fault;
  const std::uintmax_t size = fs::file_size(path, fault);
  if (!fault && size > kMaxBytes)
    return Error{fmt::format("{} has {} bytes; a script can have at most 1 MB", path, size)};
  return read_text(path, kMaxBytes);
}

Result<std::string> read_text(const std::string& path, std::uintmax_t max_bytes) {
  std::error_code fault;
  const std::uintmax_t size = fs::file_size(path, fault);
  if (fault || !is_file(path)) return Error{fmt::format("there is no file '{}'", path)};
  if (size > max_bytes) return Error{fmt::format("{} has {} bytes; at most {} are read", path, size, max_bytes)};
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{fmt::format("{} can't be read; check its permissions", path)};
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace limber::script

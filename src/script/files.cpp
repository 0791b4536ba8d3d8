// Looking for files: beside the scene, above it, in the installed data.
#include "script/files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "sim/behavior_type.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMostBytes = 1u << 20;

bool is_file(const fs::path& path) {
  std::error_code fault;
  return fs::is_regular_file(path, fault);
}

fs::path absolute_of(const fs::path& path) {
  std::error_code fault;
  const fs::path full = fs::absolute(path, fault);
  return (fault ? path : full).lexically_normal();
}

// behind the others, unless it is one of them
void add_new(std::vector<fs::path>& places, const fs::path& place) {
  if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
}

// from a folder to the root
std::vector<fs::path> upwards(fs::path folder) {
  std::vector<fs::path> list;
  while (true) {
    list.push_back(folder);
    const fs::path above = folder.parent_path();
    if (above.empty() || above == folder) return list;
    folder = above;
  }
}

// names of the Lua files in a folder, without the ending, by alphabet; none of a folder that isn't there
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

// "a.b" as a/b.lua in the first of the folders that has it; a link must not lead out of its folder
Result<std::string> find_module(std::string_view name, const std::vector<fs::path>& folders,
                                std::vector<std::string>* passed) {
  std::string file(name);
  std::replace(file.begin(), file.end(), '.', '/');
  std::string looked;
  for (const fs::path& folder : folders) {
    const fs::path place = folder / (file + ".lua");
    looked += fmt::format("\n  {}", place.string());
    if (!is_file(place)) {
      if (passed != nullptr) passed->push_back(place.string());
      continue;
    }
    if (!is_inside(place.string(), folder.string())) {
      return Error{fmt::format("'{}' leads out of {}; keep the file itself there", name, folder.string())};
    }
    return place.string();
  }
  return Error{fmt::format("there is no module '{}'; looked for{}", name, looked)};
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
  show_ = scene_folder_;
  for (const fs::path& place : upwards(folder)) {
    std::error_code fault;
    if (!fs::is_directory(place / "scripts", fault)) continue;
    show_ = place.string();
    break;
  }
}

std::string ScriptFiles::shown(const std::string& path) const {
  const fs::path relative = absolute_of(path).lexically_relative(show_);
  if (relative.empty() || *relative.begin() == "..") return path;
  return relative.string();
}

Result<std::string> ScriptFiles::find(std::string_view name, std::vector<std::string>* passed) const {
  if (name.empty()) return Error{"a file's name must not be empty"};
  std::vector<fs::path> places = {absolute_of(fs::path(name))};
  if (!fs::path(name).is_absolute()) {
    for (const fs::path& folder : upwards(scene_folder_)) add_new(places, absolute_of(folder / name));
    if (!data_dir_.empty()) add_new(places, absolute_of(fs::path(data_dir_) / name));
  }
  std::string looked;
  for (const fs::path& place : places) {
    if (is_file(place)) return place.string();
    if (passed != nullptr) passed->push_back(place.string());
    looked += fmt::format("\n  {}", place.string());
  }
  return Error{fmt::format("there is no file '{}'; looked for{}", name, looked)};
}

Result<std::string> ScriptFiles::find_lib(std::string_view name, std::vector<std::string>* passed) const {
  std::vector<fs::path> folders;
  for (const std::string& root : {show_, data_dir_}) {
    if (!root.empty()) add_new(folders, absolute_of(fs::path(root) / "scripts" / "lib"));
  }
  return find_module(name, folders, passed);
}

Result<std::string> ScriptFiles::find_behavior_lib(std::string_view name, const std::string& behavior,
                                                   std::vector<std::string>* passed) const {
  std::vector<fs::path> folders = {absolute_of(fs::path(behavior).parent_path() / "lib")};
  for (const std::string& root : {show_, data_dir_}) {
    if (!root.empty()) add_new(folders, absolute_of(fs::path(root) / "behaviors_lua" / "lib"));
  }
  return find_module(name, folders, passed);
}

std::vector<std::string> ScriptFiles::behavior_folders() const {
  std::vector<std::string> folders;
  for (const fs::path& place : upwards(scene_folder_)) folders.push_back((place / "behaviors_lua").string());
  const std::string installed = (absolute_of(data_dir_) / "behaviors_lua").string();
  const bool known = std::find(folders.begin(), folders.end(), installed) != folders.end();
  if (!data_dir_.empty() && !known) folders.push_back(installed);
  return folders;
}

std::string ScriptFiles::find_behavior(std::string_view type, std::vector<std::string>* passed) const {
  const std::string wanted = plain_type_name(type);
  for (const std::string& folder : behavior_folders()) {
    for (const std::string& name : lua_files(folder)) {
      if (plain_type_name(name) == wanted) return (fs::path(folder) / (name + ".lua")).string();
    }
    if (passed != nullptr) passed->push_back((fs::path(folder) / (wanted + ".lua")).string());
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
  if (fault || !is_file(path)) return Error{fmt::format("there is no file '{}'", path)};
  if (size > kMostBytes) return Error{fmt::format("{} has {} bytes; a script may have 1 MB", path, size)};
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{fmt::format("{} can't be read; look at its permissions", path)};
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace limber

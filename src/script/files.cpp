// Looking for files: beside the scene, above it, in the installed data.
#include "script/files.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

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

}  // namespace

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
    for (const fs::path& folder : upwards(scene_folder_)) places.push_back((folder / name).lexically_normal());
    if (!data_dir_.empty()) places.push_back((fs::path(data_dir_) / name).lexically_normal());
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
  std::string file(name);
  for (char& c : file) {
    if (c == '.') c = '/';
  }
  std::string looked;
  for (const std::string& root : {show_, data_dir_}) {
    if (root.empty()) continue;
    const fs::path folder = fs::path(root) / "scripts" / "lib";
    const fs::path place = folder / (file + ".lua");
    looked += fmt::format("\n  {}", place.string());
    if (!is_file(place)) {
      if (passed != nullptr) passed->push_back(place.string());
      continue;
    }
    // a link must not lead outside
    std::error_code fault;
    const fs::path real = fs::canonical(place, fault);
    const fs::path real_folder = fs::canonical(folder, fault);
    const fs::path inside = real.lexically_relative(real_folder);
    if (fault || inside.empty() || *inside.begin() == "..") {
      return Error{fmt::format("'{}' leads out of {}; keep the file itself there", name, folder.string())};
    }
    return place.string();
  }
  return Error{fmt::format("there is no module '{}'; looked for{}", name, looked)};
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

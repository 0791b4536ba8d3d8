// Search paths for meshes, and the cache of loaded meshes.
#include "model/mesh/library.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"
#include "model/look/mesh_look.h"
#include "model/mesh/load.h"
#include "model/pieces/decompose.h"
#include "model/xml_text.h"

namespace limber::model {

namespace {

namespace fs = std::filesystem;

constexpr int kMaxParentFolders = 8;
constexpr std::size_t kMaxPathParts = 32;
constexpr int kParentsInOtherCase = 2;

bool is_file(const fs::path& path) {
  std::error_code fault;
  return fs::is_regular_file(path, fault);
}

/// The path inside a URI, with backslashes replaced: "package://arm/x.stl" -> "arm/x.stl".
std::string path_of(std::string uri) {
  std::replace(uri.begin(), uri.end(), '\\', '/');
  for (const std::string_view scheme : {"package://", "model://", "file://"}) {
    if (uri.starts_with(scheme)) {
      uri.erase(0, scheme.size());
      break;
    }
  }
  // an unexpanded xacro expression: $(find arm)/x.stl
  if (uri.starts_with("$(find ")) {
    const std::size_t close = uri.find(')');
    if (close != std::string::npos) uri = uri.substr(7, close - 7) + uri.substr(close + 1);
  }
  return uri;
}

/// The path, and its suffixes without the first one, two, … components.
std::vector<fs::path> path_suffixes(const fs::path& path) {
  std::vector<fs::path> parts;
  for (const fs::path& part : path) {
    if (part != "/" && !part.empty()) parts.push_back(part);
  }
  std::vector<fs::path> out;
  for (std::size_t from = 0; from < std::min(parts.size(), kMaxPathParts); ++from) {
    fs::path rest;
    for (std::size_t i = from; i < parts.size(); ++i) rest /= parts[i];
    out.push_back(rest);
  }
  return out;
}

std::string canonical_path(const fs::path& path) {
  std::error_code fault;
  const fs::path whole = fs::weakly_canonical(path, fault);
  return fault ? path.string() : whole.string();
}

// Searches a folder and its parents for a file with one of these relative paths; empty: not found.
fs::path find_upwards(fs::path at, const std::vector<fs::path>& suffixes) {
  for (int level = 0; level < kMaxParentFolders; ++level) {
    for (const fs::path& suffix : suffixes) {
      if (is_file(at / suffix)) return at / suffix;
    }
    if (!at.has_parent_path() || at.parent_path() == at) break;
    at = at.parent_path();
  }
  return {};
}

// A file below a folder whose path differs from `path` in the case of letters only; empty: not found.
fs::path find_in_other_case(fs::path folder, const fs::path& path) {
  for (const fs::path& part : path) {
    std::error_code fault;
    const fs::path exact = folder / part;
    folder = fs::exists(exact, fault) ? exact : fs::path(find_in_any_case(folder.string(), part.string()));
    if (folder.empty()) return {};
  }
  return is_file(folder) ? folder : fs::path();
}

// Searches a few folders only, because each try reads folders.
fs::path find_in_other_case(const fs::path& start, const std::vector<std::string>& package_paths,
                            const std::vector<fs::path>& suffixes) {
  std::vector<fs::path> folders{start};
  for (int i = 0; i < kParentsInOtherCase; ++i) folders.push_back(folders.back().parent_path());
  folders.insert(folders.end(), package_paths.begin(), package_paths.end());
  for (const fs::path& folder : folders) {
    for (const fs::path& suffix : suffixes) {
      if (fs::path found = find_in_other_case(folder, suffix); !found.empty()) return found;
    }
  }
  return {};
}

// Searches for the path as it is, in the order that find_mesh() documents; empty: not found.
std::string find_path(const fs::path& path, const fs::path& start, const std::vector<std::string>& package_paths) {
  if (path.is_absolute() && is_file(path)) return canonical_path(path);
  if (path.is_relative() && is_file(start / path)) return canonical_path(start / path);
  const std::vector<fs::path> suffixes = path_suffixes(path);
  for (const std::string& packages : package_paths) {
    for (const fs::path& suffix : suffixes) {
      if (is_file(fs::path(packages) / suffix)) return canonical_path(fs::path(packages) / suffix);
    }
  }
  const fs::path found = find_upwards(start, suffixes);
  return found.empty() ? std::string() : canonical_path(found);
}

}  // namespace

bool differs_in_case(const std::string& uri, const std::string& path) {
  const fs::path written = percent_decoded(path_of(uri)), found = path;
  auto a = written.end();
  auto b = found.end();
  while (a != written.begin() && b != found.begin()) {
    const std::string x = (--a)->string(), y = (--b)->string();
    if (!same_in_any_case(x, y)) return false;
    if (x != y) return true;
  }
  return false;
}

Result<std::string> find_mesh(const std::string& uri, const std::string& folder,
                              const std::vector<std::string>& package_paths) {
  if (uri.starts_with("http://") || uri.starts_with("https://")) {
    return Error{fmt::format("'{}' is a network address, which is not supported. Copy the file next to the model file.",
                             printable(uri))};
  }
  if (uri.find('\0') != std::string::npos || uri.size() > 4096)
    return Error{"its path is invalid. Use a shorter path."};
  const std::string path = path_of(uri);
  std::error_code fault;
  const fs::path start = fs::absolute(folder.empty() ? "." : folder, fault);
  // a name may be that of a URI, in which %20 stands for a blank
  const std::string decoded = percent_decoded(path);
  for (const std::string& each : {path, decoded}) {
    if (std::string found = find_path(each, start, package_paths); !found.empty()) return found;
  }
  const fs::path other_case = find_in_other_case(start, package_paths, path_suffixes(decoded));
  if (!other_case.empty()) return canonical_path(other_case);
  std::string searched = printable(start.string());
  for (const std::string& packages : package_paths) searched += ", " + printable(packages);
  return Error{fmt::format("'{}' not found in {}, and parent folders. Put the file there, or give --package-path DIR.",
                           printable(uri), searched)};
}

Result<std::string> MeshLibrary::find(const std::string& uri, const std::string& folder,
                                      const std::vector<std::string>& package_paths) const {
  if (memory_files_ == nullptr) return find_mesh(uri, folder, package_paths);
  const auto known = memory_files_->mesh_paths.find(FileSet::mesh_key(folder, uri));
  if (known == memory_files_->mesh_paths.end())
    return Error{
        fmt::format("'{}' is not among the saved files. It was missing when they were saved.", printable(uri))};
  return known->second;
}

Result<std::string> MeshLibrary::read(const std::string& path, std::size_t max_bytes) const {
  if (memory_files_ == nullptr) return read_whole_file(path, max_bytes);
  const std::string* const bytes = memory_files_->content(path);
  if (bytes == nullptr) return Error{fmt::format("{}: is not among the saved files.", printable(path))};
  return *bytes;
}

Result<std::shared_ptr<const MeshModel>> MeshLibrary::load_from_memory(const std::string& path, const Vec3& scale) {
  const std::string* const bytes = memory_files_->content(path);
  if (bytes == nullptr) return Error{fmt::format("{}: is not among the saved files.", printable(path))};
  const Result<MeshFormat> format = mesh_format_of(path);
  if (!format) return Error{fmt::format("{}: {}", printable(path), format.error())};
  FileLookup files(path, images_, memory_files_.get());
  return mesh_from_bytes(*bytes, *format, scale, fs::path(path).stem().string(), &files);
}

bool MeshLibrary::Entry::is_current(const std::string& path) {
  if (!stamp.is_current(path)) return false;
  for (std::size_t i = 0; i < look_stamps.size(); ++i) {
    if (!look_stamps[i].is_current(mesh->look->files[i].first)) return false;
  }
  return true;
}

// The cached mesh; null: it isn't in the cache, or was loaded again since.
MeshLibrary::Entry* MeshLibrary::entry_of(const MeshModel& mesh) {
  const auto found =
      std::find_if(meshes_.begin(), meshes_.end(), [&](const auto& known) { return known.second.mesh.get() == &mesh; });
  return found != meshes_.end() ? &found->second : nullptr;
}

std::shared_ptr<const MeshModel> MeshLibrary::decomposed(const std::shared_ptr<const MeshModel>& mesh) {
  {
    const std::lock_guard lock(mutex_);
    if (const Entry* const entry = entry_of(*mesh); entry != nullptr && entry->decomposed != nullptr)
      return entry->decomposed;
  }
  // without the lock, as for loading: if two threads decompose the same mesh, the first result is used
  std::shared_ptr<const MeshModel> pieces = model::decomposed(mesh);
  const std::lock_guard lock(mutex_);
  Entry* const entry = entry_of(*mesh);
  if (entry == nullptr) return pieces;
  if (entry->decomposed == nullptr) entry->decomposed = std::move(pieces);
  return entry->decomposed;
}

Result<std::shared_ptr<const MeshModel>> MeshLibrary::load(const std::string& path, const Vec3& scale) {
  const std::string key = fmt::format("{}|{:a}|{:a}|{:a}", path, scale.x, scale.y, scale.z);
  {
    const std::lock_guard lock(mutex_);
    const auto found = meshes_.find(key);
    if (found != meshes_.end() && (memory_files_ != nullptr || found->second.is_current(path)))
      return found->second.mesh;
  }
  // loaded without holding the lock: if two threads load the same mesh, the first one's is used
  const FileStamp stamp = memory_files_ == nullptr ? FileStamp(path) : FileStamp();
  FileLookup files(path, images_, nullptr);
  auto mesh = memory_files_ == nullptr ? load_mesh(path, scale, &files) : load_from_memory(path, scale);
  if (!mesh) return mesh;
  Entry loaded{stamp, *mesh, nullptr, {}};
  if (memory_files_ == nullptr && (*mesh)->look != nullptr) {
    for (const auto& file : (*mesh)->look->files) loaded.look_stamps.emplace_back(file.first);
  }
  const std::lock_guard lock(mutex_);
  Entry& entry = meshes_[key];
  if (!entry.mesh || !(entry.stamp == stamp) || entry.look_stamps != loaded.look_stamps) entry = std::move(loaded);
  return entry.mesh;
}

}  // namespace limber::model

// Where meshes are looked for, and the store of loaded ones.
#include "model/mesh_library.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh_load.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

constexpr int kMostLevels = 8;
constexpr std::size_t kMostParts = 32;

bool is_file(const fs::path& path) {
  std::error_code fault;
  return fs::is_regular_file(path, fault);
}

/// The path inside a URI, blanks and slashes mended: "package://arm/x.stl" -> "arm/x.stl".
std::string path_of(std::string uri) {
  std::replace(uri.begin(), uri.end(), '\\', '/');
  for (const std::string_view scheme : {"package://", "model://", "file://"}) {
    if (uri.starts_with(scheme)) {
      uri.erase(0, scheme.size());
      break;
    }
  }
  // what xacro leaves when it is not run: $(find arm)/x.stl
  if (uri.starts_with("$(find ")) {
    const std::size_t close = uri.find(')');
    if (close != std::string::npos) uri = uri.substr(7, close - 7) + uri.substr(close + 1);
  }
  return uri;
}

/// The path and the path without its first one, two … parts.
std::vector<fs::path> shortened(const fs::path& path) {
  std::vector<fs::path> parts;
  for (const fs::path& part : path) {
    if (part != "/" && !part.empty()) parts.push_back(part);
  }
  std::vector<fs::path> out;
  for (std::size_t from = 0; from < std::min(parts.size(), kMostParts); ++from) {
    fs::path rest;
    for (std::size_t i = from; i < parts.size(); ++i) rest /= parts[i];
    out.push_back(rest);
  }
  return out;
}

std::string found(const fs::path& path) {
  std::error_code fault;
  const fs::path whole = fs::weakly_canonical(path, fault);
  return fault ? path.string() : whole.string();
}

}  // namespace

Result<std::string> find_mesh(const std::string& uri, const std::string& folder,
                              const std::vector<std::string>& package_paths) {
  if (uri.starts_with("http://") || uri.starts_with("https://")) {
    return Error{
        fmt::format("'{}' lies on a network, and nothing is fetched. Copy the file beside the URDF.", printable(uri))};
  }
  if (uri.find('\0') != std::string::npos || uri.size() > 4096)
    return Error{"its path is no path. Write a short path."};
  const fs::path path = path_of(uri);
  if (path.is_absolute() && is_file(path)) return found(path);
  std::error_code fault;
  const fs::path start = fs::absolute(folder.empty() ? "." : folder, fault);
  if (path.is_relative() && is_file(start / path)) return found(start / path);
  const std::vector<fs::path> tails = shortened(path);
  std::string looked = printable(start.string());
  for (const std::string& packages : package_paths) {
    looked += ", " + printable(packages);
    for (const fs::path& tail : tails) {
      if (is_file(fs::path(packages) / tail)) return found(fs::path(packages) / tail);
    }
  }
  fs::path at = start;
  for (int level = 0; level < kMostLevels; ++level) {
    for (const fs::path& tail : tails) {
      if (is_file(at / tail)) return found(at / tail);
    }
    if (!at.has_parent_path() || at.parent_path() == at) break;
    at = at.parent_path();
  }
  return Error{
      fmt::format("'{}' was not found; looked in {}, and upwards. Put the file there, or give --package-path DIR.",
                  printable(uri), looked)};
}

Result<std::string> MeshLibrary::find(const std::string& uri, const std::string& folder,
                                      const std::vector<std::string>& package_paths) const {
  if (instead_ == nullptr) return find_mesh(uri, folder, package_paths);
  const auto known = instead_->found.find(FileSet::mesh_key(folder, uri));
  if (known == instead_->found.end())
    return Error{fmt::format("'{}' is not among the files that were kept. It was not there then.", printable(uri))};
  return known->second;
}

Result<std::shared_ptr<const MeshModel>> MeshLibrary::load_kept(const std::string& path, const Vec3& scale) const {
  const std::string* const bytes = instead_->content(path);
  if (bytes == nullptr) return Error{fmt::format("{}: is not among the files that were kept.", printable(path))};
  const Result<MeshFormat> format = mesh_format_of(path);
  if (!format) return Error{fmt::format("{}: {}", printable(path), format.error())};
  return mesh_from_bytes(*bytes, *format, scale, fs::path(path).stem().string());
}

Result<std::shared_ptr<const MeshModel>> MeshLibrary::load(const std::string& path, const Vec3& scale) {
  const std::string key = fmt::format("{}|{:a}|{:a}|{:a}", path, scale.x, scale.y, scale.z);
  {
    const std::lock_guard lock(mutex_);
    const auto found = meshes_.find(key);
    if (found != meshes_.end() && (instead_ != nullptr || found->second.stamp.holds(path))) return found->second.mesh;
  }
  // loaded without the lock: two threads may do it twice, and the first one's is kept
  const FileStamp stamp = instead_ == nullptr ? FileStamp(path) : FileStamp();
  auto mesh = instead_ == nullptr ? load_mesh(path, scale) : load_kept(path, scale);
  if (!mesh) return mesh;
  const std::lock_guard lock(mutex_);
  Entry& entry = meshes_[key];
  if (!entry.mesh || !(entry.stamp == stamp)) entry = {stamp, *mesh};
  return entry.mesh;
}

}  // namespace limber

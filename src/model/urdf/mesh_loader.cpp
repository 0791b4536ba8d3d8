// Each mesh is loaded once for each scale.
#include "model/urdf/mesh_loader.h"

#include <filesystem>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/mesh/load.h"

namespace limber::model {

MeshLoader::MeshLoader(const std::string& path, const ImportOptions& options, MeshLibrary& meshes, Problems& problems)
    : folder_(std::filesystem::path(path).parent_path().string()),
      options_(options),
      meshes_(meshes),
      problems_(problems) {}

void MeshLoader::run(UrdfFile& file, const std::vector<UrdfNode>& tree) {
  for (const UrdfNode& node : tree) {
    UrdfLink& link = file.links[static_cast<std::size_t>(node.link)];
    const std::string owner = fmt::format("link '{}'", printable(link.name));
    std::erase_if(link.collisions, [&](UrdfShape& s) { return !load(s, owner + ": collision"); });
    std::erase_if(link.visuals, [&](UrdfShape& s) { return !load(s, owner + ": visual"); });
  }
}

bool MeshLoader::load(UrdfShape& shape, const std::string& owner) {
  if (shape.shape.kind != ShapeKind::mesh || shape.shape.mesh != nullptr) return true;
  const MeshResult& mesh = get(shape.mesh_uri, shape.mesh_scale);
  if (!mesh) {
    // the last sentence of an error is its fix
    const std::string& text = mesh.error();
    const std::size_t end = text.rfind(". ");
    const bool has_fix = end != std::string::npos;
    problems_.error(shape.line, fmt::format("{} mesh ignored: {}", owner, text.substr(0, end)),
                    has_fix ? text.substr(end + 2) : "Fix the mesh file.");
    return false;
  }
  shape.shape.mesh = *mesh;
  return true;
}

void MeshLoader::list_files(BodyModel& model) const {
  for (const auto& [name, content] : file_hashes_) {
    model.files.push_back(name);
    model.file_hashes.push_back(content);
  }
  model.mesh_paths.assign(paths_by_uri_.begin(), paths_by_uri_.end());
}

std::uint64_t MeshLoader::combined_hash(std::uint64_t start) const {
  for (const auto& [key, mesh] : results_)
    start = hash_bytes(fmt::format("{}|{:x}|", key, mesh ? (*mesh)->content_hash : 0), start);
  return start;
}

const MeshLoader::MeshResult& MeshLoader::get(const std::string& uri, const Vec3& scale) {
  const std::string key = fmt::format("{}|{:a}|{:a}|{:a}", uri, scale.x, scale.y, scale.z);
  const auto known = results_.find(key);
  return known != results_.end() ? known->second : results_.emplace(key, read(uri, scale)).first->second;
}

MeshLoader::MeshResult MeshLoader::read(const std::string& uri, const Vec3& scale) {
  // checked before the disk is accessed, so that '../../etc/passwd' is only an unsupported extension
  if (const Result<MeshFormat> format = mesh_format_of(uri); !format) {
    return Error{fmt::format("'{}' {}", printable(uri), format.error())};
  }
  const Result<std::string> file = meshes_.find(uri, folder_, options_.package_paths);
  if (!file) return Error{file.error()};
  paths_by_uri_[uri] = *file;
  MeshResult mesh = meshes_.load(*file, scale);
  file_hashes_.try_emplace(*file, mesh ? (*mesh)->content_hash : 0);
  return mesh;
}

}  // namespace limber::model

// Import pipeline: clean text, checked file, tree, meshes, body.
#include "model/urdf/import.h"

#include <exception>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/mesh/load.h"
#include "model/problems.h"
#include "model/urdf/build.h"
#include "model/urdf/check.h"
#include "model/urdf/tree.h"
#include "model/xml_text.h"

namespace limber::model {

namespace {

namespace fs = std::filesystem;

/// Loads the meshes used by the tree's links; removes and reports shapes with a mesh that can't be loaded.
class MeshLoader {
 public:
  MeshLoader(const std::string& path, const ImportOptions& options, MeshLibrary& meshes, Problems& problems)
      : folder_(fs::path(path).parent_path().string()), options_(options), meshes_(meshes), problems_(problems) {}

  void run(UrdfFile& file, const std::vector<UrdfNode>& tree) {
    for (const UrdfNode& node : tree) {
      UrdfLink& link = file.links[static_cast<std::size_t>(node.link)];
      std::erase_if(link.collisions, [&](UrdfShape& s) { return !load_shape_mesh(s, link.name, "collision"); });
      std::erase_if(link.visuals, [&](UrdfShape& s) { return !load_shape_mesh(s, link.name, "visual"); });
    }
  }
  /// Mesh files with hash_bytes() of their content; 0 if the file could not be loaded.
  const std::map<std::string, std::uint64_t>& file_hashes() const { return file_hashes_; }
  /// Resolved path by URI.
  const std::map<std::string, std::string>& paths_by_uri() const { return paths_by_uri_; }
  /// Hash of the meshes' keys and contents, continued from `start`.
  std::uint64_t combined_hash(std::uint64_t start) const {
    for (const auto& [key, mesh] : results_)
      start = hash_bytes(fmt::format("{}|{:x}|", key, mesh ? (*mesh)->content_hash : 0), start);
    return start;
  }

 private:
  using MeshResult = Result<std::shared_ptr<const MeshModel>>;

  bool load_shape_mesh(UrdfShape& shape, const std::string& link, const char* kind) {
    if (shape.shape.kind != ShapeKind::mesh) return true;
    const MeshResult& mesh = get(shape.mesh_uri, shape.mesh_scale);
    if (!mesh) {
      // the last sentence of an error is its fix
      const std::string& text = mesh.error();
      const std::size_t end = text.rfind(". ");
      const bool has_fix = end != std::string::npos;
      problems_.error(shape.line,
                      fmt::format("link '{}': {} mesh ignored: {}", printable(link), kind, text.substr(0, end)),
                      has_fix ? text.substr(end + 2) : "Fix the mesh file.");
      return false;
    }
    shape.shape.mesh = *mesh;
    return true;
  }

  const MeshResult& get(const std::string& uri, const Vec3& scale) {
    const std::string key = fmt::format("{}|{:a}|{:a}|{:a}", uri, scale.x, scale.y, scale.z);
    const auto known = results_.find(key);
    return known != results_.end() ? known->second : results_.emplace(key, load(uri, scale)).first->second;
  }

  MeshResult load(const std::string& uri, const Vec3& scale) {
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

  std::string folder_;
  const ImportOptions& options_;
  MeshLibrary& meshes_;
  Problems& problems_;
  std::map<std::string, MeshResult> results_;
  std::map<std::string, std::uint64_t> file_hashes_;
  std::map<std::string, std::string> paths_by_uri_;
};

Result<std::shared_ptr<const BodyModel>> import_bytes(std::string_view bytes, const std::string& path,
                                                      const ImportOptions& options, MeshLibrary& meshes) {
  const std::string shown_path = printable(path);
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  if (!text) return Error{fmt::format("{}:1: {}", shown_path, text.error())};
  Result<UrdfFile> file = check_urdf(*text, fs::path(path).stem().string(), problems);
  if (!file) return Error{fmt::format("{}:{}", shown_path, file.error())};
  const Result<std::vector<UrdfNode>> tree = find_tree(*file, problems);
  if (!tree) return Error{fmt::format("{}:{}", shown_path, tree.error())};

  auto model = std::make_shared<BodyModel>();
  model->name = file->name;
  model->file = path;
  MeshLoader mesh_loader(path, options, meshes, problems);
  mesh_loader.run(*file, *tree);
  UrdfBuildContext build{*file, *tree, options, problems, *model, {}, {}, {}};
  build_structure(build);
  build_masses(build);
  if (const Result<void> posed = build_poses(build); !posed)
    return Error{fmt::format("{}: {}", shown_path, posed.error())};
  build_collisions(build);
  model->problems = problems.release();
  model->files.assign(1, path);
  model->file_hashes.assign(1, hash_bytes(bytes));
  for (const auto& [name, content] : mesh_loader.file_hashes()) {
    model->files.push_back(name);
    model->file_hashes.push_back(content);
  }
  model->mesh_paths.assign(mesh_loader.paths_by_uri().begin(), mesh_loader.paths_by_uri().end());
  model->content_hash = mesh_loader.combined_hash(hash_bytes(bytes, hash_bytes(options_key(options))));
  return std::shared_ptr<const BodyModel>(std::move(model));
}

}  // namespace

std::string options_key(const ImportOptions& options) {
  std::string key =
      fmt::format("|{}|{}", options.fixed_base ? (*options.fixed_base ? "fixed" : "free") : "", options.keep_fixed);
  for (const auto& [name, value] : options.pose) key += fmt::format("|{}:{}={:a}", name.size(), name, value);
  for (const std::string& folder : options.package_paths) key += fmt::format("|{}:{}", folder.size(), folder);
  return key;
}

Result<std::shared_ptr<const BodyModel>> import_urdf_text(std::string_view text, const std::string& path,
                                                          const ImportOptions& options, MeshLibrary& meshes) {
  try {
    return import_bytes(text, path, options, meshes);
  } catch (const std::exception& e) {
    return Error{fmt::format("{}: can't be imported: {}. Simplify the file.", printable(path), printable(e.what()))};
  }
}

Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options,
                                                     MeshLibrary& meshes) {
  const Result<std::string> bytes = read_whole_file(path, kMaxUrdfBytes);
  if (!bytes) return Error{bytes.error()};
  return import_urdf_text(*bytes, path, options, meshes);
}

Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options) {
  MeshLibrary meshes;
  return import_urdf(path, options, meshes);
}

}  // namespace limber::model

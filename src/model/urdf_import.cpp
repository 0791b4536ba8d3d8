// The way of a URDF file: bytes, clean text, checked file, tree, urdfdom's second opinion, meshes, body.
#include "model/urdf_import.h"

#include <exception>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/mesh_load.h"
#include "model/problems.h"
#include "model/urdf_build.h"
#include "model/urdf_check.h"
#include "model/urdf_confirm.h"
#include "model/urdf_text.h"
#include "model/urdf_tree.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

/// Loads the meshes that the tree's links name; shapes whose mesh can't be had are left out and said.
class MeshStep {
 public:
  MeshStep(const std::string& path, const ImportOptions& options, MeshLibrary& meshes, Problems& problems)
      : folder_(fs::path(path).parent_path().string()), options_(options), meshes_(meshes), problems_(problems) {}

  void run(UrdfFile& file, const std::vector<UrdfNode>& tree) {
    for (const UrdfNode& node : tree) {
      UrdfLink& link = file.links[static_cast<std::size_t>(node.link)];
      std::erase_if(link.collisions, [&](UrdfShape& s) { return !fill(s, link.name, "collision"); });
      std::erase_if(link.visuals, [&](UrdfShape& s) { return !fill(s, link.name, "visual"); });
    }
  }
  /// Files of meshes, each with hash_bytes of what it holds.
  const std::map<std::string, std::uint64_t>& files() const { return files_; }
  /// Names and files.
  const std::map<std::string, std::string>& named() const { return named_; }
  /// Over which meshes there are, and what they hold.
  std::uint64_t content(std::uint64_t start) const {
    for (const auto& [key, mesh] : found_)
      start = hash_bytes(fmt::format("{}|{:x}|", key, mesh ? (*mesh)->content : 0), start);
    return start;
  }

 private:
  using Found = Result<std::shared_ptr<const MeshModel>>;

  bool fill(UrdfShape& shape, const std::string& link, const char* kind) {
    if (shape.shape.kind != ShapeKind::mesh) return true;
    const Found& mesh = get(shape.mesh_uri, shape.mesh_scale);
    if (!mesh) {
      // the last sentence of an error is its cure
      const std::string& text = mesh.error();
      const std::size_t end = text.rfind(". ");
      const bool parted = end != std::string::npos;
      problems_.error(shape.line,
                      fmt::format("link '{}': {} mesh left out: {}", printable(link), kind, text.substr(0, end)),
                      parted ? text.substr(end + 2) : "Mend the mesh file.");
      return false;
    }
    shape.shape.mesh = *mesh;
    return true;
  }

  const Found& get(const std::string& uri, const Vec3& scale) {
    const std::string key = fmt::format("{}|{:a}|{:a}|{:a}", uri, scale.x, scale.y, scale.z);
    const auto known = found_.find(key);
    return known != found_.end() ? known->second : found_.emplace(key, load(uri, scale)).first->second;
  }

  Found load(const std::string& uri, const Vec3& scale) {
    // asked before the disk is, so that '../../etc/passwd' is no more than a wrong ending
    if (const Result<MeshFormat> format = mesh_format_of(uri); !format) {
      return Error{fmt::format("'{}' {}", printable(uri), format.error())};
    }
    const Result<std::string> file = meshes_.find(uri, folder_, options_.package_paths);
    if (!file) return Error{file.error()};
    named_[uri] = *file;
    Found mesh = meshes_.load(*file, scale);
    files_.try_emplace(*file, mesh ? (*mesh)->content : 0);
    return mesh;
  }

  std::string folder_;
  const ImportOptions& options_;
  MeshLibrary& meshes_;
  Problems& problems_;
  std::map<std::string, Found> found_;
  std::map<std::string, std::uint64_t> files_;
  std::map<std::string, std::string> named_;
};

Result<std::shared_ptr<const BodyModel>> import_bytes(std::string_view bytes, const std::string& path,
                                                      const ImportOptions& options, MeshLibrary& meshes) {
  const std::string shown = printable(path);
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  if (!text) return Error{fmt::format("{}:1: {}", shown, text.error())};
  Result<UrdfFile> file = check_urdf(*text, fs::path(path).stem().string(), problems);
  if (!file) return Error{fmt::format("{}:{}", shown, file.error())};
  const Result<std::vector<UrdfNode>> tree = find_tree(*file, problems);
  if (!tree) return Error{fmt::format("{}:{}", shown, tree.error())};
  confirm_with_urdfdom(*file, *tree, problems);

  auto model = std::make_shared<BodyModel>();
  model->name = file->name;
  model->file = path;
  MeshStep step(path, options, meshes, problems);
  step.run(*file, *tree);
  UrdfBuild build{*file, *tree, options, problems, *model, {}, {}, {}};
  build_structure(build);
  build_masses(build);
  if (const Result<void> posed = build_poses(build); !posed) return Error{fmt::format("{}: {}", shown, posed.error())};
  build_collisions(build);
  model->problems = problems.take();
  model->files.assign(1, path);
  model->file_contents.assign(1, hash_bytes(bytes));
  for (const auto& [name, content] : step.files()) {
    model->files.push_back(name);
    model->file_contents.push_back(content);
  }
  model->meshes_found.assign(step.named().begin(), step.named().end());
  model->content = step.content(hash_bytes(bytes, hash_bytes(options_key(options))));
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
  const Result<std::string> bytes = read_whole_file(path, kMostUrdfBytes);
  if (!bytes) return Error{bytes.error()};
  return import_urdf_text(*bytes, path, options, meshes);
}

Result<std::shared_ptr<const BodyModel>> import_urdf(const std::string& path, const ImportOptions& options) {
  MeshLibrary meshes;
  return import_urdf(path, options, meshes);
}

}  // namespace limber

// Each mesh is loaded once for each scale.
#include "model/urdf/mesh_loader.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/look/mesh_look.h"
#include "model/mesh/heightfield.h"
#include "model/mesh/load.h"
#include "model/pieces/decompose.h"

namespace limber::model {

MeshLoader::MeshLoader(const std::string& path, const ImportOptions& options, MeshLibrary& meshes, Problems& problems)
    : folder_(std::filesystem::path(path).parent_path().string()),
      options_(options),
      meshes_(meshes),
      problems_(problems) {
  std::error_code fault;
  if (std::filesystem::is_symlink(path, fault))
    target_folder_ = std::filesystem::weakly_canonical(path, fault).parent_path().string();
}

// beside the model file, or beside the file that it links to
Result<std::string> MeshLoader::find(const std::string& uri) {
  Result<std::string> file = meshes_.find(uri, folder_, options_.package_paths);
  if (!file && !target_folder_.empty()) {
    if (Result<std::string> beside_target = meshes_.find(uri, target_folder_, options_.package_paths))
      file = beside_target;
  }
  if (!file) return file;
  paths_by_uri_[uri] = *file;
  if (differs_in_case(uri, *file)) {
    problems_.warning(0, fmt::format("'{}' found as '{}', whose letter case differs", printable(uri), printable(*file)),
                      "Correct the name: other systems tell them apart.");
  }
  return file;
}

void MeshLoader::run(UrdfFile& file, const std::vector<UrdfNode>& tree) {
  // a model without any visuals is drawn with its collision shapes
  const bool has_visuals =
      std::any_of(file.links.begin(), file.links.end(), [](const UrdfLink& link) { return !link.visuals.empty(); });
  for (const UrdfNode& node : tree) {
    UrdfLink& link = file.links[static_cast<std::size_t>(node.link)];
    const std::string owner = fmt::format("link '{}'", printable(link.name));
    std::erase_if(link.collisions, [&](UrdfShape& s) { return !load(s, owner + ": collision", !has_visuals); });
    std::erase_if(link.visuals, [&](UrdfShape& s) { return !load(s, owner + ": visual"); });
  }
}

bool MeshLoader::load(UrdfShape& shape, const std::string& owner, bool drawn) {
  if (!load_heights(shape, owner) || !load_mesh(shape, owner)) return false;
  if (drawn && shape.shape.mesh != nullptr) report_look(shape, *shape.shape.mesh);
  if (!shape.material.texture_uri.empty()) load_texture(shape, owner);
  return true;
}

namespace {

// `size`: width, length and height
Result<ShapeModel> heightfield_of(const Image& image, const Vec3& size) {
  const std::vector<double> heights = normalized_heights(heights_of(image), size.z);
  return heightfield_shape({image.width, image.height, size.x, size.y, heights}, image.file);
}

}  // namespace

bool MeshLoader::load_heights(UrdfShape& shape, const std::string& owner) {
  if (shape.heights_uri.empty()) return true;
  const Result<std::shared_ptr<const Image>>& image = image_at(shape.heights_uri);
  const Result<ShapeModel> field =
      image ? heightfield_of(**image, shape.mesh_scale) : Result<ShapeModel>(Error{image.error()});
  if (!field) {
    const auto [text, fix] = split_fix(field.error(), "Fix the image.");
    problems_.error(shape.line, fmt::format("{} heightfield ignored: {}", owner, text), fix);
    return false;
  }
  shape.shape = *field;
  return true;
}

const Result<std::shared_ptr<const Image>>& MeshLoader::image_at(const std::string& uri) {
  const auto known = images_.find(uri);
  return known != images_.end() ? known->second : images_.emplace(uri, read_image(uri)).first->second;
}

void MeshLoader::load_texture(UrdfShape& shape, const std::string& owner) {
  const std::string& uri = shape.material.texture_uri;
  const Result<std::shared_ptr<const Image>>& image = image_at(uri);
  const MeshModel* const mesh = shape.shape.mesh.get();
  const bool has_texcoords = mesh == nullptr || (mesh->look != nullptr && !mesh->look->texcoords.empty());
  if (image && has_texcoords) {
    shape.shape.texture = *image;
    return;
  }
  if (!reported_.insert(uri + (image ? "|" + shape.mesh_uri : "")).second) return;
  const char* const effect = shape.material.color ? "the color of its material" : "its own colors";
  if (image) {
    problems_.warning(shape.line,
                      fmt::format("{}: mesh '{}' has no texture coordinates; drawn in {} instead of texture '{}'",
                                  owner, printable(shape.mesh_uri), effect, printable(uri)),
                      "Export the mesh with texture coordinates.");
    return;
  }
  const auto [text, fix] = split_fix(image.error(), "Fix the image.");
  problems_.warning(shape.line, fmt::format("{}: texture ignored: {}; drawn in {}", owner, text, effect), fix);
}

Result<std::shared_ptr<const Image>> MeshLoader::read_image(const std::string& uri) {
  // checked before the disk is accessed, as for meshes
  if (!is_image_name(uri))
    return Error{fmt::format("'{}' is neither a PNG nor a JPEG file. Convert it to PNG.", printable(uri))};
  const Result<std::string> file = find(uri);
  if (!file) return Error{file.error()};
  Result<std::shared_ptr<const Image>> image = meshes_.image(*file);
  file_hashes_.try_emplace(*file, image ? (*image)->content_hash : 0);
  return image;
}

// Reports the colors and textures of a mesh file that are not drawn, once per file.
void MeshLoader::report_look(const UrdfShape& shape, const MeshModel& mesh) {
  if (mesh.look == nullptr) return;
  if (has_colors(mesh) && !shape.material.keeps_mesh_colors() && shape.material.texture_uri.empty() &&
      reported_.insert(shape.mesh_uri + "|color").second) {
    problems_.note(
        shape.line,
        fmt::format("mesh '{}' has colors of its own; the color of this file replaces them", printable(shape.mesh_uri)),
        "Remove the <material> of the visual to see them.");
  }
  if (!reported_.insert(shape.mesh_uri).second) return;
  for (const Problem& problem : mesh.look->problems) {
    const std::string text = fmt::format("mesh '{}': {}", printable(shape.mesh_uri), problem.text);
    if (problem.severity == Severity::note) {
      problems_.note(shape.line, text, problem.fix);
    } else {
      problems_.warning(shape.line, text, problem.fix);
    }
  }
}

void MeshLoader::decompose(UrdfShape& shape, const std::string& owner) {
  const MeshModel& mesh = *shape.shape.mesh;
  if (decomposed_.insert(&mesh).second) decomposed_triangles_ += mesh.triangles.size() / 3;
  if (decomposed_triangles_ <= kMaxDecomposedTrianglesOfFile) {
    shape.shape.mesh = meshes_.decomposed(shape.shape.mesh);
  } else if (reported_.insert("|decomposed").second) {
    problems_.warning(shape.line,
                      fmt::format("{}: the concave meshes of the file have more than {} triangles; mesh '{}' and the "
                                  "following ones collide as their hulls",
                                  owner, kMaxDecomposedTrianglesOfFile, printable(shape.mesh_uri)),
                      "Use simpler meshes for collisions.");
  }
}

void MeshLoader::report_collision(const UrdfShape& shape, const std::string& owner) {
  if (shape.shape.mesh == nullptr || shape.shape.mesh->collision_problems.empty()) return;
  if (!reported_.insert(shape.mesh_uri + (shape.concave ? "|concave" : "|collision")).second) return;
  for (const Problem& problem : shape.shape.mesh->collision_problems) {
    problems_.warning(shape.line, fmt::format("{}: mesh '{}' {}", owner, printable(shape.mesh_uri), problem.text),
                      problem.fix);
  }
}

bool MeshLoader::load_mesh(UrdfShape& shape, const std::string& owner) {
  if (shape.shape.kind != ShapeKind::mesh || shape.shape.mesh != nullptr) return true;
  const MeshResult& mesh = get(shape.mesh_uri, shape.mesh_scale);
  if (!mesh) {
    const auto [text, fix] = split_fix(mesh.error(), "Fix the mesh file.");
    problems_.error(shape.line, fmt::format("{} mesh ignored: {}", owner, text), fix);
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
  for (const auto& [uri, image] : images_)
    start = hash_bytes(fmt::format("{}|{:x}|", uri, image ? (*image)->content_hash : 0), start);
  for (const auto& [key, mesh] : results_) {
    if (!mesh || (*mesh)->look == nullptr) continue;
    for (const auto& [file, hash] : (*mesh)->look->files) {
      const std::string name = std::filesystem::path(file).filename().string();
      if (hash != 0) start = hash_bytes(fmt::format("{}|{:x}|", name, hash), start);
    }
  }
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
  const Result<std::string> file = find(uri);
  if (!file) return Error{file.error()};
  MeshResult mesh = meshes_.load(*file, scale);
  file_hashes_.try_emplace(*file, mesh ? (*mesh)->content_hash : 0);
  if (mesh && (*mesh)->look != nullptr) {
    for (const auto& [other, hash] : (*mesh)->look->files) file_hashes_.try_emplace(other, hash);
  }
  return mesh;
}

}  // namespace limber::model

// Import pipeline: clean text, checked file, tree, meshes, body.
#include "model/urdf/import.h"

#include <exception>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/problems.h"
#include "model/urdf/build.h"
#include "model/urdf/check.h"
#include "model/urdf/mesh_loader.h"
#include "model/urdf/tree.h"
#include "model/xml_text.h"

namespace limber::model {

namespace {

Result<std::shared_ptr<const BodyModel>> import_bytes(std::string_view bytes, const std::string& path,
                                                      const ImportOptions& options, MeshLibrary& meshes) {
  const std::string shown_path = printable(path);
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  if (!text) return Error{fmt::format("{}:1: {}", shown_path, text.error())};
  Result<UrdfFile> file = check_urdf(*text, std::filesystem::path(path).stem().string(), problems);
  if (!file) return Error{fmt::format("{}:{}", shown_path, file.error())};
  const Result<std::vector<UrdfNode>> tree = find_tree(*file, problems);
  if (!tree) return Error{fmt::format("{}:{}", shown_path, tree.error())};

  auto model = std::make_shared<BodyModel>();
  model->name = file->name;
  model->file = path;
  MeshLoader mesh_loader(path, options, meshes, problems);
  mesh_loader.run(*file, *tree);
  UrdfBuildContext build{*file, *tree, options, problems, mesh_loader, *model, {}, {}, {}};
  if (const Result<void> built = build_body(build); !built)
    return Error{fmt::format("{}: {}", shown_path, built.error())};
  model->problems = problems.release();
  model->files.assign(1, path);
  model->file_hashes.assign(1, hash_bytes(bytes));
  mesh_loader.list_files(*model);
  model->content_hash = mesh_loader.combined_hash(hash_bytes(bytes, hash_bytes(options_key(options))));
  return std::shared_ptr<const BodyModel>(std::move(model));
}

}  // namespace

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

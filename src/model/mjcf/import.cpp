// Import pipeline: elements with includes, checked file, meshes and masses, tree, body.
#include "model/mjcf/import.h"

#include <exception>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/mjcf/convert.h"
#include "model/mjcf/document.h"
#include "model/mjcf/file_reader.h"
#include "model/mjcf/reader.h"
#include "model/problems.h"
#include "model/urdf/build.h"
#include "model/urdf/tree.h"

namespace limber::model {

namespace {

using ImportResult = Result<std::shared_ptr<const BodyModel>>;

// The model's file, its includes and its meshes, with the hash of all.
void list_all_files(const MjcfDocument& document, const MeshLoader& loader, const ImportOptions& options,
                    BodyModel& model) {
  std::uint64_t hash = hash_bytes(options_key(options));
  for (const MjcfSource& source : document.sources) {
    model.files.push_back(source.path);
    model.file_hashes.push_back(source.hash);
    hash = hash_bytes(fmt::format("{}|{:x}|", source.path, source.hash), hash);
  }
  loader.list_files(model);
  model.content_hash = loader.combined_hash(hash);
}

ImportResult import_file(std::string_view bytes, const std::string& path, const ImportOptions& options,
                         MeshLibrary& meshes) {
  const std::string shown_path = printable(path);
  Problems problems;
  const auto fault = [&](const std::string& text) { return Error{fmt::format("{}:{}", shown_path, text)}; };
  const Result<MjcfDocument> document = read_mjcf(bytes, path, meshes, problems);
  if (!document) return fault(document.error());
  MjcfReader reader(*document, problems);
  Result<MjcfFile> file = MjcfFileReader(*document, reader).run(std::filesystem::path(path).stem().string());
  if (!file) return fault(file.error());
  reader.report_deferred();
  complete_names(*file, problems);
  MeshLoader loader(path, options, meshes, problems);
  load_meshes(*file, loader);
  set_masses(*file, reader.compiler);
  const Result<UrdfFile> links = convert_mjcf(*file, options.root, problems);
  if (!links) return fault(links.error());
  const Result<std::vector<UrdfNode>> tree = find_tree(*links, problems);
  if (!tree) return fault(tree.error());

  auto model = std::make_shared<BodyModel>();
  model->name = links->name;
  model->file = path;
  UrdfBuildContext build{*links, *tree, options, problems, loader, *model, {}, {}, {}};
  if (const Result<void> built = build_body(build); !built)
    return Error{fmt::format("{}: {}", shown_path, built.error())};
  model->problems = problems.release();
  list_all_files(*document, loader, options, *model);
  return std::shared_ptr<const BodyModel>(std::move(model));
}

}  // namespace

Result<std::shared_ptr<const BodyModel>> import_mjcf_text(std::string_view text, const std::string& path,
                                                          const ImportOptions& options, MeshLibrary& meshes) {
  try {
    return import_file(text, path, options, meshes);
  } catch (const std::exception& e) {
    return Error{fmt::format("{}: can't be imported: {}. Simplify the file.", printable(path), printable(e.what()))};
  }
}

}  // namespace limber::model

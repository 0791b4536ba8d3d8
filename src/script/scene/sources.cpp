// Reading the files of a run from the disk or from an earlier run.
#include "script/scene/sources.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "model/look/mesh_look.h"

namespace limber::script {

namespace {

// name of the added text among the recorded files; not a path, because paths are absolute
constexpr const char* kAddedText = "added models";

// lives as long as the process, so that a reset or another scene loads the same file at no cost
model::ModelLibrary& models() {
  static model::ModelLibrary library;
  return library;
}

}  // namespace

template <class T>
const T* Sources::find_known(std::map<std::string, T> Sources::*list, const std::string& key) const {
  for (const Sources* from : {this, earlier_.get()}) {
    if (from == nullptr) continue;
    const auto found = (from->*list).find(key);
    if (found != (from->*list).end()) return &found->second;
  }
  return nullptr;
}

Sources::Sources(std::map<std::string, std::string> found, const std::shared_ptr<const model::FileSet>& files,
                 std::shared_ptr<model::ModelLibrary> library)
    : archived_files_(files), library_(std::move(library)), found_(std::move(found)) {}

std::shared_ptr<const Sources> Sources::of_text(const std::string& path, std::string text) {
  const auto sources = std::make_shared<Sources>();
  sources->texts_[path] = std::move(text);
  return sources;
}

// the result of an earlier run, else that of `find`
template <class Find>
Result<std::string> Sources::look_up(const std::string& key, Find find) {
  if (const std::string* before = find_known(&Sources::found_, key)) return found_[key] = *before;
  if (from_archive()) return Error{fmt::format("{} is not among the recorded files", key)};
  Result<std::string> path = find();
  if (path) found_[key] = *path;
  return path;
}

Result<std::string> Sources::find(const ScriptFiles& files, std::string_view name) {
  return look_up(fmt::format("file {}", name), [&] { return files.find(name, &tried_); });
}

Result<std::string> Sources::find_lib(const ScriptFiles& files, std::string_view name) {
  return look_up(fmt::format("module {}", name), [&] { return files.find_lib(name, &tried_); });
}

Result<std::string> Sources::find_behavior_lib(const ScriptFiles& files, std::string_view name,
                                               const std::string& behavior) {
  return look_up(fmt::format("module {} of {}", name, behavior),
                 [&] { return files.find_behavior_lib(name, behavior, &tried_); });
}

std::string Sources::find_behavior(const ScriptFiles& files, std::string_view type) {
  const Result<std::string> path = look_up(fmt::format("behavior {}", type), [&]() -> Result<std::string> {
    std::string file = files.find_behavior(type, &tried_);
    return file.empty() ? Result<std::string>(Error{"none"}) : Result<std::string>(std::move(file));
  });
  return path ? *path : std::string();
}

Result<std::string> Sources::text(const std::string& path) {
  if (const std::string* before = find_known(&Sources::texts_, path)) return texts_[path] = *before;
  if (from_archive()) {
    const std::string* const text = earlier_->archived_files_->content(path);
    if (text == nullptr) return Error{fmt::format("file '{}' is not among the recorded files", path)};
    return texts_[path] = *text;
  }
  Result<std::string> text = read_script(path);
  contents_[path] = text ? hash_bytes(*text) : 0;
  if (!text) return text;
  if (text->starts_with("\xef\xbb\xbf")) text->erase(0, 3);
  texts_[path] = *text;
  return text;
}

std::string Sources::added_text(const std::string& given) {
  if (from_archive()) {
    const std::string* const text = earlier_->archived_files_->content(kAddedText);
    added_ = text == nullptr ? std::string() : *text;
  } else {
    added_ = given;
  }
  return added_;
}

Result<std::shared_ptr<const model::BodyModel>> Sources::model(const std::string& path,
                                                               const model::ImportOptions& options) {
  const std::string key = model::model_key(path, options);
  contents_.try_emplace(path, 0);  // watch unreadable files as well
  const auto* before = find_known(&Sources::models_, key);
  model::ModelLibrary& library = from_archive() ? *earlier_->library_ : models();
  Result<std::shared_ptr<const model::BodyModel>> model = before ? *before : library.load(path, options);
  if (!model) return model;
  for (std::size_t i = 0; i < (*model)->files.size(); i++) contents_[(*model)->files[i]] = (*model)->file_hashes[i];
  return models_[key] = *model;
}

Result<std::shared_ptr<const model::MeshModel>> Sources::mesh(const std::string& path, const Vec3& scale,
                                                              bool concave) {
  const std::string key =
      fmt::format("{}|{:a}|{:a}|{:a}{}", path, scale.x, scale.y, scale.z, concave ? "|concave" : "");
  contents_.try_emplace(path, 0);
  const auto* before = find_known(&Sources::meshes_, key);
  model::ModelLibrary& library = from_archive() ? *earlier_->library_ : models();
  Result<std::shared_ptr<const model::MeshModel>> mesh = before ? *before : library.meshes().load(path, scale);
  if (!mesh) return mesh;
  if (concave && !before) mesh = library.meshes().decomposed(*mesh);
  contents_[path] = (*mesh)->content_hash;
  if ((*mesh)->look != nullptr) {
    for (const auto& [file, hash] : (*mesh)->look->files) contents_[file] = hash;
  }
  return meshes_[key] = *mesh;
}

Result<std::shared_ptr<const model::Image>> Sources::image(const std::string& path) {
  contents_.try_emplace(path, 0);
  const auto* before = find_known(&Sources::images_, path);
  model::ModelLibrary& library = from_archive() ? *earlier_->library_ : models();
  Result<std::shared_ptr<const model::Image>> image = before ? *before : library.meshes().image(path);
  if (!image) return image;
  contents_[path] = (*image)->content_hash;
  return images_[path] = *image;
}

// The object that `parse` makes of a file's bytes, unless this or the earlier run has it already.
template <class T, class Parse>
Result<std::shared_ptr<const T>> Sources::parsed(ParsedFiles<T> Sources::*list, const std::string& path, Parse parse) {
  contents_.try_emplace(path, 0);
  std::shared_ptr<const T> object;
  if (const auto* before = find_known(list, path)) {
    object = *before;
  } else {
    const std::string* const archived = from_archive() ? earlier_->archived_files_->content(path) : nullptr;
    if (from_archive() && archived == nullptr)
      return Error{fmt::format("file '{}' is not among the recorded files", path)};
    const Result<std::string> text =
        archived != nullptr ? Result<std::string>(*archived) : read_text(path, T::kMaxBytes);
    if (!text) return Error{text.error()};
    Result<std::shared_ptr<const T>> read = parse(*text, path);
    if (!read) return read;
    object = *read;
  }
  contents_[path] = object->content_hash;
  return (this->*list)[path] = object;
}

Result<std::shared_ptr<const model::BvhClip>> Sources::clip(const std::string& path) {
  return parsed<model::BvhClip>(&Sources::clips_, path, &model::parse_bvh);
}

Result<std::shared_ptr<const model::PolicyNetwork>> Sources::policy(const std::string& path) {
  return parsed<model::PolicyNetwork>(&Sources::policies_, path, &model::parse_policy);
}

SourcesRead Sources::read() const {
  SourcesRead read{found_, texts_, {}, {}};
  if (!added_.empty()) read.texts[kAddedText] = added_;
  for (const auto& [key, model] : models_) {
    const std::string folder = std::filesystem::path(model->file).parent_path().string();
    for (const auto& [name, file] : model->mesh_paths) read.meshes[model::FileSet::mesh_key(folder, name)] = file;
  }
  for (const auto& [path, content] : contents_) {
    if (!texts_.contains(path)) read.files.push_back(path);
  }
  return read;
}

std::vector<SourceFile> Sources::files() const {
  std::map<std::string, std::uint64_t> all = contents_;
  for (const auto& [path, text] : texts_) all.try_emplace(path, 0);
  for (const std::string& path : tried_) all.try_emplace(path, 0);
  std::vector<SourceFile> files;
  files.reserve(all.size());
  for (const auto& [path, content] : all) {
    files.push_back({path, content == 0 ? std::nullopt : std::optional(content)});
  }
  return files;
}

}  // namespace limber::script

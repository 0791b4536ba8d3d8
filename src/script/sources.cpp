// What a run reads, from the disk or as an earlier run has read it.
#include "script/sources.h"

#include <fmt/format.h>

#include "base/random.h"

namespace limber {

namespace {

// kept for the program's life: a reset or another scene loads the same file at no cost
ModelLibrary& models() {
  static ModelLibrary library;
  return library;
}

}  // namespace

template <class T>
const T* Sources::known(std::map<std::string, T> Sources::*list, const std::string& key) const {
  for (const Sources* from : {this, again_.get()}) {
    if (from == nullptr) continue;
    const auto found = (from->*list).find(key);
    if (found != (from->*list).end()) return &found->second;
  }
  return nullptr;
}

Result<std::string> Sources::find(const ScriptFiles& files, std::string_view name) {
  const std::string key = fmt::format("file {}", name);
  if (const std::string* before = known(&Sources::found_, key)) return found_[key] = *before;
  Result<std::string> path = files.find(name, &passed_);
  if (path) found_[key] = *path;
  return path;
}

Result<std::string> Sources::find_lib(const ScriptFiles& files, std::string_view name) {
  const std::string key = fmt::format("module {}", name);
  if (const std::string* before = known(&Sources::found_, key)) return found_[key] = *before;
  Result<std::string> path = files.find_lib(name, &passed_);
  if (path) found_[key] = *path;
  return path;
}

Result<std::string> Sources::find_behavior_lib(const ScriptFiles& files, std::string_view name,
                                               const std::string& behavior) {
  const std::string key = fmt::format("module {} of {}", name, behavior);
  if (const std::string* before = known(&Sources::found_, key)) return found_[key] = *before;
  Result<std::string> path = files.find_behavior_lib(name, behavior, &passed_);
  if (path) found_[key] = *path;
  return path;
}

std::string Sources::find_behavior(const ScriptFiles& files, std::string_view type) {
  const std::string key = fmt::format("behavior {}", type);
  if (const std::string* before = known(&Sources::found_, key)) return found_[key] = *before;
  std::string path = files.find_behavior(type, &passed_);
  if (!path.empty()) found_[key] = path;
  return path;
}

Result<std::string> Sources::text(const std::string& path) {
  if (const std::string* before = known(&Sources::texts_, path)) return texts_[path] = *before;
  Result<std::string> text = read_script(path);
  contents_[path] = text ? hash_bytes(*text) : 0;
  if (!text) return text;
  if (text->starts_with("\xef\xbb\xbf")) text->erase(0, 3);
  texts_[path] = *text;
  return text;
}

Result<std::shared_ptr<const BodyModel>> Sources::model(const std::string& path, const ImportOptions& options) {
  const std::string key = model_key(path, options);
  contents_.try_emplace(path, 0);  // one that can't be read is to be watched too
  if (const auto* before = known(&Sources::models_, key)) return models_[key] = *before;
  Result<std::shared_ptr<const BodyModel>> model = models().load_urdf(path, options);
  if (model) models_[key] = *model;
  return model;
}

Result<std::shared_ptr<const MeshModel>> Sources::mesh(const std::string& path, const Vec3& scale) {
  const std::string key = fmt::format("{}|{:a}|{:a}|{:a}", path, scale.x, scale.y, scale.z);
  contents_.try_emplace(path, 0);
  if (const auto* before = known(&Sources::meshes_, key)) return meshes_[key] = *before;
  Result<std::shared_ptr<const MeshModel>> mesh = models().meshes().load(path, scale);
  if (mesh) meshes_[key] = *mesh;
  return mesh;
}

std::vector<SourceFile> Sources::files() const {
  std::map<std::string, std::uint64_t> all = contents_;
  for (const auto& [path, text] : texts_) all.try_emplace(path, 0);
  for (const auto& [key, model] : models_) {
    for (const std::string& file : model->files) all.try_emplace(file, 0);
  }
  for (const std::string& path : passed_) all.try_emplace(path, 0);
  std::vector<SourceFile> files;
  for (const auto& [path, content] : all) {
    files.push_back({path, content == 0 ? std::nullopt : std::optional(content)});
  }
  return files;
}

}  // namespace limber

// The cache of imported bodies.
#include "model/model_library.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"
#include "model/import.h"

namespace limber::model {

std::string model_key(const std::string& path, const ImportOptions& options) {
  std::error_code fault;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(path, fault);
  return (fault ? path : whole.string()) + options_key(options);
}

bool ModelLibrary::is_current(Entry& entry) const {
  if (memory_files_ != nullptr) return true;
  for (std::size_t i = 0; i < entry.stamps.size(); ++i) {
    if (!entry.stamps[i].is_current(entry.model->files[i])) return false;
  }
  return true;
}

Result<std::shared_ptr<const BodyModel>> ModelLibrary::load_from_memory(const std::string& path,
                                                                        const ImportOptions& options) {
  const std::string* const bytes = memory_files_->content(path);
  if (bytes == nullptr) return Error{fmt::format("{}: is not among the saved files.", printable(path))};
  return import_model_text(*bytes, path, options, meshes_);
}

Result<std::shared_ptr<const BodyModel>> ModelLibrary::load(const std::string& path, const ImportOptions& options) {
  const std::string key = model_key(path, options);
  {
    const std::lock_guard lock(mutex_);
    const auto found = models_.find(key);
    if (found != models_.end() && is_current(found->second)) return found->second.model;
  }
  // imported without holding the lock, so that other threads are not blocked; the file's stamp is created first, so
  // that a change during the import is detected by the next call
  const bool disk = memory_files_ == nullptr;
  const FileStamp file_stamp = disk ? FileStamp(path) : FileStamp();
  Result<std::shared_ptr<const BodyModel>> model =
      disk ? import_model(path, options, meshes_) : load_from_memory(path, options);
  if (!model) return model;
  Entry entry{*model, {}};
  if (disk) {
    for (const std::string& file : (*model)->files) entry.stamps.emplace_back(file);
    entry.stamps.front() = file_stamp;
  }
  const std::lock_guard lock(mutex_);
  Entry& cached = models_[key];
  // two threads may have imported the same file: keep the first one's model
  if (!cached.model || cached.stamps != entry.stamps) cached = std::move(entry);
  return cached.model;
}

}  // namespace limber::model

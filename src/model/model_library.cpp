// The store of imported bodies.
#include "model/model_library.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

std::string model_key(const std::string& path, const ImportOptions& options) {
  std::error_code fault;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(path, fault);
  return (fault ? path : whole.string()) + options_key(options);
}

bool ModelLibrary::is_fresh(Entry& entry) const {
  if (instead_ != nullptr) return true;
  for (std::size_t i = 0; i < entry.stamps.size(); ++i) {
    if (!entry.stamps[i].holds(entry.model->files[i])) return false;
  }
  return true;
}

Result<std::shared_ptr<const BodyModel>> ModelLibrary::load_kept(const std::string& path,
                                                                 const ImportOptions& options) {
  const std::string* const bytes = instead_->content(path);
  if (bytes == nullptr) return Error{fmt::format("{}: is not among the files that were kept.", printable(path))};
  return import_urdf_text(*bytes, path, options, meshes_);
}

Result<std::shared_ptr<const BodyModel>> ModelLibrary::load_urdf(const std::string& path,
                                                                 const ImportOptions& options) {
  const std::string key = model_key(path, options);
  {
    const std::lock_guard lock(mutex_);
    const auto found = models_.find(key);
    if (found != models_.end() && is_fresh(found->second)) return found->second.model;
  }
  // imported without the lock, which other threads may need meanwhile; the URDF's stamp is taken first, so that a
  // change during the import is seen the next time
  const bool disk = instead_ == nullptr;
  const FileStamp before = disk ? FileStamp(path) : FileStamp();
  Result<std::shared_ptr<const BodyModel>> model =
      disk ? import_urdf(path, options, meshes_) : load_kept(path, options);
  if (!model) return model;
  Entry entry{*model, {}};
  if (disk) {
    for (const std::string& file : (*model)->files) entry.stamps.emplace_back(file);
    entry.stamps.front() = before;
  }
  const std::lock_guard lock(mutex_);
  Entry& kept = models_[key];
  // two threads may have imported the same file: the first one's model stays
  if (!kept.model || kept.stamps != entry.stamps) kept = std::move(entry);
  return kept.model;
}

}  // namespace limber

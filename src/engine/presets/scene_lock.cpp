// A lock on a dedicated, empty file.
#include "engine/presets/scene_lock.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/system/file.h"

namespace limber::engine {

namespace fs = std::filesystem;

std::string SceneLock::path_of(const std::string& scene) {
  std::error_code fault;
  const fs::path canonical = fs::weakly_canonical(fs::absolute(scene, fault), fault);
  return fault ? scene : canonical.string();
}

std::string SceneLock::name_of(const std::string& scene) {
  const std::string path = path_of(scene);
  return fmt::format("{}-{:016x}", fs::path(path).stem().string(), hash_bytes(path));
}

bool SceneLock::acquire() {
  if (file_.empty() || lock_.is_open()) return true;
  std::error_code fault;
  const fs::path folder = fs::path(file_).parent_path();
  if (!fs::is_directory(folder, fault)) {
    fs::create_directories(folder, fault);
    fs::permissions(folder, fs::perms::owner_all, fault);
  }
  Result<system::Descriptor> lock = system::lock_file(file_);
  if (!lock) return true;
  lock_ = std::move(*lock);
  return lock_.is_open();
}

void SceneLock::release() {
  if (!lock_.is_open()) return;
  system::remove_file(file_);
  lock_ = {};
}

}  // namespace limber::engine

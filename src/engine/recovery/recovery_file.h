// RecoveryFile: stores the property values of a running session on the disk, so that they can be restored after a
// crash. One file per scene, in a folder of the user; only the first program that plays a scene writes it. [one thread]
#pragma once

#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "engine/presets/scene_lock.h"

namespace limber::engine {

/// Values left by a run that crashed.
struct RecoverableValues {
  std::shared_ptr<const Preset> values;
  std::time_t saved_at = 0;  ///< Time at which they were saved.
  /// Returns the time, such as "21:03:12"; with the date if it isn't today.
  std::string time_text() const;
  /// Returns a message that offers to restore them.
  std::string message() const;
};

/// Returns the values of `now` that differ from those in `script` or are missing there; null if there are none.
std::shared_ptr<const Preset> changed_values(const Preset& now, const Preset& script);

class RecoveryFile {
 public:
  /// Opens the file of a scene, keeping values left by a crashed run for recoverable(). Null if another program plays
  /// the scene and owns its file. `folder` is created if necessary. Error: the file can't be used.
  static Result<std::unique_ptr<RecoveryFile>> open(const std::string& folder, const std::string& scene);
  RecoveryFile(const RecoveryFile&) = delete;
  RecoveryFile& operator=(const RecoveryFile&) = delete;

  /// Returns the values of the latest run that crashed, if there are any. Errors name the file, which stays unchanged.
  Result<std::optional<RecoverableValues>> recoverable() const;
  /// Replaces the values saved by this run. Null: there is nothing to restore, removes the file.
  Result<void> save(const std::shared_ptr<const Preset>& values, std::time_t now);
  /// Ends a run cleanly: removes its saved values. `remove_recoverable`: removes also those of recoverable(), because
  /// they were restored.
  void end(bool remove_recoverable);

  /// The absolute path of the scene's file.
  const std::string& scene() const { return scene_; }

 private:
  RecoveryFile(std::string scene, std::string base)
      : scene_(std::move(scene)), path_prefix_(std::move(base)), lock_(path_prefix_ + ".lock") {}

  std::string saved_file() const { return path_prefix_ + ".json"; }
  std::string lost_file() const { return path_prefix_ + ".lost.json"; }
  std::string temporary_file() const { return path_prefix_ + ".new"; }

  std::string scene_;
  std::string path_prefix_;  // common prefix of the file names
  SceneLock lock_;
};

}  // namespace limber::engine

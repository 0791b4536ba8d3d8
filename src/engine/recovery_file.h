// RecoveryFile: what a show's values are, on the disk as long as it plays, so that a start after a crash can bring them
// back. One a scene, in a folder of the user's, of the first program that plays it. [one thread]
#pragma once

#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/result.h"
#include "engine/preset.h"
#include "engine/scene_lock.h"

namespace limber {

/// Values that a run has left which did not end well.
struct LostValues {
  std::shared_ptr<const Preset> values;
  std::time_t saved = 0;  ///< When they were these.
  /// "21:03:12", of another day with the date.
  std::string when() const;
  /// That they are there, and how they come back.
  std::string offer() const;
};

/// Of `now`, the rows that `script` does not have or has otherwise: what there is to bring back. Null: nothing.
std::shared_ptr<const Preset> changed_values(const Preset& now, const Preset& script);

class RecoveryFile {
 public:
  /// Null: another program plays that scene, and owns its file. What another run has left there is kept for lost().
  /// `folder` is made when it is not there. The error says why there can be none.
  static Result<std::unique_ptr<RecoveryFile>> open(const std::string& folder, const std::string& scene);
  RecoveryFile(const RecoveryFile&) = delete;
  RecoveryFile& operator=(const RecoveryFile&) = delete;

  /// What the newest run here that did not end well has left. The error names the file; it stays as it is.
  Result<std::optional<LostValues>> lost() const;
  /// Replaces what this run has saved. Null: there is nothing to bring back.
  Result<void> save(const std::shared_ptr<const Preset>& values, std::time_t now);
  /// The run has ended well: what it has saved goes. `lost_too`: what lost() gave is in it.
  void end(bool lost_too);

  /// The scene's file, with its whole path.
  const std::string& scene() const { return scene_; }

 private:
  RecoveryFile(std::string scene, std::string base)
      : scene_(std::move(scene)), base_(std::move(base)), lock_(base_ + ".lock") {}

  std::string saved_file() const { return base_ + ".json"; }
  std::string lost_file() const { return base_ + ".lost.json"; }
  std::string fresh_file() const { return base_ + ".new"; }

  std::string scene_;
  std::string base_;  // what all its names begin with
  SceneLock lock_;
};

}  // namespace limber

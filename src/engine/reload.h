// Reload: what the scene's last good run said, what the next one is made from, and how that one becomes the show.
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/apply.h"
#include "engine/draft.h"
#include "engine/hand.h"
#include "engine/stage.h"

namespace limber {

class Reload {
 public:
  enum class End : std::uint8_t {
    applied,
    failed,    ///< The run was bad: nothing was applied, the fault was told.
    outdated,  ///< A reset came between: the draft has to be made again.
  };

  Reload(std::string file, ScriptHost& host, PerformerHand& hand);

  /// A stage whose scene, of that file, has just run well from its start, or has none: nothing else was done to it.
  /// `tried`: what a run that failed has read. [sim]
  void begin(const Stage& stage, const SceneOptions& options, const std::string& file,
             std::vector<SourceFile> tried = {});
  /// What a draft is made from now. `again`: of what the last good run has read, not of the disk. [sim]
  DraftOrder order(const Stage& stage, bool again);
  /// A take has ended: what scripts of later drafts may take. [sim]
  void limit(const ScriptLimits& limits) {
    options_.limits = limits;
    options_.keep_timers = true;
  }
  /// Applies a draft that was made from such an order. [sim]
  End take(Draft& draft, Stage& stage);
  /// Whether a parameter with `rerun` has another value than at the last call and the last order. [sim]
  bool take_rerun(const Stage& stage);
  /// A fault of a script was told; it counts until its file is mended. [sim]
  void faulty(std::string_view file) { faulty_.emplace(file); }

  /// Every property as the last good run describes it. [sim]
  const std::shared_ptr<const Preset>& script() const { return script_; }
  /// Files that the last good run depends on, and those of the last run when that failed. [any]
  std::vector<SourceFile> files() const;

 private:
  void keep_files(std::vector<SourceFile> files);
  void say_mended();
  static void say_kept(const KeptTimers& kept, bool from_disk);

  std::string file_;
  SceneOptions options_;
  ScriptHost& host_;
  PerformerHand& hand_;
  std::shared_ptr<const Description> description_;
  std::shared_ptr<const Preset> script_;
  std::shared_ptr<const Sources> sources_;
  LiveThings things_;
  std::vector<double> ran_with_;  // values of parameters with `rerun`
  std::vector<double> values_;    // scratch
  std::set<std::string> faulty_;

  mutable std::mutex files_mutex_;
  std::vector<SourceFile> files_;
};

}  // namespace limber

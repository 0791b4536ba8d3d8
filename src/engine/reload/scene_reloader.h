// SceneReloader: keeps the result of the scene's last successful run, makes requests for the next run, and applies that
// run to the show.
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/edits/overrides.h"
#include "engine/reload/reload_candidate.h"
#include "engine/reload/scene_patch.h"
#include "engine/session.h"

namespace limber::engine {

class SceneReloader {
 public:
  enum class ApplyResult : std::uint8_t {
    applied,
    failed,    ///< The run failed: nothing was applied, and the error was reported.
    outdated,  ///< There was a reset or reload since the request: a new candidate is needed.
  };

  SceneReloader(std::string file, script::ScriptHost& host, Overrides& overrides);

  /// Captures a session right after a successful run of the scene in `file`, or an empty session after a failed run.
  /// `failed_files`: the files that the failed run has read. [sim]
  void capture(const Session& session, const script::SceneOptions& options, const std::string& file,
               std::vector<script::SourceFile> failed_files = {});
  /// Makes a request for a candidate. `reuse_files`: run the sources of the last successful run, not the files on disk.
  /// [sim]
  ReloadRequest make_request(const Session& session, bool reuse_files);
  /// Sets the script limits of later candidates, when a take has ended. [sim]
  void set_limits(const script::ScriptLimits& limits) {
    options_.limits = limits;
    options_.keep_timers = true;
  }
  /// Sets the text that runs after the file in later candidates (SceneOptions::added). [sim]
  void set_added(std::string text) { options_.added = std::move(text); }
  /// Makes files() return the files of the last successful run, after a run that reused the sources. [sim]
  void update_files() { set_files({}); }
  /// Returns the names of the bodies that the last successful run has created. [sim]
  std::vector<std::string> body_names() const;
  /// Applies a candidate made from a request of make_request() to the session. [sim]
  ApplyResult apply_candidate(ReloadCandidate& candidate, Session& session);
  /// True if a parameter with `rerun` has changed since the last call and the last request. [sim]
  bool consume_rerun(const Session& session);
  /// Notes that an error of this script was reported; cleared by the next successful run of the files on disk. [sim]
  void note_error(std::string_view file) { files_with_errors_.emplace(file); }

  /// The values of all properties after the last successful run. [sim]
  const std::shared_ptr<const Preset>& script_preset() const { return script_preset_; }
  /// The files that the last successful run depends on, and those of a failed run since. [any]
  std::vector<script::SourceFile> files() const;

 private:
  void set_files(std::vector<script::SourceFile> files);
  void report_fixed();
  static void report_timers(const script::CarriedTimers& timers, bool from_disk);

  std::string file_;
  script::SceneOptions options_;
  script::ScriptHost& host_;
  Overrides& overrides_;
  std::shared_ptr<const SceneSpec> spec_;
  std::shared_ptr<const Preset> script_preset_;
  std::shared_ptr<const script::Sources> sources_;
  LiveObjects objects_;
  std::vector<double> rerun_values_;  // values of parameters with `rerun`
  std::vector<double> scratch_;       // scratch
  std::set<std::string> files_with_errors_;

  mutable std::mutex files_mutex_;
  std::vector<script::SourceFile> files_;
};

}  // namespace limber::engine

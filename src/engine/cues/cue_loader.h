// CueLoader: reads the cue file: at the start, when it is saved, and when another scene plays.
#pragma once

#include <mutex>
#include <string>

#include "engine/reload/scene_runner.h"

namespace limber::engine {

class CueLoader {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{4} << 20;  ///< Maximum size of a cue file.

  CueLoader(ShowState& show, SceneRunner& scenes) : show_(show), scenes_(scenes) {}

  /// Path of the cues of a scene: "show.cues.json" for "show.lua".
  static std::string path_for(const std::string& scene);

  /// Reads the file before the show starts. Error: the file of the option can't be used; another one is reported. [sim]
  Result<void> start();
  /// Reads the file again. If it has an error, reports it, and the cues stay. False while a take plays. [any but sim]
  bool reload();
  /// Edits the file (see cue_edit.h) and reads it again. Errors: it can't be read or written, is a link out of its
  /// folder, or the edit is wrong. [any but sim]
  Result<void> edit(const Message& request);
  /// Reads the cues of another scene, which plays now, unless an option names the file. [any but sim]
  void change_scene(const std::string& scene);
  /// The file, for a watch. [any]
  script::SourceFile file() const;

 private:
  using List = std::shared_ptr<const CueList>;
  Result<List> read(const std::string& path, bool required);
  void apply(const List& list, bool restart);
  void report(const std::string& path, const std::string& why) const;

  ShowState& show_;
  SceneRunner& scenes_;
  mutable std::mutex mutex_;
  script::SourceFile file_;  // guarded by mutex_
};

}  // namespace limber::engine

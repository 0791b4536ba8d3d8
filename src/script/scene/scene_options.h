// SceneOptions: command line options for running a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "script/vm/limits.h"

namespace limber::script {

class Sources;

struct SceneOptions {
  std::string data_dir;                    ///< Installed data, searched last; empty: none.
  std::vector<std::string> package_paths;  ///< Search path for package:// of URDF files.
  std::optional<std::uint64_t> seed;       ///< Overrides the scene's `sim.seed`.
  ScriptLimits limits;
  /// A reload carries over timers: those of callbacks, and the time of the top level's sim:after. False for old takes.
  bool keep_timers = true;
  /// Lua text that runs after the file: it loads the models that the user has added to the scene. Recorded sources
  /// contain a text of their own, which replaces it.
  std::string added = {};
  std::shared_ptr<const Sources> sources = nullptr;  ///< Files to use instead of the disk; null: the disk.
};

}  // namespace limber::script

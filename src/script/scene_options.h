// SceneOptions: what the command line says about running a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "script/limits.h"

namespace limber {

class Sources;

struct SceneOptions {
  std::string data_dir;                    ///< Installed data, looked into last; empty: none.
  std::vector<std::string> package_paths;  ///< Where package:// of URDF files is looked for.
  std::optional<std::uint64_t> seed;       ///< Wins over the scene's `sim.seed`.
  ScriptLimits limits;
  /// A save keeps timers: those of callbacks, and the time of the top level's sim:after. False for takes of before.
  bool keep_timers = true;
  std::shared_ptr<const Sources> sources = nullptr;  ///< What to read instead of the disk; null: the disk.
};

}  // namespace limber

// `limber preset import`: presets of Max's pattrstorage into those beside a scene.
#pragma once

#include <string>

namespace limber {

struct PresetCommand {
  std::string file;
  std::string scene = "scripts/arms.lua";
};

/// Puts them behind those that are there, and says what was left out. Returns the exit code: 1 when the file, or that
/// of the scene's presets, can't be read; 3 when it can't be written. [main]
int preset_command(const PresetCommand& command);

}  // namespace limber

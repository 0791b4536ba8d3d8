// `limber preset import`: converts presets of Max's pattrstorage and adds them to those of a scene.
#pragma once

#include <string>

namespace limber {

/// Arguments of `preset import`.
struct PresetCommand {
  std::string file;
  std::string scene = "scripts/arms.lua";
};

/// Appends the presets to the scene's file and reports values that were skipped. Returns the exit code: 1 if one of the
/// files can't be read; 3 if the result can't be written. [main]
int preset_command(const PresetCommand& command);

}  // namespace limber

// Presets that contain the parameters of a scene and nothing else. [main]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "experiments/axis.h"

namespace limber::app {

/// Returns the preset with these values of the parameters. `shared`: as for PresetBuilder::finish().
std::shared_ptr<const engine::Preset> parameter_preset(const std::vector<experiments::Axis>& axes,
                                                       const std::vector<double>& values, const std::string& name,
                                                       const std::shared_ptr<const engine::PresetSchema>& shared);

/// Returns the values that a preset has for the parameters; for those that it lacks, or of which it
/// has a value of another type or a word that is no choice, `otherwise`.
std::vector<double> parameter_values(const engine::Preset& preset, const std::vector<experiments::Axis>& axes,
                                     const std::vector<double>& otherwise);

/// A file with presets.
struct PresetStore {
  std::string file;
  std::string locks;  ///< Folder of lock files; empty: none.

  /// Reads the presets. Errors name the file.
  Result<engine::PresetList> read() const;
  /// Adds a preset for each list of values, named `name`_1, _2, … with numbers that are not in use, and returns the
  /// names. `notice`: message about a backup of a damaged file, if one was made. Errors name the file.
  Result<std::vector<std::string>> add(const std::vector<experiments::Axis>& axes,
                                       const std::vector<std::vector<double>>& values, const std::string& name,
                                       std::string& notice) const;
};

}  // namespace limber::app

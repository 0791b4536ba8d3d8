// The text of a file of presets: JSON that a person can read, and two versions of it compared line by line. [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "engine/preset.h"

namespace limber {

inline constexpr const char* kPresetHead = "limber presets";  ///< The key that holds the version.
inline constexpr int kPresetVersion = 1;

/// What a text of presets holds.
struct PresetsRead {
  PresetList presets;                 ///< In the text's order, no two of a name.
  std::vector<std::string> problems;  ///< What could not be taken as it stands; the rest is good.
};

/// Errors: it is no such text, ends in the middle, or is of a newer version. An empty text has no presets.
Result<PresetsRead> presets_of(std::string_view text);

/// Reads back as the same to the bit. The names of things stand as their paths, a value a line.
std::string text_of(const PresetList& presets);

}  // namespace limber

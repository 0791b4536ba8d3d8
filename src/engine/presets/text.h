// Text format of preset files: JSON that is readable and suited to line-by-line diffs. [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"

namespace limber {

inline constexpr const char* kPresetVersionKey = "limber presets";  ///< The key that holds the version.
inline constexpr int kPresetVersion = 1;

/// Result of parsing a preset file.
struct ParsedPresets {
  PresetList presets;                 ///< In the order of the file; names are unique.
  std::vector<std::string> problems;  ///< Descriptions of parts that were skipped or changed.
};

/// Parses presets. An empty text has no presets. Error: another format, a truncated text or a newer version.
Result<ParsedPresets> parse_presets(std::string_view text);

/// Formats presets, one value per line. Parsing the text returns bit-identical values.
std::string text_of(const PresetList& presets);

}  // namespace limber

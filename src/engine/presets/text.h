// Text formats of presets: Limber's own, which is JSON that is readable and suited to line-by-line diffs, and the
// import of Max's pattrstorage. [any]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"

namespace limber::engine {

/// Result of parsing a preset file.
struct ParsedPresets {
  PresetList presets;                 ///< In the order of the file; names are unique.
  std::vector<std::string> problems;  ///< Descriptions of parts that were skipped or changed.
};

/// Formats presets, one value per line. Parsing the text returns bit-identical values.
std::string text_of(const PresetList& presets);

/// Parses presets. An empty text has no presets. Error: another format, a truncated text or a newer version.
Result<ParsedPresets> parse_presets(std::string_view text);

/// Converts the slots of a pattrstorage file, in the order of their numbers, to presets with the names of the slots, or
/// "slot 3" for one without. A client `arms::speed` becomes the property /arms/speed, one without :: a parameter of the
/// scene, /scene/speed; a client named by a path keeps it. Values of types that no property has are skipped and
/// reported as problems. Error: the text isn't a pattrstorage file.
Result<ParsedPresets> import_pattrstorage(std::string_view text);

}  // namespace limber::engine

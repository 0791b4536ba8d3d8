// Import of presets from other programs: JSON files of Max's pattrstorage. [any]
#pragma once

#include <string_view>

#include "base/result.h"
#include "engine/presets/text.h"

namespace limber {

/// Converts the slots of a pattrstorage file, in the order of their numbers, to presets with the names of the slots, or
/// "slot 3" for one without. A client `arms::speed` becomes the property /arms/speed, one without :: a parameter of the
/// scene, /scene/speed; a client named by a path keeps it. Values of types that no property has are skipped and
/// reported as problems. Error: the text isn't a pattrstorage file.
Result<ParsedPresets> import_pattrstorage(std::string_view text);

}  // namespace limber

// Presets of other programs: Max's pattrstorage, as it writes JSON. [any]
#pragma once

#include <string_view>

#include "base/result.h"
#include "engine/preset_text.h"

namespace limber {

/// The slots of a pattrstorage in the order of their numbers, called by their names, else "slot 3". A client
/// `arms::speed` becomes the row /arms/speed, one without :: a parameter of the scene, /scene/speed; a client whose
/// name is a whole path keeps it. Values that no row has are left out and said. Errors: it is no such file.
Result<PresetsRead> import_pattrstorage(std::string_view text);

}  // namespace limber

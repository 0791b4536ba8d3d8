// Makes Collada text safe for assimp, which hangs on odd characters in index lists and runs without end through nodes
// that instance themselves. Part of the room's inside: only mesh_load.cpp includes it.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace limber {

/// The same geometry as XML that holds nothing but asset, geometries, nodes and scenes: no materials, animations,
/// controllers, cameras or extras. The error says what can't be, with the line and the cure. [any]
Result<std::string> clean_collada(std::string_view bytes);

}  // namespace limber

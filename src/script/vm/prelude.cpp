// The order in which the files of the prelude run.
#include "script/vm/prelude.h"

#include <array>

namespace limber {

std::span<const std::string_view> prelude_order() {
  static constexpr std::array<std::string_view, 32> kOrder{"core.lua",
                                                           "library.lua",
                                                           "syntax.lua",
                                                           "compiled.lua",
                                                           "fallback.lua",
                                                           "values.lua",
                                                           "math.lua",
                                                           "objects.lua",
                                                           "lists.lua",
                                                           "solids.lua",
                                                           "bodies.lua",
                                                           "forces.lua",
                                                           "behaviors/handles.lua",
                                                           "sim.lua",
                                                           "visuals.lua",
                                                           "callbacks.lua",
                                                           "osc.lua",
                                                           "presets.lua",
                                                           "params.lua",
                                                           "plain.lua",
                                                           "behaviors/types.lua",
                                                           "behaviors/self.lua",
                                                           "errors.lua",
                                                           "behaviors/limits.lua",
                                                           "strings.lua",
                                                           "behaviors/neighbors.lua",
                                                           "tables.lua",
                                                           "state.lua",
                                                           "reload.lua",
                                                           "sandbox.lua",
                                                           "console.lua",
                                                           "warm.lua"};
  return kOrder;
}

}  // namespace limber

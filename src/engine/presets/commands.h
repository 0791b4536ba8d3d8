// Parsing of preset messages into commands, without access to the presets. [any]
#pragma once

#include <optional>
#include <string>

#include "base/message.h"
#include "base/result.h"
#include "engine/presets/morph.h"
#include "engine/presets/preset.h"

namespace limber {

/// Arguments: name [word …]. Words: path patterns, behaviors, looks, all, poses, velocities; patterns after `except`
/// are excluded from recalls.
struct StoreCommand {
  std::string name;
  std::optional<double> number;              ///< Number of an existing preset, instead of a name.
  std::optional<PresetSelection> selection;  ///< Nothing: the selection of the preset that is replaced, else all.
};
Result<StoreCommand> parse_store(const Message& message);

/// Arguments: name|number [seconds [easing]]
struct RecallCommand {
  Arg preset;
  double seconds = 0;
  Easing easing = Easing::smooth;
};
Result<RecallCommand> parse_recall(const Message& message);

/// Arguments: name|number name|number amount
struct MorphCommand {
  Arg a, b;
  double amount = 0;  ///< 0 .. 1
};
Result<MorphCommand> parse_morph(const Message& message);

}  // namespace limber

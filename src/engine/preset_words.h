// What messages of presets say, read without looking at any preset. [any]
#pragma once

#include <optional>
#include <string>

#include "base/message.h"
#include "base/result.h"
#include "engine/morph.h"
#include "engine/preset.h"

namespace limber {

/// name [word …]: patterns of paths, behaviors, looks, all, poses, velocities, except and the patterns behind it.
struct StoreWish {
  std::string name;
  std::optional<double> number;        ///< Instead of a name: one that is there.
  std::optional<PresetChoice> choice;  ///< Nothing: as it was before, else all.
};
Result<StoreWish> store_wish(const Message& message);

/// name|number [seconds [easing]]
struct RecallWish {
  Arg which;
  double seconds = 0;
  Easing easing = Easing::smooth;
};
Result<RecallWish> recall_wish(const Message& message);

/// name|number name|number amount
struct MorphWish {
  Arg a, b;
  double amount = 0;  ///< 0 .. 1
};
Result<MorphWish> morph_wish(const Message& message);

}  // namespace limber
